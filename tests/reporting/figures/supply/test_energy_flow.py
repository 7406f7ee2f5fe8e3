"""Energy flow: what goes in comes out, in words and in widths."""

import numpy as np
import pytest
from fake_runs import figure as key_figure
from fake_runs import small_run

from tractionpower.reporting.facts.energy_flow import energy_stages
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.supply.energy_flow import energy_flow, lay_out, ribbon
from tractionpower.results.results import Results

ELECTRIC = {"source": 10_000.0, "regulation": 200.0, "train": 9000.0, "load": 300.0, "conductor": 500.0}
TRAINS = {"line": 9000.0, "wheel": 7400.0, "drive_loss": 900.0, "starting_resistors": 50.0, "auxiliaries": 1650.0,
          "recovered": 1000.0, "coupling": 0.0, "fitted": 0.0, "out_of_nothing": 0.0}  # fmt: skip
WHEEL = {"wheel": 7400.0, "kinetic": 100.0, "potential": -200.0, "resistance": 6000.0, "brakes": 1500.0}


def told(energies):
    return {"closes": True} | {f"{name}_kwh": value for name, value in energies.items()}


def run_of(electric=ELECTRIC, trains=TRAINS, wheel=WHEEL, returned=700.0, name=None):
    """Return a run with these ledgers; what has no energies is left out."""
    run = small_run()
    parts = {"electric": electric, "pantograph_to_wheel": trains, "mechanical": wheel}
    ledgers = {part: told(energies) for part, energies in parts.items() if energies}
    figures = [key_figure("energy_returned_kwh", returned, "train 1")] if returned else []
    scenario = run.scenario if name is None else run.scenario.model_copy(update={"name": name})
    return RunData(Results({"ledgers": ledgers, "study": "flow"}, figures, {}), scenario)


def sums(stages):
    given = {flow.name: flow.kwh for stage in stages for flow in stage.gains}
    spent = {flow.name: flow.kwh for stage in stages for flow in stage.spends}
    return given, spent


def test_flows_are_those_of_the_ledgers_and_each_stage_gives_on_what_the_next_one_gets():
    stages = energy_stages(run_of())
    given, spent = sums(stages)
    assert given == {"source": 10_000.0, "returned": 700.0, "on_board": 300.0, "potential": 200.0}
    assert spent == {"regulation": 200.0, "conductor": 500.0, "load": 300.0, "auxiliaries": 1650.0, "starting_resistors": 50.0,
                     "drive_loss": 900.0, "resistance": 6000.0, "kinetic": 100.0, "all_brakes": 500.0}  # fmt: skip
    streams = np.cumsum([stage.left_kwh for stage in stages])
    np.testing.assert_allclose(streams, [9800.0, 9700.0, 7400.0, 1500.0, 1000.0])
    assert [stage.name for stage in stages] == ["substations", "network", "trains", "wheel", "braking"]


def test_what_is_drawn_in_is_as_wide_as_what_is_drawn_out():
    layout = lay_out(energy_stages(run_of()))
    bands = {band.name: band for band in layout.bands}
    for band in bands.values():
        assert band.width == pytest.approx(layout.scale * band.kwh)
    loops = bands["returned"].width + bands["on_board"].width
    out = sum(band.width for band in layout.bands if band.tip)
    into = layout.scale * 10_000.0 + bands["potential"].width
    assert into == pytest.approx(out)
    # The stream begins as wide as the source and ends as wide as what goes back.
    (left, right, *_), (end_left, end_right, *_) = layout.parts[0], layout.parts[-1]
    assert right - left == pytest.approx(layout.scale * 10_000.0)
    assert end_right - end_left == pytest.approx(loops)


def test_streams_that_go_back_do_not_cross():
    layout = lay_out(energy_stages(run_of()))
    lanes = {band.name: (band.corners[2][0], band.width, band.corners[3][1]) for band in layout.bands if len(band.corners) > 3}
    (far, far_width, far_y), (near, near_width, near_y) = lanes["returned"], lanes["on_board"]
    assert far_y < near_y  # the outer one goes further up
    assert far + far_width / 2 < near - near_width / 2


NOT_BACK = {
    "electric": ELECTRIC | {"train": 10_000.0, "source": 11_000.0},
    "trains": TRAINS | {"recovered": 0.0, "line": 10_000.0},
    "returned": 0.0,
}
NO_LOADS = {
    "electric": ELECTRIC | {"load": 0.0, "train": 9300.0},
    "trains": TRAINS | {"line": 9300.0, "auxiliaries": 1950.0},
}
NO_TRAINS = {"electric": ELECTRIC | {"train": 0.0, "load": 9300.0}, "trains": None, "wheel": None, "returned": 0.0}


@pytest.mark.parametrize(
    ("parts", "missing"),
    [
        (NOT_BACK, {"returned", "on_board"}),
        (NO_LOADS, {"load"}),
        (NO_TRAINS, {"auxiliaries", "resistance"}),
        ({"electric": None}, {"source", "regulation", "conductor"}),
        ({"wheel": None}, {"resistance", "all_brakes"}),
    ],
    ids=["no regeneration", "no loads", "no trains", "no supply", "no mechanical ledger"],
)
def test_runs_that_lack_a_part_balance_too(no_overlap, parts, missing):
    data = run_of(**parts)
    stages = energy_stages(data)
    given, spent = sums(stages)
    assert not missing & {*given, *spent}
    figure = energy_flow(data)
    layout = lay_out(stages)
    recovered = sum(band.kwh for band in layout.bands if len(band.corners) > 3 and not band.tip and band.name in given and
                    band.name in ("returned", "on_board"))  # fmt: skip
    assert sum(given.values()) == pytest.approx(sum(spent.values()) + recovered, rel=1e-4)
    no_overlap(figure, figure.axes[0].texts)


def test_heat_of_plant_and_feeders_is_told_apart_where_it_is_known():
    data = run_of()
    figures = [key_figure("plant_heat_kwh", 30.0, "substation A"), key_figure("plant_heat_kwh", 20.0, "substation B"),
               key_figure("feeder_heat_kwh", 120.0, "feeder A 1 low_km")]  # fmt: skip
    known = RunData(Results(data.results.run, [*data.results.key_figures, *figures], {}), data.scenario)
    _, spent = sums(energy_stages(known))
    assert (spent["plant_heat"], spent["commutation"]) == (50.0, 150.0)
    assert (spent["feeders"], spent["lines"]) == (120.0, 380.0)
    assert not {"regulation", "conductor"} & {*spent}


def test_a_difference_between_ledgers_is_a_flow_of_its_own():
    _, spent = sums(energy_stages(run_of(electric=ELECTRIC | {"source": 10_400.0})))
    assert spent["rest"] == pytest.approx(400.0)


def test_two_way_substations_that_get_more_than_they_give_feed_the_grid():
    electric = {"source": -500.0, "regulation": 20.0, "train": -600.0, "load": 50.0, "conductor": 30.0}
    trains = TRAINS | {"line": -600.0, "recovered": 1000.0, "wheel": 200.0, "auxiliaries": 150.0, "drive_loss": 30.0,
                       "starting_resistors": 20.0}  # fmt: skip
    wheel = {"wheel": 200.0, "kinetic": 0.0, "potential": -2000.0, "resistance": 700.0, "brakes": 1500.0}
    stages = energy_stages(run_of(electric, trains, wheel, returned=900.0))
    given, spent = sums(stages)
    assert spent["grid"] == 500.0
    assert sum(given.values()) == pytest.approx(sum(spent.values()) + 1000.0)
    assert energy_flow(run_of(electric, trains, wheel, returned=900.0)) is not None


def test_texts_of_tiny_flows_stand_apart_and_tell_their_values(no_overlap):
    tiny = TRAINS | {"starting_resistors": 0.004, "coupling": 0.003, "line": 8950.007}
    electric = ELECTRIC | {"load": 0.002, "regulation": 0.001, "source": 9450.01, "train": 8950.007}
    figure = energy_flow(run_of(electric, tiny, returned=0.5))
    no_overlap(figure, figure.axes[0].texts)
    (starting,) = [text.get_text() for text in figure.axes[0].texts if "starting resistors" in text.get_text()]
    assert starting.endswith("0 kWh, < 0.1 %")
    (running,) = [text.get_text() for text in figure.axes[0].texts if "running resistance" in text.get_text()]
    assert running.endswith("6000 kWh, 63.5 %")


def test_a_nasty_name_of_a_study_does_no_harm():
    drawn = energy_flow(run_of(name="=cmd()$\\frac$<script>" + 279 * "x"))
    assert drawn.get_suptitle().startswith("=cmd()$\\frac$<script>")
    assert drawn.get_suptitle().endswith(": energy flow")
    drawn.canvas.draw()


def test_no_ledgers_no_figure():
    assert energy_flow(run_of(None, None, None)) is None
    zero = dict.fromkeys(ELECTRIC, 0.0)
    assert energy_flow(run_of(zero, None, None)) is None


def test_a_ribbon_keeps_its_width_around_a_corner():
    outline = ribbon([(0.0, 0.0), (0.0, 2.0), (3.0, 2.0)], 0.4)
    half = len(outline) // 2
    across = outline[:half] - outline[half:][::-1]
    np.testing.assert_allclose(np.hypot(*across.T), 0.4)
