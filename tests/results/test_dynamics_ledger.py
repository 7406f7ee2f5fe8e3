"""The energy ledger: what is left over, how much a method may leave, what to do about it."""

import json

import pytest

from tractionpower.results.dynamics_ledger import CLOSING, EnergyLedger, closing_note


def left_over(share):
    """Return a ledger of 1 kWh that leaves a part of it over."""
    return EnergyLedger(3.6e6, 0.0, (1.0 - share) * 3.6e6, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_a_ledger_with_a_hole_is_told():
    ledger = EnergyLedger(3.6e6, 0.0, 1.8e6, 0.9e6, 0.0, 0.0, 0.0, 0.0)
    assert ledger.gap == pytest.approx(0.9e6)
    told = ledger.as_dict("euler")
    assert not told["closes"] and told["gap_share"] == pytest.approx(0.25)
    downhill = EnergyLedger(0.0, 0.0, 3.6e6, 0.0, -3.6e6, 0.0, 0.0, 0.0)
    assert downhill.as_dict("symplectic")["closes"] and downhill.put_in == pytest.approx(3.6e6)
    broken = EnergyLedger(float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).as_dict("euler")
    assert not broken["closes"] and broken["gap_kwh"] is None
    json.dumps(broken, allow_nan=False)
    from_nothing = EnergyLedger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0).as_dict("euler")
    assert not from_nothing["closes"]
    assert EnergyLedger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).as_dict("symplectic")["closes"]


@pytest.mark.parametrize(
    ("method", "share", "closes", "is_noted"),
    [
        ("symplectic", 0.9e-6, True, False), ("symplectic", 1.1e-6, False, True),
        ("variable", 0.9e-6, True, False), ("variable", 1.1e-6, False, True),
        ("rk4", 0.9e-6, True, False), ("rk4", 6.4e-5, True, True), ("rk4", 1.1e-3, False, True),
        ("euler", 4.9e-2, True, False), ("euler", 5.1e-2, False, True),
    ],
)  # fmt: skip
def test_each_method_is_asked_for_what_it_can_do(method, share, closes, is_noted):
    told = left_over(share).as_dict(method)
    assert told["closes"] is closes
    assert (told["target_share"], told["limit_share"]) == CLOSING[method]
    assert bool(closing_note(left_over(share).gap_share, method, 0.005, 1e-6)) is is_noted


def test_the_step_that_a_note_names_closes_the_ledger():
    # A locomotive with 199 wagons on buffers, emergency: 1.41e-4 at 5 ms, 4.4e-6 at 2.5 ms, 1.3e-7 at 1.25 ms.
    note = closing_note(1.41e-4, "rk4", 0.005, 1e-6)
    assert "shorten step_s of 0.005 s to " in note
    assert 0.0002 <= float(note.split(" to ")[1].removesuffix(" s")) <= 0.00125


def test_a_variable_step_is_shortened_by_its_tolerance():
    assert closing_note(2e-6, "variable", 0.005, 1e-6).endswith("lower tolerance of 1e-06 to 1e-07")


@pytest.mark.parametrize("share", [float("nan"), float("inf")])
def test_a_ledger_without_a_number_is_noted(share):
    assert "to 0.002 s" in closing_note(share, "rk4", 0.005, 1e-6)
