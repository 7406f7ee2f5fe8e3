import re

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tractionpower.io.file_names import file_names, identifier_of, looks_like, stands_for

IDENTIFIERS = st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="[]"), min_size=1, max_size=300)
# What Windows refuses: forbidden letters, devices, a dot or blank at the end; and what hides a file elsewhere.
REFUSED = re.compile(r'.*[<>:"/\\|?*\x00-\x1f].*|(?i:con|prn|aux|nul|com\d|lpt\d)(\..*)?|.*[. ]|\..*')


@pytest.mark.parametrize("plain", ["ep09", "EN57", "ep09-10-coaches", "vectron dc (1)", "re_4/4".replace("/", "."), "50"])
def test_usual_names_stay_as_they_are(plain):
    assert file_names([plain]) == {plain: f"{plain}.yaml"}


@pytest.mark.parametrize(
    ("identifier", "name"),
    [
        ("a/b", "a%2Fb"),
        ("..", "%2E."),
        ("Con", "%43on"),
        ("nul.x", "%6Eul.x"),
        ("50%", "50%25"),
        ("ó", "%C3%B3"),
        ("a:b", "a%3Ab"),
    ],
)
def test_other_names_are_written_in_bytes(identifier, name):
    assert file_names([identifier])[identifier] == f"{name}.yaml"
    assert identifier_of(f"{name}.yaml") == identifier


def test_names_that_differ_by_case_do_not_meet_on_any_system():
    names = file_names(["EP09", "ep09", "Ep09", "coach"])
    assert len({name.lower() for name in names.values()}) == 4
    assert (names["coach"], names["ep09"]) == ("coach.yaml", "ep09.yaml")


@settings(derandomize=True, deadline=None)
@given(st.lists(IDENTIFIERS | st.text("aAbB.%/4", min_size=1, max_size=3), unique=True, max_size=6))
@example(["CON", "con", "CoN", "coN", "%43ON"])
@example(["A" * 300, "a" * 300, "Ł" * 300])
def test_names_are_lawful_different_and_found_again(identifiers):
    names = file_names(identifiers)
    assert len({name.lower() for name in names.values()}) == len(identifiers)
    for name in names.values():
        assert name.isascii()
        assert len(name) <= 105
        assert not REFUSED.fullmatch(name)
    for identifier in identifiers:
        assert [name for name in names.values() if stands_for(name, identifier)] == [names[identifier]]


def test_accents_stored_in_another_way_look_alike():
    assert looks_like("krako\u0301w.yaml", "krak\u00f3w")
    assert not stands_for("krako\u0301w.yaml", "krak\u00f3w")
    assert not looks_like("krakow.yaml", "krak\u00f3w")
