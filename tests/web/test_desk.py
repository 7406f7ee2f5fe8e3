"""The desk: a session that keeps in step with a clock, obeys orders, tells what is the case."""

from itertools import pairwise

import pytest
from fake_session import HIGHEST, FakeKeeper, FakeSession

from tractionpower.web.controls import Controls
from tractionpower.web.desk import FRAME_TICKS, MOST_WAITING, Desk
from tractionpower.web.orders import Action, SetFactor, SetLevel, SetPressure
from tractionpower.web.pacing import Pacer


class Drive:
    """A desk on a clock that the test moves; `plan` gives orders, by the number of the frame after which they come."""

    def __init__(self, session, plan, frames):
        self.now_s, self.plan, self.frames = 0.0, plan, frames
        self.said = []
        self.keeper = FakeKeeper()
        pacer = Pacer(0.01, clock=self.clock, sleep=self.sleep)
        controls = Controls(HIGHEST, independent=True)
        self.desk = Desk(session, controls, self.keeper, self.publish, pacer=pacer, clock=self.clock)
        self.desk.run()

    def clock(self):
        return self.now_s

    def sleep(self, seconds):
        self.now_s += seconds

    def publish(self, kind, content):
        self.said.append((self.now_s, kind, content))
        if kind == "frame":
            count = len(self.of("frame"))
            for order in self.plan.get(count, ()):
                assert self.desk.order(order)
            if count >= self.frames:
                self.desk.stop()

    def of(self, kind):
        return [content for _, its, content in self.said if its == kind]


START = {1: [Action("start")]}


def test_25_frames_a_second_and_100_steps_a_second():
    drive = Drive(FakeSession(), START, 101)
    frames = [now for now, kind, _ in drive.said if kind == "frame"]
    assert frames[100] - frames[0] == pytest.approx(4.0)
    told = drive.of("frame")[-1]["desk"]
    assert told["frames_per_s"] == pytest.approx(25.0)
    assert told["steps_per_s"] == pytest.approx(100.0)
    assert drive.of("frame")[-1]["snapshot"]["time_s"] == pytest.approx(4.0)


def test_it_waits_at_time_0_until_somebody_starts():
    drive = Drive(FakeSession(), {}, 50)
    assert {frame["snapshot"]["time_s"] for frame in drive.of("frame")} == {0.0}
    assert all(frame["desk"]["paused"] for frame in drive.of("frame"))


def test_moving_a_lever_starts_the_drive():
    session = FakeSession()
    drive = Drive(session, {2: [SetLevel("drive", 5)]}, 30)
    assert session.time_s == pytest.approx(28 * 0.04)
    assert drive.keeper.notes == [(0.0, {"drive": 5})]
    assert session.settings == [(0.0, {"drive": 5})]


def test_a_level_holds_until_the_next_order_of_its_control():
    session = FakeSession()
    drive = Drive(session, START | {5: [SetLevel("drive", 7)], 20: [SetLevel("brake", 3)], 40: [SetLevel("drive", 0)]}, 60)
    levels = [(frame["snapshot"]["drive"], frame["snapshot"]["brake"]) for frame in drive.of("frame")]
    assert levels == [(0, 0)] * 5 + [(7, 0)] * 15 + [(7, 3)] * 20 + [(0, 3)] * 20
    assert [time_s for time_s, _ in drive.keeper.notes] == pytest.approx([0.16, 0.76, 1.56])


def test_an_order_is_obeyed_before_the_next_tick():
    session = FakeSession()
    Drive(session, START | {10: [SetPressure(2.0)]}, 12)
    ((time_s, setting),) = session.settings
    assert time_s == pytest.approx(9 * FRAME_TICKS * 0.01)
    assert setting == {"independent_bar": 2.0}


@pytest.mark.parametrize("factor", [1, 2, 5, 10])
def test_time_passes_by_its_factor(factor):
    session = FakeSession()
    Drive(session, {1: [SetFactor(factor), Action("start")]}, 26)
    assert session.time_s == pytest.approx(1.0 * factor)


@pytest.mark.parametrize(("factor", "apart_s"), [(1, 0.04), (2, 0.04), (5, 0.05), (10, 0.1)])
def test_diagrams_keep_their_resolution_when_time_passes_faster(factor, apart_s):
    drive = Drive(FakeSession(), {1: [SetFactor(factor), Action("start")]}, 30)
    times = [point[0] for frame in drive.of("frame") for point in frame["points"]]
    gaps = [after - before for before, after in pairwise(times)]
    assert gaps == pytest.approx([apart_s] * len(gaps))
    assert times[-1] == pytest.approx(drive.of("frame")[-1]["snapshot"]["time_s"])


def test_slower_and_faster_stop_at_the_ends():
    plan = {1: [Action("slower"), *[Action("faster")] * 9], 3: [Action("slower")]}
    drive = Drive(FakeSession(), plan, 5)
    assert [frame["desk"]["factor"] for frame in drive.of("frame")] == [1, 10, 10, 5, 5]


def test_a_pause_stops_the_train_and_loses_nothing():
    session = FakeSession()
    drive = Drive(session, START | {11: [Action("pause")], 31: [Action("pause")]}, 41)
    times = [frame["snapshot"]["time_s"] for frame in drive.of("frame")]
    assert times[10:31] == pytest.approx([0.4] * 21)
    assert times[-1] == pytest.approx(0.8)
    assert drive.of("frame")[-1]["desk"]["given_up_s"] == 0.0


def test_a_notice_says_what_was_clipped():
    drive = Drive(FakeSession(), START | {3: [SetLevel("electric", 18)]}, 5)
    assert drive.of("notice") == [{"text": "electric level 18 is above the highest, 15: taken as 15"}]
    assert drive.keeper.notes[-1][1] == {"electric": 15.0}


def test_statistics_and_rows_are_taken_every_second():
    drive = Drive(FakeSession(), START, 130)
    times = [now for now, kind, _ in drive.said if kind == "statistics"]
    assert times == pytest.approx([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], abs=0.25)
    assert drive.keeper.taken == 6 + 1  # the last one at the end


def test_the_end_of_a_case_ends_the_drive():
    drive = Drive(FakeSession(end_s=0.5), START, 1000)
    assert drive.of("over") == [{"why": "finished", "time_s": pytest.approx(0.5)}]
    assert len(drive.of("frame")) < 20


def test_finish_ends_the_drive():
    drive = Drive(FakeSession(), START | {4: [Action("finish")]}, 1000)
    assert drive.of("over")[0]["why"] == "stopped"


def test_what_goes_wrong_ends_the_drive_and_is_kept():
    class Broken(FakeSession):
        def advance(self, until_s):
            if until_s > 0.2:
                raise ArithmeticError("no number")
            return super().advance(until_s)

    drive = Drive(Broken(), START, 1000)
    assert isinstance(drive.desk.failure, ArithmeticError)
    assert drive.of("over")[0]["why"] == "failed"
    assert drive.keeper.taken >= 1  # what was recorded before is not lost


def test_a_flood_of_orders_is_refused():
    desk = Desk(FakeSession(), Controls(HIGHEST, independent=True), FakeKeeper(), lambda *_: None)
    taken = [desk.order(SetLevel("drive", 1)) for _ in range(MOST_WAITING + 5)]
    assert taken == [True] * MOST_WAITING + [False] * 5
