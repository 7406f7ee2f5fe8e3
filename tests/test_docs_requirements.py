"""Every requirement of the papers on train dynamics has a row, and every test that the page names exists."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "dynamics-requirements.md").read_text(encoding="utf-8")
ROWS = dict(re.findall(r"^\| (R-[ZAD]\d+) (\|.*)$", PAGE, re.MULTILINE))
NAMED = sorted(set(re.findall(r"`([\w./-]+\.py)::(\w+)`", PAGE)))
REQUIRED = [f"R-{paper}{number}" for paper, count in (("Z", 13), ("A", 12), ("D", 9)) for number in range(1, count + 1)]


@cache
def defined_in(file):
    tree = ast.parse((ROOT / "tests" / file).read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)}


def test_each_requirement_has_one_row():
    assert re.findall(r"^\| (R-[ZAD]\d+) ", PAGE, re.MULTILINE) == REQUIRED


@pytest.mark.parametrize("requirement", REQUIRED)
def test_a_requirement_names_where_and_by_which_tests(requirement):
    _, what, where, shown, _ = ROWS[requirement].split("|", 4)
    assert what.strip()
    assert "`" in where
    assert "::test_" in shown


@pytest.mark.parametrize(("file", "name"), NAMED, ids="::".join)
def test_a_named_test_exists(file, name):
    assert name.startswith("test_")
    assert name in defined_in(file)


def test_modules_that_the_page_names_exist():
    modules = re.findall(r"`((?:dynamics|io|kernels|reporting|web)/[\w/]+(?:\.py)?)`", PAGE)
    assert len(modules) > 20
    assert [name for name in modules if not (ROOT / "src" / "tractionpower" / name).exists()] == []
