"""The pace of the model, with a clock that the test moves."""

import pytest

from tractionpower.web.pacing import Pacer, Rate


class Wall:
    """A clock that moves when somebody sleeps or works; each sleep lasts `over_s` longer than wanted."""

    def __init__(self, over_s=0.0):
        self.now_s, self.over_s, self.slept = 100.0, over_s, []

    def clock(self):
        return self.now_s

    def sleep(self, seconds):
        self.slept.append(seconds)
        self.now_s += seconds + self.over_s


def paced(wall, works, **more):
    pacer = Pacer(0.01, clock=wall.clock, sleep=wall.sleep, **more)
    pacer.begin()
    for work_s in works:
        pacer.wait()
        wall.now_s += work_s
        pacer.done()
    return pacer


def test_deadlines_are_absolute_so_sleeping_too_long_adds_nothing_up():
    wall = Wall(over_s=0.0007)
    pacer = paced(wall, [0.001] * 500)
    assert wall.now_s - 100.0 == pytest.approx(500 * 0.01 + 0.0007 + 0.001, abs=1e-9)
    assert pacer.longest_lag_s == pytest.approx(0.0017, abs=1e-9)
    assert pacer.given_up_s == 0.0


def test_the_lag_of_a_long_step_is_caught_up_without_sleeping():
    wall = Wall()
    pacer = paced(wall, [0.001] * 10 + [0.055] + [0.001] * 20)
    assert wall.now_s - 100.0 == pytest.approx(31 * 0.01 + 0.001)
    assert pacer.longest_lag_s == pytest.approx(0.055)
    assert pacer.given_up_s == 0.0
    assert len(wall.slept) == 31 - 6  # six deadlines had passed already: after 55, 46, 37, 28, 19 and 10 ms


def test_a_lag_too_long_to_catch_up_is_given_up_and_counted():
    wall = Wall()
    pacer = paced(wall, [0.001] * 10 + [3.0] + [0.001] * 10, most_behind_s=0.25)
    assert pacer.given_up_s == pytest.approx(3.0 - 0.01)
    assert wall.now_s - 100.0 == pytest.approx((10 + 10) * 0.01 + 3.0 + 0.001)


def test_a_model_that_is_too_slow_falls_back_without_ever_running_away():
    wall = Wall()
    pacer = paced(wall, [0.02] * 200)
    assert wall.slept[1:] == []  # the first deadline only was ahead
    assert pacer.given_up_s == pytest.approx(wall.now_s - 100.0 - 200 * 0.01, abs=0.25 + 0.02)
    assert pacer.longest_lag_s < 0.25 + 0.02


def test_the_shown_lag_is_that_of_the_last_second():
    wall = Wall()
    pacer = paced(wall, [0.03] + [0.001] * 150)
    assert pacer.lag_s == pytest.approx(0.001)
    assert pacer.longest_lag_s == pytest.approx(0.03)


def test_after_a_pause_the_schedule_begins_anew():
    wall = Wall()
    pacer = paced(wall, [0.001] * 3)
    wall.now_s += 60.0
    pacer.begin()
    pacer.wait()
    pacer.done()
    assert pacer.longest_lag_s == pytest.approx(0.001)


def test_a_rate_is_that_of_the_last_second():
    wall = Wall()
    rate = Rate(wall.clock)
    count = 0
    for _ in range(100):
        wall.now_s += 0.04
        count += 4
        found = rate.note(count)
    assert found == pytest.approx(100.0)
    for _ in range(60):
        wall.now_s += 0.04
        found = rate.note(count)
    assert found == 0.0
