"""The cover: who made the report, the verdicts in words that follow the sheet of acceptance, how far to trust it, what is where.

It is printed on one page.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from io import BytesIO
from pathlib import Path
from typing import Any

from openpyxl.drawing.image import Image
from openpyxl.drawing.spreadsheet_drawing import AnchorMarker, OneCellAnchor
from openpyxl.drawing.xdr import XDRPositiveSize2D
from openpyxl.utils.units import pixels_to_EMU
from openpyxl.worksheet.hyperlink import Hyperlink

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.accepted import accepted_rows
from tractionpower.reporting.workbook.common.cover_texts import (
    MOST_NOTES,
    Said,
    judged_elsewhere,
    run_head,
    run_trust,
    run_verdicts,
)
from tractionpower.reporting.workbook.common.cover_verdicts import write_headline, write_verdicts
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Computed
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Page

__all__ = ["MOST_NOTES", "TITLE_LENGTH", "Said", "fill_in"]

WIDTHS = (22.0, 26.0, 13.0, 13.0, 24.0, 28.0, 20.0, 28.0)
"""Widths of the columns [characters]."""

LAST = len(WIDTHS)

CHARACTERS = 175
"""Characters of a text that fit into its width, from the second column to the last."""

LABEL_CHARACTERS = 24
"""Characters of a label that fit into its width."""

MOST_TEXT_LINES = 8
"""Lines of a list that the cover tells."""

TITLE_LENGTH = 80
"""Characters of the study's name in its title; a longer one is written in full below."""

SHORT_HASH = 12
"""Characters of a hash that tell inputs apart for people."""

LOGO_CM = (5.0, 2.0)
"""Width and height that a logo may take."""

PIXELS_PER_CM = 96.0 / 2.54

KINDS = {
    "": mark("Co-simulation of train movement and traction power supply"),
    "size": mark("Dimensioning of the traction power supply"),
    "contingency": mark("Outages of the traction power supply"),
    "sweep": mark("Variants of a study"),
    "compare": mark("Comparison of results"),
    "dynamics": mark("Train dynamics: the train as many vehicles"),
    "stations": mark("Train dynamics: trains as point masses on a line with stations"),
}
"""What a report is, by the kind in ``run.json``."""

Group = Callable[[Any], Iterable[Said]]
"""Takes the facts of the book, which are of its kind."""


def fill_in(book: Book, page: Page, groups: Sequence[Group] = ()) -> None:
    """Write the cover, when all other sheets are there.

    The first of `groups` tells what was computed, the last how far to trust it, those between what was found beside the limits;
    none: what they tell of a run.
    """
    usual: Sequence[Group] = (run_head, run_verdicts, run_trust)
    head, *found, trust = groups or usual
    facts = book.computed
    page.widen(*WIDTHS)
    book.print_on_one_page(page)
    _title(book, page)
    _document(book, page)
    _write(page, tr("Subject"), head(facts))
    rows = accepted_rows(book)
    if rows or found:
        _section(page, tr("Verdict"))
    if facts.part and not rows:
        say(page, "", judged_elsewhere(facts), "neutral")
    elif rows or not groups:
        write_headline(page, rows)
    write_verdicts(page, rows)
    for group in found:
        _write(page, "", ((label, text, style.removeprefix("big ")) for label, text, style in group(facts)))
    _write(page, tr("How far to trust it"), trust(facts))
    if not book.finds_its_sheets():
        say(page, tr("Note"), tr("The template asks for no sheet that this workbook has, so the others are here."), "doubt")
    _links(book, page)


def say(page: Page, label: str, text: str | Formula, style: str) -> None:
    """Write a label and a text, which is broken into lines, across the page."""
    size = 1.35 if style.startswith("big ") else 1.0
    page.put(page.next, 1, label, "label")
    text = _bounded(text) if isinstance(text, str) else text
    shown = str(page.put(page.next, 2, text, style) or "")
    page.sheet.merge_cells(start_row=page.next, start_column=2, end_row=page.next, end_column=LAST)
    lines = sum(max(1, math.ceil(len(line) * size / CHARACTERS)) for line in shown.split("\n"))
    lines = max(lines, math.ceil(len(label) / LABEL_CHARACTERS))
    page.sheet.row_dimensions[page.next].height = min(lines * LINE_POINTS * size + (8.0 if size > 1.0 else 1.0), 400.0)
    page.next += 1


def _bounded(text: str) -> str:
    """Return a text with no more lines than a cover has room for."""
    lines = [line if len(line) <= CHARACTERS else f"{line[: CHARACTERS - 1]}…" for line in text.split("\n")]
    if len(lines) == 1:
        return text
    more = len(lines) - MOST_TEXT_LINES
    return "\n".join(lines if more <= 0 else [*lines[:MOST_TEXT_LINES], tr("and {more} more", more=more)])


def _write(page: Page, title: str, said: Iterable[Said]) -> None:
    if title:
        _section(page, title)
    for label, text, style in said:
        say(page, label, text, style)


def _section(page: Page, title: str) -> None:
    """Begin a part of the cover below a little room."""
    page.sheet.row_dimensions[page.next].height = 7.0
    page.put(page.next + 1, 1, title, "section")
    page.sheet.row_dimensions[page.next + 1].height = 19.0
    page.next += 2


def _title(book: Book, page: Page) -> None:
    """Write the title, what kind of report it is, and the logo or else the company."""
    report, subject = book.report, book.subject
    if report.document.title:
        page.put(1, 1, shorten(report.document.title, TITLE_LENGTH), "title")
    page.sheet.row_dimensions[1].height, page.sheet.row_dimensions[2].height = 30.0, 18.0
    kind = KINDS.get(str(subject.run.get("kind") or ""), "")
    if book.subject.run.get("feasibility"):
        kind = mark("Feasibility of a timetable")
    name = subject.name if isinstance(subject, Computed) else subject.study
    study = shorten(name, TITLE_LENGTH) if report.document.title else ""
    page.put(2, 1, " · ".join(part for part in (tr(kind), study) if part), "subtitle")
    if report.logo:
        _logo(page, Path(report.logo))
    elif report.company:
        page.put(1, LAST, shorten(report.company, 40), "company")
    for column in range(1, LAST + 1):
        page.sheet.cell(3, column)._style = page.styles["rule"]
    page.next = 5


def _logo(page: Page, file: Path) -> None:
    """Put the logo into the right upper corner, as large as there is room."""
    image = Image(BytesIO(file.read_bytes()))  # of a file openpyxl would keep open
    room = [length * PIXELS_PER_CM for length in LOGO_CM]
    scale = min(room[0] / image.width, room[1] / image.height)
    image.width, image.height = round(image.width * scale), round(image.height * scale)
    left = max(0, round((WIDTHS[-1] + 2.0) * 7.0 - image.width))
    place = AnchorMarker(col=LAST - 1, colOff=pixels_to_EMU(left), row=0, rowOff=pixels_to_EMU(2))
    image.anchor = OneCellAnchor(_from=place, ext=XDRPositiveSize2D(pixels_to_EMU(image.width), pixels_to_EMU(image.height)))
    page.sheet.row_dimensions[3].height = max(6.0, image.height * 0.75 - 44.0)
    page.sheet.add_image(image)


def _document(book: Book, page: Page) -> None:
    """Write what an engineering office writes on a document, with room for signatures."""
    report, run = book.report, book.subject.run
    document, top, now = report.document, page.next, datetime.now().astimezone()
    left = (
        (tr("Issued by"), report.company), (tr("Project"), document.project), (tr("Client"), document.client),
        (tr("Document number"), document.number), (tr("Revision"), document.revision),
        (tr("Date"), document.date or f"{now:%Y-%m-%d}"),
    )  # fmt: skip
    for row, (label, text) in enumerate(left, top):
        page.put(row, 1, label, "box label")
        page.put(row, 2, shorten(text, 300), "box")
        page.put(row, 3, "", "box")
        page.sheet.merge_cells(start_row=row, start_column=2, end_row=row, end_column=3)
        page.sheet.row_dimensions[row].height = LINE_POINTS * max(1, math.ceil(len(text) / 38)) + 3.0
    heads = ("", tr("Name"), tr("Date"), tr("Signature"))
    signed = (
        (tr("Made by"), document.made_by), (tr("Checked by"), document.checked_by), (tr("Approved by"), document.approved_by),
    )  # fmt: skip
    for row, cells in enumerate((heads, *((role, name, "", "") for role, name in signed)), top):
        for column, text in enumerate(cells, 5):
            page.put(row, column, shorten(text, 300), "box label" if row == top or column == 5 else "box")
    version, digest = run.get("versions", {}).get("tractionpower", ""), book.subject.input_hash
    origin = (
        (tr("Program"), tr("tractionpower {version}, written {when}", version=version, when=f"{now:%Y-%m-%d %H:%M}")),
        (tr("Input hash"), f"{digest[:SHORT_HASH]} ({digest})" if len(digest) > SHORT_HASH else digest),
    )
    for row, (label, text) in enumerate(origin, top + 4):
        page.put(row, 5, label, "box label")
        for column in range(6, LAST + 1):
            page.put(row, column, text if column == 6 else "", "box")
        page.sheet.merge_cells(start_row=row, start_column=6, end_row=row, end_column=LAST)
    page.next = top + len(left)


def _links(book: Book, page: Page) -> None:
    """Write links to all other sheets, several in a row; what a sheet shows comes up when the mouse is on its link."""
    _section(page, tr("Sheets"))
    columns = (1, 2, 3, 6, 7, 8)
    others = [other for other in book.kept_pages() if other is not page]
    for number, other in enumerate(others):
        row, column = page.next + number // len(columns), columns[number % len(columns)]
        name = other.sheet.title
        page.put(row, column, name, "link")
        page.sheet.cell(row, column).hyperlink = Hyperlink(
            ref="", location=f"'{name}'!A1", display=name, tooltip=shorten(other.title, 200)
        )
    page.next += math.ceil(max(1, len(others)) / len(columns))
    page.sheet.print_area = f"A1:{page.sheet.cell(1, LAST).column_letter}{page.next}"
