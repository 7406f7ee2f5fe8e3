"""Rail potentials of a case: those of fixed places, and of trains at the nearest of them."""

import numpy as np
import pytest
from coupled import couple, run

from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.studies.cases.measure import measure

WHOLE = {"from_km": 0.0, "to_km": 20.0}
RAILS = [WHOLE | {"resistance_ohm_per_km": 0.02, "leakage_s_per_km": 0.1, "tracks": [track]} for track in "12"]


@pytest.fixture(scope="module")
def scenario():
    return couple(run("x"), run("y", track="2", low=20.0, high=0.0, time=100.0), return_circuit=RAILS, end_s=700.0)


def test_a_row_has_the_extremes_of_its_place_and_of_the_trains_next_to_it(scenario):
    quiet, fixed, trains = QuietRun(scenario), [], []
    quiet.watches.append(lambda t, rows, supply: (fixed.append(rows.rail_v.copy()), trains.append(rows.trains.copy())))
    quiet.execute()
    volts, rows = np.concatenate(fixed), np.concatenate(trains)
    places = [(place.tracks, place.km) for place in quiet.compiled.supply.rail_places]
    table = measure(scenario).tables["case_rails"].to_pandas()
    assert sorted(zip(table["track"], table["km"], strict=True)) == sorted(set(places))
    names = np.array([planned.run.route[0].track for planned in quiet.movement.runs])[rows["train"]]
    kms = np.where(names == "1", rows["s_m"] / 1000.0, 20.0 - rows["s_m"] / 1000.0)
    bins = (np.floor(kms / 0.5) + 0.5) * 0.5  # trains count by bins of half a kilometre
    for track, km, low, high in table[["track", "km", "lowest_potential_v", "highest_potential_v"]].itertuples(index=False):
        here = volts[:, [k for k, place in enumerate(places) if place == (track, km)]]
        own = np.array([place[1] for place in places if place[0] == track])
        near = own[np.abs(own[:, None] - bins[None, :]).argmin(axis=0)]
        under = rows["rail_v"][(names == track) & (near == km)]
        every = np.concatenate([here.ravel(), under])
        assert low == pytest.approx(every.min(), rel=1e-6)
        assert high == pytest.approx(every.max(), rel=1e-6)
