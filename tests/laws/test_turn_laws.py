"""Random days of sets that turn, are joined and split: where a set is, it is once, and it leaves as the rule says."""

import numpy as np
import pytest
from coupled import couple, run, vehicle

from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import copy_state, new_buffers
from tractionpower.kernels.train_tables import DWELLING
from tractionpower.model.timetable import Timetable

SEEDS = range(24)
STEPS = 2000
AUXILIARY_W = 60e3
KM = {"A": 0.0, "P": 6.0, "Q": 13.0}
VEHICLES = [vehicle("inverter", auxiliaries={"power_kw": AUXILIARY_W / 1e3})]


def leg(name, start, end, departure):
    """Return a run from one station to another that leaves at `departure` at the earliest."""
    calls = [{"station": start, "departure": departure}, {"station": end, "min_dwell_s": 7.0}]
    track = "1" if KM[start] < KM[end] else "2"
    return run(name, track=track, low=KM[start], high=KM[end], time=departure, calls=calls)


def random_day(seed):
    """Return a scenario with some sets that shuttle between A, P and Q; two of them may be joined, or a train split, at P."""
    rng = np.random.default_rng(seed)
    names = iter(rng.permutation([f"t{k:02d}" for k in range(40)]).tolist())
    runs, turns = [], {"rotations": [], "joins": [], "splits": []}

    def chain(start, time, legs):
        mine = []
        for _ in range(legs):
            end = str(rng.choice([each for each in KM if each != start]))
            runs.append(leg(next(names), start, end, round(time, 1)))
            mine.append(runs[-1]["id"])
            start, time = end, time + float(rng.uniform(100.0, 700.0))
        if legs > 1:
            turns["rotations"].append({"runs": mine, "turn_round_s": float(rng.choice([0.0, 30.0, 61.7]))})

    for _ in range(int(rng.integers(1, 4))):
        chain(str(rng.choice(list(KM))), float(rng.uniform(0.0, 400.0)), int(rng.integers(1, 5)))
    portions = [leg(next(names), "A", "P", round(float(rng.uniform(0.0, 300.0)), 1)) for _ in range(2)]
    into = leg(next(names), "P", "Q", round(float(rng.uniform(200.0, 700.0)), 1))
    parts = [leg(next(names), "Q", end, round(float(rng.uniform(600.0, 1500.0)), 1)) for end in "AP"]
    runs += [*portions, into, *parts]
    turns["joins"].append({"portions": [each["id"] for each in portions], "into": into["id"], "coupling_s": 90.0})
    turns["splits"].append({"run": into["id"], "portions": [each["id"] for each in parts], "uncoupling_s": 45.0})
    order = rng.permutation(len(runs))
    scenario = couple(*runs, end_s=float(STEPS), vehicles=VEHICLES)
    plain = {"trains": [runs[k] for k in order], **turns}
    return scenario.model_copy(update={"timetable": Timetable.model_validate(plain)})


class Day:
    """A day that was run, by train."""

    def __init__(self, scenario, cuts=()):
        compiled = compile_scenario(scenario)
        self.names, self.tables = compiled.movement.names, compiled.block.trains
        state, rows = start_state(compiled), []
        for end in [*cuts, STEPS]:
            buffers = new_buffers(compiled.block, STEPS)
            steps, _ = advance(compiled.block, state, buffers, end)
            rows.append(buffers.trains[: int(buffers.steps["trains"][:steps].sum())])
            state = copy_state(state) if cuts else state
        self.rows, self.state = np.concatenate(rows), state.trains

    def links(self):
        """Yield (first, then, turn-round [s]) by number."""
        for k, train in enumerate(self.tables.trains):
            for turn in self.tables.turns[train["first_turn"] : train["first_turn"] + train["turns"]]:
                yield k, int(turn["then"]), float(turn["turn_s"])

    def steps_of(self, k):
        return self.rows["time_s"][self.rows["train"] == k]


@pytest.fixture(scope="module", params=SEEDS)
def day(request):
    return Day(random_day(request.param))


def test_a_set_is_on_the_line_once_and_at_all_times(day):
    for first, then, _ in day.links():
        before, after = day.steps_of(first), day.steps_of(then)
        if len(after):
            last = max(day.steps_of(k)[-1] for k, other, _ in day.links() if other == then)
            assert before[-1] == last  # it waits for other portions
            assert after[0] == last + 1.0
        elif len(before):
            assert before[-1] == STEPS - 1.0
    for k in range(len(day.names)):
        steps = day.steps_of(k)
        assert len(steps) == 0 or np.array_equal(steps, np.arange(steps[0], steps[-1] + 1.0))


def test_it_leaves_when_it_may(day):
    for k, train in enumerate(day.tables.trains):
        mine = [(first, turn_s) for first, then, turn_s in day.links() if then == k]
        left = day.state.left_s[train["first_stop"]]
        if mine and np.isfinite(left):
            ready = max(day.state.movers["finished_s"][first] for first, _ in mine)
            due = max(train["start_s"], ready + mine[0][1])
            assert left == pytest.approx(max(due, np.floor(ready) + 1.0), abs=1e-6)
        elif np.isfinite(left):
            assert left == pytest.approx(train["start_s"], abs=1e-6)


def test_the_auxiliaries_of_a_set_go_on_from_its_first_to_its_last_step(day):
    """From the entry of the first run to the end of the last, but for that of other portions."""
    movers = day.state.movers
    ends = np.where(np.isfinite(movers["finished_s"]), movers["finished_s"], float(STEPS))
    for k, train in enumerate(day.tables.trains):
        steps = day.rows[day.rows["train"] == k]
        if not len(steps):
            continue
        begin = steps["time_s"][0] if train["waits"] else train["start_s"]
        end = steps["time_s"][-1] + 1.0 if train["turns"] else ends[k]
        assert steps["auxiliary_w"].sum() == pytest.approx(AUXILIARY_W * (end - begin), rel=1e-9)
        if train["waits"]:
            assert steps["phase"][0] == DWELLING


@pytest.mark.parametrize("seed", [0, 5, 11])
def test_neither_blocks_nor_copies_matter(seed):
    scenario = random_day(seed)
    cuts = np.unique(np.random.default_rng(seed).integers(1, STEPS, 300)).tolist()
    assert Day(scenario, cuts).rows.tobytes() == Day(scenario).rows.tobytes()
