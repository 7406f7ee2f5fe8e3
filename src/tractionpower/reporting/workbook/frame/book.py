"""A workbook in the making: its sheets, names and formulas, and which of the sheets it keeps in the end."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from openpyxl import Workbook
from openpyxl.utils import quote_sheetname

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.cells import Styles, shorten
from tractionpower.reporting.workbook.frame.facts import Computed, Facts, Subject
from tractionpower.reporting.workbook.frame.formulas import Formula, Names
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.frame.rules import Rule

if TYPE_CHECKING:
    from tractionpower.reporting.workbook.common.accepted import Accepted

TITLE_LENGTH = 200
"""Characters of the title in the properties of the document."""

Pending = tuple[Page, int, int, Formula, Mapping[str, str]]
"""Page, row and column of a formula, and the cells of its row that it may name."""


class Book:
    """The workbook in the making.

    Sheets are added in any order that suits; formulas are written at the end, when all that they may ask for is there.

    Parameters
    ----------
    subject
        What it is about: mostly facts of a run with its scenario.
    report
        The template: language, sheets, paper.
    """

    def __init__(self, subject: Subject, report: Report) -> None:
        self.workbook = Workbook()
        self.subject, self.report = subject, report
        self.styles = Styles(self.workbook)  # they are made on the sheet that goes in the end
        self.names = Names()
        self.pages: list[Page] = []
        self.pending: list[Pending] = []
        self._single: list[Page] = []
        self.acceptance: list[Accepted] = []
        """What the sheets judge, for the sheet of acceptance."""
        self.rules: list[Rule] = []
        """Conditional formats that refer to named cells."""
        self.cached: dict[str, dict[str, Any]] = {}
        """Values of the formulas by sheet and cell, once the book is finished."""

    @property
    def facts(self) -> Facts:
        """What the sheets tell of a run and its scenario."""
        if not isinstance(self.subject, Facts):
            raise TypeError("this workbook is about results without a scenario")
        return self.subject

    @property
    def computed(self) -> Computed:
        """What the sheets tell of a computation, whatever was computed."""
        if not isinstance(self.subject, Computed):
            raise TypeError("this workbook is about no computation")
        return self.subject

    def page(self, name: str, title: str) -> Page:
        """Add a sheet; name and title are English and shown in the language of the report."""
        page = Page(self, name, title)
        self.pages.append(page)
        return page

    def print_on_one_page(self, page: Page) -> None:
        """Let a sheet be printed on one page, of A4 unless the template says otherwise."""
        self._single.append(page)

    def kept_pages(self) -> list[Page]:
        """Return the pages that the template keeps, in its order; of all that are there by now."""
        return chosen_pages(self.pages, self.report)

    def finds_its_sheets(self) -> bool:
        """Return whether any sheet that the template names, and does not leave out, is there by now."""
        return self.report.sheets is None or bool(named_pages(self.pages, self.report))

    def define(self, name: str, page: Page, area: str) -> str:
        """Name a cell or a range of a page, for formulas anywhere in the book, and return the name."""
        return self.names.define(name, page.sheet, area)

    def finish(self) -> None:
        """Keep the sheets that the template asks for in its order, and write formulas, names and properties."""
        del self.workbook[self.workbook.sheetnames[0]]
        kept = self.kept_pages()
        drawn = {title for page in kept for title in _drawn_from(page)}
        hidden = [page for page in self.pages if page not in kept and page.sheet.title in drawn]
        for page in self.pages:
            page.finish()
            if page not in kept and page not in hidden:
                self.names.forget(page.sheet)
                self.workbook.remove(page.sheet)
        for page in self._single:
            setup, page.sheet.print_options.horizontalCentered = page.sheet.page_setup, True
            setup.fitToHeight, setup.paperSize = 1, setup.paperSize if self.report.paper == "a3" else page.sheet.PAPERSIZE_A4
        for page in hidden:
            page.sheet.sheet_state = "hidden"
        self.pages = [*kept, *hidden]
        self.workbook._sheets = [page.sheet for page in self.pages]
        self.workbook.active = 0
        self._write_formulas()
        for rule in self.rules:
            rule.write(self.names)
        self.names.write(self.workbook)
        self._describe()

    def _write_formulas(self) -> None:
        for page, row, column, formula, cells in self.pending:
            written = formula.written(cells, self.names) if page in self.pages else None
            if written is not None:
                cell = page.sheet.cell(row, column)
                shown = cell.value
                cell.value = written
                self.cached.setdefault(page.sheet.title, {})[cell.coordinate] = shown

    def _describe(self) -> None:
        """Give the document its properties."""
        subject, document, properties = self.subject, self.report.document, self.workbook.properties
        properties.title = shorten(document.title or subject.study, TITLE_LENGTH)
        properties.creator = shorten(document.made_by or self.report.company, TITLE_LENGTH) or "tractionpower"
        properties.subject = subject.about
        properties.description = f"input hash {subject.input_hash}"
        properties.version, properties.language = shorten(document.revision, 40) or None, self.report.language


def chosen_pages(pages: list[Page], report: Report) -> list[Page]:
    """Return the pages that a template asks for, in its order; where none of them is there, all that it does not leave out."""
    without_choice = report.model_copy(update={"sheets": None})
    return named_pages(pages, report) or named_pages(pages, without_choice) or pages


def named_pages(pages: list[Page], report: Report) -> list[Page]:
    """Return the pages that a template names and does not leave out, in its order."""
    by_name = {name.casefold(): page for page in pages for name in (page.sheet.title, page.name)}
    wanted = list(by_name.values()) if report.sheets is None else [by_name.get(name.casefold()) for name in report.sheets]
    left_out = {name.casefold() for name in report.leave_out}
    order = pages if report.sheets is None else [page for page in dict.fromkeys(wanted) if page is not None]
    return [page for page in order if not {page.name.casefold(), page.sheet.title.casefold()} & left_out]


def _drawn_from(page: Page) -> set[str]:
    """Return the names of the sheets that the charts of a page draw from."""
    found = set()
    for chart in page.sheet._charts:
        for series in chart.series:
            for source in (series.xVal, series.yVal, series.val, series.cat):
                reference = source and (source.numRef or getattr(source, "strRef", None))
                if reference is not None:
                    found.add(reference.f.rpartition("!")[0])
    titles = {quote_sheetname(sheet.title): sheet.title for sheet in page.book.workbook.worksheets}
    return {titles.get(name, re.sub(r"^'|'$", "", name)) for name in found}
