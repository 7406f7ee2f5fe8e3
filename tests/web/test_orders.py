"""Orders of the page: read strictly, and what the controls make of them."""

import pytest

from tractionpower.web.controls import Controls
from tractionpower.web.orders import Action, SetFactor, SetLevel, SetPressure, StepLevel, read_order

GOOD = {
    '{"set": "brake", "level": 15}': SetLevel("brake", 15),
    '{"set": "drive", "level": 0}': SetLevel("drive", 0),
    '{"step": "electric", "by": -1}': StepLevel("electric", -1),
    '{"set": "independent", "bar": 2}': SetPressure(2.0),
    '{"set": "independent", "bar": 0.25}': SetPressure(0.25),
    '{"factor": 5}': SetFactor(5),
    '{"do": "emergency"}': Action("emergency"),
}
BAD = [
    "",
    "{",
    "[]",
    "null",
    "5",
    '"set"',
    '{"set": "horn", "level": 1}',
    '{"set": "brake", "level": -1}',
    '{"set": "brake", "level": 1.5}',
    '{"set": "brake", "level": true}',
    '{"set": "brake", "level": "1"}',
    '{"set": "brake", "level": 100000}',
    '{"step": "brake", "by": 2}',
    '{"step": "brake", "by": 0}',
    '{"step": "brake", "by": true}',
    '{"set": "independent", "bar": NaN}',
    '{"set": "independent", "bar": 99}',
    '{"set": "independent", "bar": true}',
    '{"factor": 3}',
    '{"factor": true}',
    '{"do": "quit"}',
    '{"do": ["emergency"]}',
    '{"set": "brake", "level": 1' + " " * 400 + "}",
    "[" * 299,
]


@pytest.mark.parametrize("text", GOOD)
def test_an_order_is_read(text):
    assert read_order(text) == GOOD[text]


@pytest.mark.parametrize("text", BAD)
def test_anything_else_is_none(text):
    assert read_order(text) is None


def controls(drive=15, brake=15, electric=8, independent=True):
    return Controls({"drive": drive, "brake": brake, "electric": electric}, independent=independent)


def test_a_level_above_the_highest_is_clipped_and_said():
    setting, notice = controls(brake=8).obey(SetLevel("brake", 12))
    assert setting == {"brake": 8}
    assert "12" in notice
    assert "8" in notice


def test_arrow_keys_move_a_lever_and_stop_at_its_ends():
    mine = controls(drive=2)
    levels = [mine.obey(StepLevel("drive", by)) for by in (1, 1, 1, -1, -1, -1)]
    assert [setting["drive"] for setting, _ in levels] == [1, 2, 2, 1, 0, 0]
    assert all(notice == "" for _, notice in levels)


def test_more_brake_after_emergency_starts_at_full_service_and_less_releases_by_a_level():
    mine = controls()
    assert mine.obey(Action("emergency")) == ({"brake": "emergency"}, "")
    assert mine.obey(StepLevel("brake", -1)) == ({"brake": 14}, "")
    assert mine.obey(Action("charge")) == ({"brake": "charge"}, "")
    assert mine.obey(StepLevel("brake", 1)) == ({"brake": 1}, "")


def test_the_electric_brake_is_set_by_its_level():
    assert controls().obey(StepLevel("electric", 1)) == ({"electric": 1.0}, "")


@pytest.mark.parametrize(
    ("order", "word"),
    [(SetLevel("electric", 1), "electric"), (SetPressure(1.0), "independent"), (Action("emergency"), "brake")],
)
def test_a_control_that_the_train_has_not_is_said_and_sets_nothing(order, word):
    setting, notice = controls(brake=0, electric=0, independent=False).obey(order)
    assert setting == {}
    assert word in notice


def test_levels_are_independent_of_each_other():
    mine = controls()
    mine.obey(SetLevel("drive", 9))
    mine.obey(SetLevel("brake", 4))
    assert mine.levels == {"drive": 9, "brake": 4, "electric": 0}
