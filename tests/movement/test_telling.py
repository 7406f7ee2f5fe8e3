"""Names and paths in messages."""

from tractionpower.movement.telling import item_paths, listed, unknown


def test_many_names_are_cut():
    assert listed("abc") == "a, b, c"
    assert listed("abcdefghi") == "a, b, c, d, e, f, g, h, ... (9 in all)"


def test_items_that_share_an_id_are_told_by_their_index_unless_that_is_an_id():
    assert item_paths("trains", ["a", "b", "b"]) == ["trains[a]", "trains[1]", "trains[2]"]
    assert item_paths("trains", ["2", "b", "b"]) == ["trains[2]", "trains[1]", "trains[b]"]


def test_unknown_names():
    assert unknown("station", "p", "Aa", ["A", "B"], "name one").remedy == "did you mean A?"
    nothing = unknown("station", "p", "Aa", [], "name one")
    assert (nothing.code, nothing.allowed, nothing.remedy) == ("unknown_station", "there is no station", "name one")
