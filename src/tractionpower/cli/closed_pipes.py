"""A console whose reader may leave, as ``head`` does: what is printed after that goes nowhere, and the command goes on."""

from __future__ import annotations

from rich.console import Console

from tractionpower.cli.messages import close_quietly


class PatientConsole(Console):
    """A console that is silent once nobody reads it; rich would end the process with exit code 1."""

    def on_broken_pipe(self) -> None:
        """Print nothing more."""
        self.quiet = True
        close_quietly(self.file)
