"""Figures in files."""

import re

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from tractionpower.reporting.figures.base.style import COLOURS, STYLE, new_figure, png_names, save


def test_a_figure_gets_its_name_when_it_is_complete(tmp_path):
    with mpl.rc_context(STYLE):
        figure = new_figure(2.0, 1.0)
        figure.add_subplot().set_title("costs $5 and $6")  # no formula
    path = save(figure, tmp_path / "new" / "a.b.png")
    assert path.read_bytes().startswith(b"\x89PNG")
    assert [each.name for each in path.parent.iterdir()] == ["a.b.png"]


def test_no_text_is_turned_round_by_a_name(tmp_path):
    with mpl.rc_context(STYLE):
        figure = new_figure(4.0, 3.0)
        axes = figure.add_subplot()
        axes.set_xticks([0.0, 1.0], ["A", "B \u202eretal"])
        axes.set_ylabel("\u2066voltage")
        axes.annotate("train \u202e1", (0.0, 0.0))
        axes.plot([0.0, 1.0], [0.0, 1.0], label="\u202eC")
        axes.legend()
        figure.suptitle("study \u202d7")
    svg = save(figure, tmp_path / "a.svg").read_text(encoding="utf-8")
    shown = [each.get_text() for each in figure.findobj(Text)]
    assert {"B \ufffdretal", "\ufffdvoltage", "train \ufffd1", "\ufffdC", "study \ufffd7"} <= {*shown}
    assert not re.search("[\u202a-\u202e\u2066-\u2069]", svg)


def test_a_picture_is_drawn_once(tmp_path, monkeypatch):
    """Once placed by `finish`, nothing has to be placed again, which savefig would do by drawing it all for nothing."""
    drawn = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, renderer: (drawn.append(self), draw(self, renderer)))
    with mpl.rc_context(STYLE):
        figure = new_figure(2.0, 1.0)
        figure.add_subplot()
    save(figure, tmp_path / "a.png")
    assert len(drawn) == 1


def test_what_cannot_be_drawn_leaves_no_file(tmp_path, monkeypatch):
    figure = new_figure(2.0, 1.0)

    def fail(path, **options):
        path.write_bytes(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(figure, "savefig", fail)
    with pytest.raises(OSError, match="disk full"):
        save(figure, tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []


def test_names_of_files_differ_where_capitals_do_not_count():
    names = png_names(["IC 5/1", "ic 5/1", "7"])
    assert names["7"] == "7.png"
    assert len({name.lower() for name in names.values()}) == 3
    assert all("/" not in name and name.endswith(".png") for name in names.values())


def test_colours_differ_in_brightness_or_hue_for_every_eye():
    """The colours are those of Okabe and Ito, Color Universal Design (2008)."""
    assert set(COLOURS) == {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"}
