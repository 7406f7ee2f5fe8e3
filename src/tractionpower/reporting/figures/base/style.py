"""The common style of all figures, and how a figure gets into a file."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, ScalarFormatter
from matplotlib.transforms import Bbox

from tractionpower.io.file_names import ENDING, file_names
from tractionpower.reporting.facts.characters import unturned
from tractionpower.reporting.figures.base.drawing import current_drawing, files_of, ignore_missing_glyphs, remove_files, wanted
from tractionpower.reporting.texts import current_language

# Okabe and Ito's colours stay apart for colour-blind eyes.
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
# Lines of several tracks often lie on each other: dashes let the lower one show through.
DASHES: tuple[Any, ...] = ("-", (0, (4, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2)))
INK, GREY, PALE = "#333333", "#777777", "#dddddd"
PAGE = 16.0 / 2.54
"""Width of the text of a page in a report [inches]. Figures are drawn as wide as that, so that 7 pt of text are 7 pt there."""

SMALLEST = 7.0
"""Smallest text of a figure [pt]."""

TITLE = 9.5
"""Size of a title [pt]."""

MOST_TITLE_LINES = 4

PNG_LEVEL = 3
"""Compression of PNG: above it files get 3 % smaller and take half as long again."""

_WORDS = re.compile(r"(?:km )?\S*\d (?:[AVs%‰]|[kM][VAW]|km/h)(?!\w)\S*|(?:km )\d\S*|\S+")
"""Words between which a line may break: not between a number and its unit."""

STYLE: Any = {
    "font.size": 8.5,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "axes.titlesize": TITLE,
    "figure.titlesize": TITLE,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": PALE,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "figure.dpi": 200.0,
    "figure.autolayout": False,
    "figure.constrained_layout.use": False,  # `new_figure` chooses the layout, whatever a user's own settings are
    "agg.path.chunksize": 20_000,
    "axes.formatter.useoffset": False,  # a voltage stands at its tick as it is
    "svg.fonttype": "path",  # looks the same where the font is missing, as in Word on Windows; the PDF keeps its text as text
    "svg.hashsalt": "tractionpower",  # the same figure gives the same file
    "pdf.fonttype": 42,  # fonts are embedded as they are
    "text.parse_math": False,  # a dollar sign in a user's name is no formula
}


def new_figure(width: float, height: float, between: float = 0.02) -> Figure:
    """Return an empty figure [inches] that needs no display; to be called inside ``mpl.rc_context(STYLE)``.

    `between` is the space between columns of panels as a share of their width.
    """
    figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(wspace=between))
    FigureCanvasAgg(figure)
    return figure


def png_names(identifiers: Iterable[str]) -> dict[str, str]:
    """Return the name of a PNG for each identifier; no two are the same on any system.

    >>> png_names(["EC 1/2"])
    {'EC 1/2': 'EC 1%2F2.png'}
    """
    return {identifier: f"{stem}.png" for identifier, stem in stems(identifiers).items()}


def stems(identifiers: Iterable[str]) -> dict[str, str]:
    """Return the name of a file without its ending for each identifier; no two are the same on any system."""
    return {identifier: name.removesuffix(ENDING) for identifier, name in file_names(identifiers).items()}


def save_all(drawn: Mapping[str, Figure], folder: Path, names: Iterable[str]) -> list[Path]:
    """Write figures by their names as the template says and return their paths.

    Files of `names` that are not written this time go, those of other kinds too.
    """
    paths = [path for name, figure in drawn.items() if wanted(name) for path in save_as(figure, folder, name)]
    remove_files(files_of(folder, names) - {*paths})
    return paths


def save_as(figure: Figure, folder: Path, stem: str) -> list[Path]:
    """Write a figure as each kind of file that the template asks for and return the paths."""
    return [save(figure, folder / f"{stem}.{kind}") for kind in current_drawing().formats]


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG, SVG or PDF, by the ending of `path`; the file gets its name when it is complete.

    The same figure gives the same bytes: no date is in them.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.tmp")
    kind = path.suffix[1:]
    try:
        with mpl.rc_context(STYLE), warnings.catch_warnings():
            ignore_missing_glyphs()
            warnings.filterwarnings("ignore", "constrained_layout not applied")  # a figure without room is drawn all the same
            finish(figure)
            more: dict[str, Any] = {"pil_kwargs": {"compress_level": PNG_LEVEL}} if kind == "png" else {}
            figure.savefig(temporary, format=kind, metadata=_about(figure, kind), **more)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def finish(figure: Figure) -> None:
    """Give a figure what all have in common, before it is written: title within its width, decimal sign, source, layout.

    Its parts are placed once, for all kinds of files.
    """
    engine = figure.get_layout_engine()
    if not isinstance(engine, ConstrainedLayoutEngine):
        return  # it has been written before
    _clean_texts(figure)
    _wrap_title(figure)
    if current_language() == "pl":
        _decimal_commas(figure)
    _write_source(figure, engine, current_drawing().source)
    if figure.axes:
        engine.execute(figure)
    _lift_legends(figure, engine)
    figure.set_layout_engine(None)  # with any other, also "none", savefig draws twice to place once more what has its place


def _clean_texts(figure: Figure) -> None:
    """Take from texts what would turn round the names in them; those at ticks are made from what their axis holds."""
    for parent in (figure, *figure.axes):
        for child in parent.get_children():
            if isinstance(child, Axes):
                continue
            form = child.get_major_formatter() if isinstance(child, Axis) else None
            if isinstance(form, FuncFormatter):  # labels that are given with their ticks are told by one
                form.func = _unturned_labels(form.func)
            for text in [child.label] if isinstance(child, Axis) else child.findobj(Text):
                words = unturned(text.get_text())
                if words != text.get_text():
                    text.set_text(words)


def _unturned_labels(label: Callable[..., str]) -> Callable[..., str]:
    return lambda x, position=None: unturned(label(x, position))


class _CommaFormatter(ScalarFormatter):
    """Numbers at ticks with a decimal comma."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        return str(super().__call__(x, pos)).replace(".", ",")


def _decimal_commas(figure: Figure) -> None:
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if type(axis.get_major_formatter()) is ScalarFormatter:
                axis.set_major_formatter(_CommaFormatter())


def _wrap_title(figure: Figure) -> None:
    """Break a title that is wider than its figure between words, and cut what is too long for a title."""
    title: Text | None = getattr(figure, "_suptitle", None)
    if title is None:
        return
    title.set_fontsize(TITLE)
    room = 0.98 * float(figure.bbox.width)
    title.set_text(wrapped(title, title.get_text(), room, MOST_TITLE_LINES))


def wrapped(text: Text, words: str, room: float, most_lines: int) -> str:
    """Return words in lines that are no wider than `room` [pixels] in the font of `text`; beyond `most_lines` they are cut."""
    lines: list[str] = []
    for whole in words.splitlines():
        line = ""
        for word in _WORDS.findall(whole):
            longer = f"{line} {word}".lstrip()
            if _width(text, longer) <= room:
                line = longer
                continue
            lines += [line] if line else []
            line = _cut(text, word, room)
        lines.append(line)
    return "\n".join(lines if len(lines) <= most_lines else [*lines[: most_lines - 1], f"{lines[most_lines - 1]} …"])


def _cut(text: Text, word: str, room: float) -> str:
    """Return a word, cut where it alone is wider than the room."""
    if _width(text, word) <= room:
        return word
    low, high = 0, len(word)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if _width(text, f"{word[:middle]}…") <= room else (low, middle)
    return f"{word[:low]}…"


def _width(text: Text, words: str) -> float:
    """Return how wide words are in the font of a text [pixels]."""
    before = text.get_text()
    text.set_text(words)
    width = float(text.get_window_extent().width)
    text.set_text(before)
    return width


def _write_source(figure: Figure, engine: ConstrainedLayoutEngine, source: str) -> None:
    """Write where a figure comes from at its foot, in a line that is added below all else."""
    if not source:
        return
    width, height = figure.get_size_inches()
    line = 1.7 * SMALLEST / 72.0
    figure.set_size_inches(width, height + line)
    share = line / (height + line)
    engine.set(rect=(0.0, share, 1.0, 1.0 - share))
    text = figure.text(0.01, 0.35 * share, "", fontsize=SMALLEST, color=GREY, va="bottom", ha="left", in_layout=False)
    text.set_text(wrapped(text, source, 0.98 * float(figure.bbox.width), 1))


def _lift_legends(figure: Figure, engine: ConstrainedLayoutEngine) -> None:
    """Set legends that stand outside of all axes above the source; the layout has kept room for them there."""
    rect = engine.get()["rect"]
    for legend in figure.legends if rect[1] > 0.0 else ():
        legend.set_bbox_to_anchor(Bbox.from_bounds(*rect), transform=figure.transFigure)


def _about(figure: Figure, kind: str) -> dict[str, Any]:
    """Return what a file tells about itself: its title and who drew it, nothing that changes from day to day."""
    title = "".join(c if c.isprintable() else " " for c in figure.get_suptitle().split("\n")[0])
    if kind == "png":
        return {"Title": title, "Software": "tractionpower"}
    nothing = {"Date": None} if kind == "svg" else {"CreationDate": None, "Producer": None}
    return {"Title": title, "Creator": "tractionpower", **nothing}
