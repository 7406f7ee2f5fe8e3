"""Entry of ``python -m tractionpower``."""

import sys

from tractionpower.cli import main

if __name__ == "__main__":
    sys.exit(main())
