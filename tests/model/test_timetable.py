"""Rules of the timetable that no bound of a single value can tell."""

import pytest
from pydantic import ValidationError

from tractionpower.model.timetable import Leg, TrainRun

LEG = {"track": "1", "from_km": 0.0, "to_km": 20.0}
RUN = {"id": "7", "route": [LEG], "start": {"time": "00:01"}}


@pytest.mark.parametrize(("more", "told"), [({}, "neither"), ({"train": "ic", "vehicles": [{"id": "unit"}]}, "both")])
def test_a_run_has_either_train_or_vehicles(more, told):
    with pytest.raises(ValidationError, match=f"either train or vehicles, found {told}"):
        TrainRun(**RUN, **more)


def test_a_leg_without_length_is_told_with_its_place():
    with pytest.raises(ValidationError, match=r"the same place: km 12\.25"):
        Leg(track="1", from_km=12.25, to_km=12.25)
