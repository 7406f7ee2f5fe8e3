"""Choice of figures and kinds of files."""

import xml.etree.ElementTree as ET

import matplotlib as mpl
import pytest
from matplotlib.text import Text

from tractionpower.model.report import ReportFigures
from tractionpower.reporting.figures.base.drawing import FORMATS, drawing, files_of, stands_for, wanted
from tractionpower.reporting.figures.base.style import STYLE, new_figure, save, save_all, wrapped
from tractionpower.reporting.texts import language

NASTY = [
    "costs $5 and $6", "<script>alert(1)</script> --> & \"quoted\"", "=cmd()", "Fire \U0001f525 train", "x" * 300,
    "word " * 60, "Łódź Żabieniec", "tab\tand\nline", "_{a}^2 \\frac{1}{2} %d {n}",
]  # fmt: skip


def figure_called(title, width=4.0):
    with mpl.rc_context(STYLE):
        figure = new_figure(width, 2.0)
        axes = figure.add_subplot()
        axes.plot([0.0, 1.5], [0.5, 1.0], label="line")
        axes.set_ylim(0.0, 1.5)
        figure.legend(loc="outside lower center")
        figure.suptitle(title, x=0.01, ha="left")
    return figure


def test_only_chosen_figures_are_wanted():
    assert wanted("anything")
    with drawing(ReportFigures(names=("demand", "trains/IC 1", "curves"))):
        assert [name for name in ("demand", "demand_2", "demand_fine", "trains/IC 1", "trains/IC 11", "trains", "curves_ed250")
                if wanted(name)] == ["demand", "demand_2", "trains/IC 1", "curves_ed250"]  # fmt: skip
    assert wanted("anything")


def test_a_folder_stands_for_all_in_it():
    assert stands_for("trains", "trains/IC 1")
    assert not stands_for("train", "trains/IC 1")


@pytest.mark.parametrize("title", NASTY)
def test_every_kind_of_file_is_whole_whatever_the_names_are(tmp_path, title):
    with drawing(ReportFigures(formats=FORMATS), f"study {title}"):
        paths = save_all({"a": figure_called(title)}, tmp_path, ["a"])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.pdf", "a.png", "a.svg"]
    png, svg, pdf = paths
    assert png.read_bytes().startswith(b"\x89PNG")
    assert ET.parse(svg).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    assert not list(ET.parse(svg).iter("{http://www.w3.org/2000/svg}script"))
    assert pdf.read_bytes().startswith(b"%PDF")
    assert b"%%EOF" in pdf.read_bytes()[-10:]


def test_the_same_figure_gives_the_same_bytes(tmp_path):
    with drawing(ReportFigures(formats=FORMATS), "study x"):
        for folder in ("1", "2"):
            save_all({"a": figure_called("Łódź")}, tmp_path / folder, ["a"])
    for kind in FORMATS:
        content = (tmp_path / "1" / f"a.{kind}").read_bytes()
        assert content == (tmp_path / "2" / f"a.{kind}").read_bytes()
        assert b"Date" not in content or kind == "svg"
    assert b"<dc:date>" not in (tmp_path / "1" / "a.svg").read_bytes()
    assert b"FontFile2" in (tmp_path / "1" / "a.pdf").read_bytes()  # the font travels with the file


def test_files_of_other_kinds_go_and_those_of_others_stay(tmp_path):
    for name in ("a.svg", "a.png", "b.pdf", "b_2.png", "c.png", "a.txt", "mine.svg"):
        (tmp_path / name).write_bytes(b"earlier")
    with drawing(ReportFigures(formats=("pdf",), names=("a",))):
        paths = save_all({"a": figure_called("a"), "b": figure_called("b")}, tmp_path, ["a", "b"])
    assert [path.name for path in paths] == ["a.pdf"]
    assert {path.name for path in tmp_path.iterdir()} == {"a.pdf", "a.txt", "c.png", "mine.svg"}
    assert {path.name for path in files_of(tmp_path, ["c", "mine"])} == {"c.png", "mine.svg"}


@pytest.mark.parametrize("title", NASTY)
def test_titles_and_sources_stay_on_the_figure_and_on_nothing_else(tmp_path, title):
    with drawing(ReportFigures(), f"study {title}"):
        figure = figure_called(f"{title}: train graph")
        save(figure, tmp_path / "a.png")
    texts = [text for text in figure.findobj(Text) if text.get_text() and text.get_visible()]
    boxes = [text.get_window_extent() for text in texts]
    assert max(box.x1 for box in boxes) <= figure.bbox.x1
    head, foot = figure._suptitle.get_window_extent(), figure.texts[-1].get_window_extent()
    assert figure.axes[0].get_tightbbox().y1 <= head.y0 + 1.0
    assert figure.legends[0].get_window_extent().y0 >= foot.y1
    assert foot.y0 >= 0.0


def test_lines_break_between_words_but_not_before_a_unit():
    text = figure_called("x")._suptitle
    whole = "lowest voltage 2745 V, km 74.2, 05:52:57; highest current 3200 A at 12.5 ‰ and 3.3 kV 2 % of it"
    for room in range(120, 900, 20):
        lines = wrapped(text, whole, float(room), 100).split("\n")
        assert " ".join(lines) == whole or "…" in "".join(lines)
        assert not any(line.split(" ")[0].strip(",;") in {"V", "A", "kV", "%", "‰", "74.2"} for line in lines)


def test_polish_ticks_have_a_decimal_comma(tmp_path):
    with language("pl"):
        figure = figure_called("x")
        save(figure, tmp_path / "a.png")
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert "0,5" in labels
    assert not any("." in label for label in labels)
