"""Templates of reports: read with all their problems, and kept with the results so that their look can be repeated."""

from __future__ import annotations

import difflib
import hashlib
import re
import shutil
import warnings
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tractionpower.errors import InputError, OutputError, Problem
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import MEGABYTE, Source, write_files
from tractionpower.io.wording import did_you_mean, nearest, printable, shown
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT
from tractionpower.model.report import FIGURES, SHEETS, TRAIN_FIGURES, Report

REPORT_FILE = "report.yaml"
"""Name of a template in a folder of results."""

LOGO_FILE = "report-logo"
"""Name of its logo there, without the suffix."""

UNKNOWN_FIGURE = "unknown_figure"
"""Code of problems of names that no figure has."""

MOST_SHOWN = 5
"""Names that a message shows of all that are known."""

MOST_LOGO_MB = 5
MOST_PIXELS = 50_000_000
PICTURES = {"PNG": ".png", "JPEG": ".jpg"}
"""Kinds of pictures that a logo can be, with the suffix of each."""

_HEAD = (
    "# Template of the reports of these results, kept by tractionpower. `tractionpower report` honours what is changed here,\n"
    "# and a file that was changed is not written over.\n"
    "# as written: {digest}\n"
)


@dataclass(frozen=True, slots=True)
class ReportFile:
    """A template as read: its logo is the file itself, wherever it was named.

    Attributes
    ----------
    report
        The template.
    problems
        Warnings.
    """

    report: Report
    problems: tuple[Problem, ...] = ()


def read_report(path: Path) -> ReportFile:
    """Read a template.

    Raises
    ------
    InputError
        With all its problems.
    """
    reader = Reader(path.parent)
    report, _ = add_report(reader, Source(path, printable(path.as_posix()), "report"))
    if report is None or reader.has_errors:
        raise InputError(reader.problems)
    return ReportFile(report, tuple(reader.problems))


def add_report(reader: Reader, source: Source) -> tuple[Report | None, Mark | None]:
    """Read a template among the files of a study; return it, None if it is broken, and where its keys stand."""
    content = reader.read(source, Report)
    if content is None:
        return None, None
    reader.problems += [*_unknown_sheets(content.data, content.mark), *_unknown_figures(content.data, content.mark)]
    name = content.data.get("logo")
    logo = source.file.parent / name if isinstance(name, str) else None
    problem = _problem_of_logo(logo, str(name), content.mark.find(("logo",)).place) if logo is not None else None
    if problem is not None:
        reader.problems.append(problem)
    report = reader.validated(Report, content)
    if report is not None and logo is not None:
        report = report.model_copy(update={"logo": str(logo.absolute())})
    return report, content.mark


def keep_report(report: Report, folder: Path) -> bool:
    """Keep a template and its logo in a folder of results, so that reports made there later look the same.

    A template there that someone has edited stays; one without anything in it is none.

    Returns
    -------
    bool
        Whether the folder holds this template now.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    file = folder / REPORT_FILE
    if is_edited(file):
        return False
    try:
        if report == Report():
            file.unlink(missing_ok=True)
            return True
        named: dict[str, Any] = {}
        if report.logo is not None:
            named["logo"] = _copied(Path(report.logo), folder)
        told = report.model_copy(update=named).model_dump(mode="json", by_alias=True, exclude_defaults=True)
        text = document({"format": FORMAT, **told})
        write_files(folder, {REPORT_FILE: _HEAD.format(digest=_digest(text)) + text})
    except OSError as error:
        raise OutputError(f"the template cannot be kept in {printable(str(folder))}: {error.strerror or error}") from error
    return True


def kept_report(folder: Path) -> ReportFile | None:
    """Return the template that is kept in a folder of results, None if there is none.

    Raises
    ------
    InputError
        If someone has edited it, and it is wrong.
    """
    file = folder / REPORT_FILE
    return read_report(file) if file.is_file() else None


def is_edited(file: Path) -> bool:
    """Return whether a template in a folder of results is other than it was written: someone has edited it."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    except FileNotFoundError:
        return False
    except (OSError, ValueError):
        return True
    count = _HEAD.count("\n")
    return "".join(lines[:count]) != _HEAD.format(digest=_digest("".join(lines[count:])))


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _copied(logo: Path, folder: Path) -> str:
    """Copy a logo into a folder, unless it is there, and return its name."""
    name = f"{LOGO_FILE}{logo.suffix.lower()}"
    target = folder / name
    folder.mkdir(parents=True, exist_ok=True)
    if not (target.exists() and target.samefile(logo)):
        shutil.copyfile(logo, target)
    return name


def _unknown_sheets(data: Mapping[str, Any], mark: Mark) -> list[Problem]:
    """Return warnings of names that no sheet has; of other languages, whose names are known there, only of misspelt ones."""
    known = {name.casefold() for name in SHEETS}
    found = []
    for key in ("sheets", "leave_out"):
        names = data.get(key)
        for number, name in enumerate(names if isinstance(names, list) else ()):
            if not isinstance(name, str) or re.sub(r" \d+$", "", name).casefold() in known:  # a long list has Differences 2
                continue
            if data.get("language", "en") != "en" and not nearest(name, SHEETS):
                continue
            place, path = mark.find((key, number)).place, f"report.{key}[{number}]"
            remedy = did_you_mean(name, SHEETS) or "mend the name or leave it out; `tractionpower schema report` lists all names"
            allowed = f"the name of a sheet, such as {', '.join(_nearest_names(name, SHEETS))}"
            found.append(Problem("unknown_sheet", path, shown(name), allowed, remedy, "warning", place))
    return found


def _unknown_figures(data: Mapping[str, Any], mark: Mark) -> list[Problem]:
    """Return warnings of names that no figure has; a comparison with a measurement may have figures of such names."""
    figures = data.get("figures")
    names = figures.get("names") if isinstance(figures, dict) else None
    found = []
    for number, name in enumerate(names if isinstance(names, list) else ()):
        if not isinstance(name, str) or _is_figure(name):
            continue
        place, path = mark.find(("figures", "names", number)).place, f"report.figures.names[{number}]"
        remedy = did_you_mean(name, FIGURES) or "mend the name or leave it out; `tractionpower schema report` lists all names"
        allowed = f"the name of a figure, such as {', '.join(_nearest_names(name, FIGURES))}"
        found.append(Problem(UNKNOWN_FIGURE, path, shown(name), allowed, remedy, "warning", place))
    return found


def _is_figure(name: str) -> bool:
    """Return whether some figure can have a name: one that is known, a page or member of it, or a train's."""
    return name in FIGURES or any(name.startswith((f"{known}_", f"{known}/")) for known in FIGURES)


def _nearest_names(name: str, known: Collection[str]) -> list[str]:
    """Return the few of the known names that are most like a name."""
    by_lower = {each.casefold(): each for each in known}
    return [by_lower[each] for each in difflib.get_close_matches(name.casefold(), by_lower, MOST_SHOWN, 0.0)]


def errors_of_figures(report: Report, warnings: Iterable[Problem], trains: Collection[str]) -> list[Problem]:
    """Return as errors what hinders figures that a template names: warnings of unknown names, and trains that do not run.

    A command that computes for hours is to know them before.
    """
    found = [replace(problem, severity="error") for problem in warnings if problem.code == UNKNOWN_FIGURE]
    for number, name in enumerate(report.figures.names or ()):
        train = name.removeprefix(f"{TRAIN_FIGURES}/")
        if train != name and train not in trains:
            allowed, remedy = f"{TRAIN_FIGURES}/ID of a train of the timetable", did_you_mean(train, trains) or "mend the name"
            found.append(Problem(UNKNOWN_FIGURE, f"report.figures.names[{number}]", shown(name), allowed, remedy))
    return found


def _problem_of_logo(logo: Path, name: str, place: str) -> Problem | None:
    """Return what is wrong with a logo, None if it can be put on a cover."""
    allowed = f"a picture, {' or '.join(PICTURES)}, of at most {MOST_LOGO_MB} MB"
    try:
        if not logo.is_file():
            remedy = "mend the name, which is relative to the template, or add the picture"
            return Problem("missing_file", "report.logo", f"there is no file {shown(name)}", allowed, remedy, place=place)
        size = logo.stat().st_size
        if size > MOST_LOGO_MB * MEGABYTE:
            found = f"{shown(name)} has {size / MEGABYTE:.1f} MB"
            return Problem("file_too_large", "report.logo", found, allowed, "save it smaller", place=place)
        kind = _kind_of_picture(logo)
    except (OSError, ValueError) as error:
        found = f"{shown(name)} cannot be read: {printable(str(getattr(error, 'strerror', None) or error))}"
        return Problem("unreadable_file", "report.logo", found, allowed, "mend the file", place=place)
    if kind not in PICTURES:
        found = f"{shown(name)} is {'no picture' if not kind else f'a picture of kind {kind}'}"
        return Problem("not_a_picture", "report.logo", found, allowed, "save the logo as PNG", place=place)
    return None


def _kind_of_picture(file: Path) -> str:
    """Return the kind of a picture, such as PNG; empty for what is none, broken, or absurdly large."""
    from PIL import Image, UnidentifiedImageError  # noqa: PLC0415 - only templates with a logo need it

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(file) as picture:
                width, height = picture.size
                kind = str(picture.format or "")
                if width * height > MOST_PIXELS:
                    return ""
                picture.load()
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, SyntaxError, ValueError):
        return ""
    return kind
