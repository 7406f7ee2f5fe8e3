"""Bring the catalogues of texts in step with the code: ``src/tractionpower/reporting/texts/pl.po`` for translators, ``pl.mo``
for the program.

Translations are written into ``pl.po``; texts that are gone leave it, new ones come into it without a translation.
"""

from __future__ import annotations

import ast
import io
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

from tractionpower.reporting.texts.recorded import SENTENCES
from tractionpower.reporting.texts.sources import static_texts

ROOT = Path(__file__).parent.parent
CODE = ROOT / "src" / "tractionpower" / "reporting"
TEXTS = CODE / "texts"
LANGUAGES = ("pl",)
FUNCTIONS = {"tr": (0,), "mark": (0,), "recorded": (0,), "Column": (0,), "_begin": (2,)}
METHODS = {"page": (0, 1), "section": (0,), "note": (0,), "line": (0,), "wrapped": (0,)}
"""Functions and methods that translate what they are given, and which of their arguments."""

Text = str | tuple[str, str]
"""A text, or one for a single thing with that for several."""


def texts() -> list[Text]:
    """Return all texts that reports can show, each once, in their order."""
    found: set[Text] = {*SENTENCES, *static_texts()}
    for file in sorted(CODE.rglob("*.py")):
        found.update(_texts_of(ast.parse(file.read_text(encoding="utf-8"))))
    plurals = {text[0] for text in found if isinstance(text, tuple)}
    return sorted(
        (text for text in found if text and text not in plurals), key=lambda text: text if isinstance(text, str) else text[0]
    )


def updated(language: str) -> Catalog:
    """Return the catalogue of a language with the texts of today and the translations that it has of them."""
    old = catalogue(language)
    new = Catalog(locale=language, project="tractionpower", fuzzy=False)
    new.creation_date = new.revision_date = old.creation_date
    for text in texts():
        known = old.get(text if isinstance(text, str) else text[0])
        new.add(text, known.string if known is not None and _of_one_kind(known.string, text) else None)
    return new


def catalogue(language: str) -> Catalog:
    """Return the catalogue of a language as it is."""
    file = TEXTS / f"{language}.po"
    if not file.exists():
        return Catalog(locale=language)
    with file.open("rb") as opened:
        return read_po(opened, locale=language)


def compiled(read: Catalog) -> bytes:
    """Return a catalogue as the program reads it."""
    buffer = io.BytesIO()
    write_mo(buffer, read)
    return buffer.getvalue()


def written(read: Catalog) -> bytes:
    """Return a catalogue as translators read it."""
    buffer = io.BytesIO()
    write_po(buffer, read, width=120, omit_header=False, sort_output=False)
    return buffer.getvalue()


def main() -> None:
    """Write the catalogues of all languages and say what they lack."""
    for language in LANGUAGES:
        new = updated(language)
        (TEXTS / f"{language}.po").write_bytes(written(new))
        (TEXTS / f"{language}.mo").write_bytes(compiled(new))
        bare = [message.id for message in new if message.id and not _is_translated(message.string)]
        sys.stdout.write(f"{language}: {len(new)} texts, {len(bare)} without a translation\n")


def _is_translated(string: str | tuple[str, ...] | None) -> bool:
    return bool(string) if isinstance(string, str | None) else all(string)


def _of_one_kind(string: str | tuple[str, ...], text: Text) -> bool:
    return isinstance(string, str | None) == isinstance(text, str)


def _texts_of(tree: ast.Module) -> Iterator[Text]:
    named = dict(_named(tree))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name == "trn":
            one, many = (_constants(argument, named) for argument in node.args[:2])
            yield from zip(one, many, strict=True)
            continue
        places = METHODS.get(name, ()) if isinstance(node.func, ast.Attribute) else FUNCTIONS.get(name, ())
        for place in places:
            if place < len(node.args):
                yield from _constants(node.args[place], named)


def _constants(argument: ast.expr, named: Mapping[str, str]) -> Iterator[str]:
    """Yield the texts that an argument can be: a literal, a constant of the module, or one of the two of a condition."""
    if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
        yield argument.value
    elif isinstance(argument, ast.Name) and argument.id in named:
        yield named[argument.id]
    elif isinstance(argument, ast.IfExp):
        yield from _constants(argument.body, named)
        yield from _constants(argument.orelse, named)


def _named(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the constants of a module that are texts: each with a name of its own, or several by commas."""
    for node in tree.body:
        if not isinstance(node, ast.Assign):
            continue
        target = node.targets[0]
        several = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
        for name, value in zip(target.elts, node.value.elts, strict=True) if several else ((target, node.value),):
            if isinstance(name, ast.Name) and isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield name.id, value.value


if __name__ == "__main__":
    main()
