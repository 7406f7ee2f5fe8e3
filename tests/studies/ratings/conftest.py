"""Runs that a study of ratings watches."""

import pytest

from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.studies.ratings.watch import RatingsWatch


class Rated:
    """A run and the rows of all its tables."""

    def __init__(self, scenario, trips=None):
        self.run = QuietRun(scenario)
        self.watch = RatingsWatch(scenario, self.run.compiled)
        self.seen = []
        self.run.watches += [*self.watch.watches, self._keep]
        self.run.execute()
        self.tables = {name: list(rows) for name, rows in self.watch.tables(trips or {})}

    def _keep(self, time_s, rows, supply):
        self.seen.append((time_s.copy(), type(rows)(*(array.copy() for array in rows)), supply))


@pytest.fixture
def rated():
    return Rated
