"""How the reports of a command look: the template and the language that its options name."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tractionpower.cli.messages import tell, tell_problems

if TYPE_CHECKING:
    from tractionpower.errors import Problem
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.report import Report
    from tractionpower.model.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Look:
    """What the options say of the reports.

    Attributes
    ----------
    template
        The template that ``--template`` names, None without it.
    language
        The language that ``--language`` names, None without it.
    file
        Where that template is.
    unknown
        Warnings of figures that it names and the program does not know, not told yet.
    """

    template: Report | None = None
    language: str | None = None
    file: str = ""
    unknown: tuple[Problem, ...] = ()

    def check(self, loaded: LoadedScenario, scenario: Scenario) -> None:
        """Refuse a template that names figures that there are none of, before anything is computed.

        Raises
        ------
        InputError
            With all such names.
        """
        from tractionpower.errors import InputError
        from tractionpower.io.report_files import errors_of_figures

        if self.template is not None:
            self.check_own([run.id for run in scenario.runs])
            return
        errors = (
            [] if loaded.report is None else errors_of_figures(loaded.report, loaded.problems, [run.id for run in scenario.runs])
        )
        if errors:
            raise InputError(loaded.provenance.place(errors))

    def check_own(self, trains: Collection[str] = ()) -> None:
        """Refuse a template of the options that names figures that there are none of; `trains` have figures of their own.

        Raises
        ------
        InputError
            With all such names.
        """
        from dataclasses import replace

        from tractionpower.errors import InputError
        from tractionpower.io.report_files import errors_of_figures

        if self.template is None:
            return
        errors = errors_of_figures(self.template, self.unknown, trains)
        if errors:
            raise InputError([problem if problem.place else replace(problem, place=self.file) for problem in errors])

    def report(self, folder: Path, of_study: Report | None = None, *, is_new: bool = True, keep: bool = True) -> Report:
        """Return the template of the reports in a folder of results, and keep it there.

        The option wins over what someone has edited in the folder, that over the template of the study.

        Parameters
        ----------
        folder
            The results.
        of_study
            The template that the study names.
        is_new
            Whether results are new: a template that is kept from before, and was not edited, counts no more.
        keep
            Whether the folder keeps it; not where the reports go elsewhere.
        """
        from tractionpower.io.report_files import REPORT_FILE, is_edited, keep_report, kept_report
        from tractionpower.model.report import Report

        tell_problems(self.unknown)
        chosen = self.template
        if chosen is None and (not is_new or is_edited(folder / REPORT_FILE)):
            kept = kept_report(folder)
            tell_problems(kept.problems if kept is not None else ())
            chosen = kept.report if kept is not None else None
        chosen = chosen or of_study or Report()
        if self.language is not None:
            chosen = chosen.model_copy(update={"language": self.language})
        if keep and not keep_report(chosen, folder) and self.template is not None:
            tell(f"{folder / REPORT_FILE} was edited and stays; these reports follow --template")
        return chosen


def look_of(template: Path | None, language: str | None) -> Look:
    """Return the look that the options name; read before anything is computed, so that a mistake in it costs no time.

    Raises
    ------
    InputError, UsageError
        If the template is wrong, or there is no such language.
    """
    from typing import get_args

    from tractionpower.errors import UsageError
    from tractionpower.io.report_files import UNKNOWN_FIGURE, read_report
    from tractionpower.io.wording import shown
    from tractionpower.model.report import Language

    if language is not None and language not in get_args(Language):
        raise UsageError(f"there is no language {shown(language)}; known are {', '.join(get_args(Language))}")
    if template is None:
        return Look(None, language)
    read = read_report(template)
    unknown = tuple(problem for problem in read.problems if problem.code == UNKNOWN_FIGURE)
    tell_problems(problem for problem in read.problems if problem not in unknown)
    return Look(read.report, language, str(template), unknown)
