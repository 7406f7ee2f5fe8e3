"""The rules of the house that can be checked: floors, sizes, what a help text may cost, what may not be named."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCES = sorted((ROOT / "src" / "tractionpower").rglob("*.py"))
HEAVY = ("numpy", "numba", "llvmlite", "pandas", "pyarrow", "pydantic", "ruamel", "matplotlib", "openpyxl")
MODULE_LINES = 350
FUNCTION_LINES = 60
COMMANDS = [
    [],
    ["run"],
    ["check"],
    ["journey"],
    ["curves"],
    ["feasibility"],
    ["contingency"],
    ["size"],
    ["sweep"],
    ["compare"],
    ["dynamics"],
    ["dynamics", "run"],
    ["dynamics", "drive"],
    ["dynamics", "check"],
    ["report"],
    ["export"],
    ["import"],
    ["validate"],
    ["schema"],
    ["new"],
]


def name_of(path):
    return path.relative_to(ROOT).as_posix()


def test_imports_go_down_only(tmp_path):
    code = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(cache_dir=sys.argv[1]))"
    ran = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert re.search(r"Contracts: [2-9]\d* kept, 0 broken", ran.stdout), ran.stdout


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_help_imports_nothing_heavy(arguments):
    code = (
        "import sys\n"
        "from tractionpower.cli import main\n"
        f"code = main({[*arguments, '--help']!r})\n"
        "print(*sys.modules, file=sys.stderr)\n"
        "sys.exit(code)\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60)
    assert ran.returncode == 0, ran.stderr
    assert "Usage" in ran.stdout
    loaded = {name.split(".")[0] for name in ran.stderr.split()}
    typers_own = {"pydantic"} if arguments else set()  # newer typer reads parameters with it
    assert loaded.isdisjoint({*HEAVY} - typers_own)


def test_every_command_has_its_help_tested():
    ran = subprocess.run(
        [sys.executable, "-m", "tractionpower", "--help"], capture_output=True, text=True, check=True, timeout=60
    )
    listed = ran.stdout.split("Commands:")[1]
    assert set(re.findall(r"^  (\w[\w-]*)", listed, re.MULTILINE)) == {command[0] for command in COMMANDS if command}


def test_every_command_of_dynamics_has_its_help_tested():
    ran = subprocess.run(
        [sys.executable, "-m", "tractionpower", "dynamics", "--help"], capture_output=True, text=True, check=True, timeout=60
    )
    listed = re.findall(r"^  (\w[\w-]*)", ran.stdout.split("Commands:")[1], re.MULTILINE)
    assert set(listed) == {command[1] for command in COMMANDS if command[:1] == ["dynamics"] and len(command) > 1}


def test_the_package_itself_imports_nothing_heavy():
    code = "import sys, tractionpower; print(*sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert {name.split(".")[0] for name in ran.stdout.split()}.isdisjoint(HEAVY)


def test_no_source_names_a_place_of_this_machine_or_an_index():
    files = [path for path in (ROOT / "src").rglob("*") if path.is_file() and path.suffix not in {".pyc", ".png", ".mo"}]
    assert len(files) > 50
    pattern = re.compile(r"/work\b|/home/\w|/Users/\w|[A-Z]:\\|https?://[^\s\"]*(pypi|simple|packages)|index-url", re.IGNORECASE)
    found = [(name_of(path), hit[0]) for path in files for hit in pattern.finditer(path.read_text(encoding="utf-8"))]
    assert found == []


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_a_module_fits_on_a_few_screens(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= MODULE_LINES
    tree = ast.parse(text)
    assert ast.get_docstring(tree), "a module says what it is for"
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
    long = {f.name: f.end_lineno - f.lineno + 1 for f in functions if f.end_lineno - f.lineno + 1 > FUNCTION_LINES}
    assert long == {}


def test_the_library_does_not_print():
    for path in SOURCES:
        if "cli" in path.parts:
            continue
        calls = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
        assert not [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "print"], path
