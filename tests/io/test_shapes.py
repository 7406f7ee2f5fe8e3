from tractionpower.io.shapes import shape_of
from tractionpower.model.timetable import Call
from tractionpower.model.vehicle import Vehicle


def test_a_union_knows_its_tag_until_the_data_say_which_branch():
    drive = shape_of(Vehicle).find(("drive",))
    assert (drive.kind, drive.keys, drive.tags) == ("mapping", ("kind",), ("inverter", "series_motors", "table"))
    assert drive.child("kind").allowed() == "inverter | series_motors | table"
    assert drive.child("power_kw") is None
    for data in ({}, {"kind": "other"}, {"kind": ["table"]}, [], None):
        assert drive.branch(data) is drive
    assert drive.branch({"kind": "table"}).child("effort").kind == "rows"
    assert drive.branch({"kind": "table"}).find(("effort", 0, "effort_kn")).unit == "kN"


def test_tags_are_no_keys_of_a_file():
    shape = shape_of(Vehicle)
    assert shape.untagged(("drive", "table", "effort", 0, "effort_kn")) == ("drive", "effort", 0, "effort_kn")
    assert shape.untagged(("drive", "table", "table")) == ("drive", "table")  # an unknown key of that name
    assert shape.untagged(("kind",)) == ("kind",)
    assert shape.untagged(("nonsense", "table", 3)) == ("nonsense", "table", 3)


def test_true_or_false():
    assert shape_of(Call).find(("stops",)).allowed() == "true or false"
