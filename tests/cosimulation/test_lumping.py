"""The error of lumping the rails into the contact line, against the closed form of one-sided feeding."""

import pytest
from coupled import couple, run
from solved import seed_network

from tractionpower.cosimulation.lumping import lump_rails
from tractionpower.cosimulation.simulate import simulate
from tractionpower.model.change import apply_changes


def test_contact_lines_take_the_resistance_of_their_rails():
    supply, line = seed_network()
    lumped = lump_rails(supply, line, ())
    assert [(row.tracks, row.resistance_ohm_per_km) for row in lumped.contact_lines] == [
        (("1",), pytest.approx(0.07)), (("2",), pytest.approx(0.07)),
    ]  # fmt: skip
    assert [row.resistance_ohm_per_km for row in lumped.return_circuit] == [0.0]


def test_lumping_knows_neither_the_rails_nor_the_currents_of_the_other_track():
    """Fed from A alone, tracks tied nowhere else: the rails of both tracks carry both currents as far as the nearer train."""
    study = couple(run("x"), run("y", track="2", time=60.0), end_s=300.0)
    study = apply_changes(study, ["supply.substations[B].state=open", "supply.section_cabins[C].state=bypassed"])
    results = simulate(study)
    rows = results.table("trains")
    worst = rows.loc[rows.voltage_v.idxmin()]
    other = rows[(rows.time_s == worst.time_s) & (rows.train != worst.train)].iloc[0]
    ohm = study.supply.return_circuit[0].resistance_ohm_per_km
    told = results.run["lumping"]
    assert told["train"] == worst.train
    assert told["voltage_v"] == pytest.approx(worst.voltage_v, abs=0.01)  # tables hold voltages in single precision
    other_drop = ohm * other.current_a * min(worst.position_km, other.position_km)
    own_drop = ohm * worst.current_a * worst.position_km
    assert own_drop > 1.0
    assert told["lumped_voltage_v"] - told["voltage_v"] == pytest.approx(other_drop - own_drop, rel=1e-3)


def test_without_trains_there_is_nothing_to_compare():
    assert simulate(couple(end_s=10.0)).run["lumping"] == {}


def test_names_of_trains_and_loads_may_be_as_long_as_names_may_be():
    """A train and a load with 300 characters and the same name: taps of their own, no identifier that is too long."""
    name = "x" * 300
    load = {"id": name, "track": "2", "km": 5.0, "current_a": 100.0}
    told = simulate(couple(run(name), end_s=60.0, loads=[load])).run["lumping"]
    assert told["train"] == name
    assert told["lumped_voltage_v"] != told["voltage_v"]
