"""How the reports of a command look: the template and the language that its options name."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tractionpower.cli.messages import tell, tell_problems

if TYPE_CHECKING:
    from tractionpower.model.report import Report


@dataclass(frozen=True, slots=True)
class Look:
    """What the options say of the reports.

    Attributes
    ----------
    template
        The template that ``--template`` names, None without it.
    language
        The language that ``--language`` names, None without it.
    """

    template: Report | None = None
    language: str | None = None

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
    from tractionpower.io.report_files import read_report
    from tractionpower.io.wording import shown
    from tractionpower.model.report import Language

    if language is not None and language not in get_args(Language):
        raise UsageError(f"there is no language {shown(language)}; known are {', '.join(get_args(Language))}")
    if template is None:
        return Look(None, language)
    read = read_report(template)
    tell_problems(read.problems)
    return Look(read.report, language)
