import pytest

from tractionpower.studies.remedies.ladder import most_trials, smallest


class Change:
    """A change that holds from one size to another, is enough from the first on, and remembers what it was asked."""

    def __init__(self, least, most_good=10**9):
        self.least, self.most_good = least, most_good
        self.asked = []

    def _note(self, steps):
        if steps not in self.asked:
            self.asked.append(steps)

    def holds(self, steps):
        self._note(steps)
        return self.least <= steps <= self.most_good

    def enough(self, steps):
        self._note(steps)
        return steps >= self.least


@pytest.mark.parametrize("most", [1, 2, 3, 7, 8, 36, 60])
def test_it_finds_the_smallest_whatever_harm_more_does_within_the_trials_that_it_says(most):
    counts = []
    for least in range(1, most + 2):
        for most_good in {least, least + 1, least + 5, 10**9}:
            change = Change(least, most_good)
            assert smallest(most, change.holds, change.enough) == (least if least <= most else None)
            assert all(1 <= steps <= most for steps in change.asked)
            counts.append(len(change.asked))
    assert max(counts) <= most_trials(most)
    assert max(counts) >= most_trials(most) - 1


def test_none_where_the_greatest_is_not_enough():
    change = Change(37)
    assert smallest(36, change.holds, change.enough) is None
    assert change.asked == [1, 2, 4, 8, 16, 32, 36]


def test_none_where_enough_does_harm():
    change = Change(5, most_good=4)
    assert smallest(36, change.holds, change.enough) is None
    assert {4, 5} <= set(change.asked)


def test_one_step_less_does_not_hold_where_small_sizes_hold_by_accident():
    change = Change(3)
    change.holds = lambda steps: steps == 2 or steps >= 20
    found = smallest(36, change.holds, change.enough)
    assert change.holds(found)
    assert not change.holds(found - 1)
