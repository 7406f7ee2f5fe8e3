"""Texts in the language of the report: every one has a translation, with the same places for values, plurals included."""

import importlib.util
import re
from pathlib import Path

import pytest
from babel.messages.pofile import read_po

from tractionpower.reporting import texts
from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.texts import current_language, language, number, recorded, tr, trn

ROOT = Path(__file__).parents[3]
PLACE = re.compile(r"\{(\w+)[^}]*\}")


@pytest.fixture(scope="module")
def make_texts():
    spec = importlib.util.spec_from_file_location("make_texts", ROOT / "docs" / "make_texts.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def polish():
    with (Path(texts.__file__).parent / "pl.po").open("rb") as file:
        return read_po(file, locale="pl")


def strings(message):
    return [message.string] if isinstance(message.string, str) else list(message.string)


def test_the_catalogue_has_the_texts_of_the_code_and_no_others(make_texts, polish):
    wanted = {text if isinstance(text, str) else text[0] for text in make_texts.texts()}
    known = {message.id if isinstance(message.id, str) else message.id[0] for message in polish if message.id}
    assert wanted - known == set(), "run `make docs` and translate"
    assert known - wanted == set(), "run `make docs`"


def test_every_text_is_translated(polish):
    assert [message.id for message in polish if message.id and not all(strings(message))] == []


def test_translations_have_the_places_of_their_texts(polish):
    for message in polish:
        if not message.id:
            continue
        many = message.id if isinstance(message.id, str) else message.id[1]
        for string in strings(message):
            assert sorted(PLACE.findall(string)) == sorted(PLACE.findall(many)), message.id


def test_the_program_reads_what_translators_wrote(make_texts, polish):
    assert (Path(texts.__file__).parent / "pl.mo").read_bytes() == make_texts.compiled(polish), "run `make docs`"


def test_plurals_are_those_of_the_language():
    with language("pl"):
        told = [trn("{count} train", "{count} trains", count) for count in (1, 2, 5, 22)]
    assert told == ["1 pociąg", "2 pociągi", "5 pociągów", "22 pociągi"]


def test_a_language_holds_inside_and_no_longer():
    with language("pl"):
        assert current_language() == "pl"
        assert tr("train") == "pociąg"
        assert number(1234.5) == "1234,5"
    assert tr("train") == "train"
    assert number(1234.5) == "1234.5"


def test_recorded_sentences_are_found_by_their_pattern():
    text = "highest sliding mean over 15 min, U I; time is the start of the window"
    assert recorded(text) == text
    with language("pl"):
        told = recorded(text)
        assert "15 min" in told
        assert told != text
        assert recorded("of no catalogue: {odd} braces") == "of no catalogue: {odd} braces"


def test_names_with_braces_do_no_harm():
    assert tr("{name} of the line", name="{0} {evil}") == "{0} {evil} of the line"
    with language("pl"):
        assert tr("") == ""


def test_numbers_of_recorded_sentences_take_the_decimal_sign():
    with language("pl"):
        assert recorded("track 1 km 1.1-10.8") == "tor 1 km 1,1–10,8"
        told = recorded("A and B (06:30:51, track 1, km 211.0, 127 steps); C and D (06:50:51, track 1, km 211.5, 3 steps)")
    assert told == "A i B (06:30:51, tor 1, km 211,0, liczba kroków: 127); C i D (06:50:51, tor 1, km 211,5, liczba kroków: 3)"


def test_words_of_the_user_stay_as_they_are():
    text = "own table (after Sochon 2003 and a script); nothing of it is 3 kV, name is old"
    with language("pl"):
        assert recorded(text) == text


def test_devices_are_named_in_the_language_of_the_report():
    assert device_told("Psary unit, whole run") == "Psary unit, whole run"
    with language("pl"):
        assert device_told("Psary unit, whole run") == "Psary, zespół, całe obliczenie"
        assert device_told("Psary 1 low_km") == "Psary 1, niższy km"
