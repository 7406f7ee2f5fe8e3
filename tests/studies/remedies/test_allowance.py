"""Work in pieces that is ended by its wall time or by Ctrl-C."""

import threading

import pytest

from tractionpower.studies.remedies.allowance import Allowance


def interrupt():
    raise KeyboardInterrupt


def fail():
    raise ValueError("told")


def test_it_is_over_after_its_time():
    assert Allowance(-1.0).over
    assert not Allowance(3600.0).over
    assert not Allowance(-1.0).stopped


@pytest.mark.parametrize("workers", [1, 3])
def test_what_comes_of_each_task_in_their_order(workers):
    assert Allowance().run_all([lambda k=k: k * k for k in range(5)], workers) == [0, 1, 4, 9, 16]


def test_what_was_done_before_ctrl_c_is_kept_and_nothing_new_begins():
    allowance, begun = Allowance(), []
    assert allowance.run_all([lambda: 1, interrupt], 1) == [1, None]
    assert (allowance.stopped, allowance.over) == (True, True)
    assert allowance.run_all([lambda: begun.append(1)] * 2, 1) == [None, None]
    assert begun == []


def test_what_is_under_way_is_waited_for():
    started, ended = threading.Event(), []

    def slow():
        started.set()
        ended.append(threading.Event().wait(0.2))
        return 7

    def then_interrupt():
        started.wait(5.0)
        raise KeyboardInterrupt

    assert Allowance().run_all([then_interrupt, slow], 2) == [None, 7]
    assert ended == [False]


def test_a_defect_is_not_hidden():
    with pytest.raises(ValueError, match="told"):
        Allowance().run_all([fail], 2)
