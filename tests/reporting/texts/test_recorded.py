"""No sentence that a run records is left without a place in the catalogue of texts."""

import ast
import re
from pathlib import Path

import pytest
from fake_rails import rail_run
from small_studies import load, make_scenario, run_in_memory, station

import tractionpower
from tractionpower.cosimulation import events
from tractionpower.io.finder import data_folder
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.quantity import Quantity
from tractionpower.reporting.texts import recorded
from tractionpower.reporting.texts.recorded import EVENTS, FIGURES, NOTES, PLACES, SENTENCES, TOGETHER, VERDICTS
from tractionpower.reporting.texts.sources import static_texts

SOURCE = Path(tractionpower.__file__).parent
PLACE = re.compile(r"\{\w+\}")
STATIC = {*static_texts()}
WHOLE = STATIC | {sentence for sentence in SENTENCES if not PLACE.search(sentence)}


def _pattern(sentence):
    return re.compile(".+?".join(map(re.escape, PLACE.split(sentence))), re.DOTALL)


PATTERNS = [_pattern(sentence) for sentence in SENTENCES if PLACE.search(sentence) and sentence not in TOGETHER]


def is_known(text):
    """Tell whether the catalogue has a text: as it is, or by a pattern that says more than how parts stand together."""
    return text in WHOLE or any(pattern.fullmatch(text) for pattern in PATTERNS)


def words(name):
    return Quantity(name, "").words


# -- what the code can record ----------------------------------------------------------------------------------------


def _texts(node):
    """Yield a literal, or an f-string with its places as ``{}``; of a condition both."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
    elif isinstance(node, ast.IfExp):
        yield from (*_texts(node.body), *_texts(node.orelse))


def _is_covered(text):
    """Tell whether the catalogue has a text of the code: with a number in its places, or as what these can become."""
    if is_known(text.replace("{}", "7")):
        return True
    shape = re.compile(".*?".join(map(re.escape, text.split("{}"))))
    return "{}" in text and any(shape.fullmatch(sentence) for sentence in (*WHOLE, *SENTENCES))


def _calls():
    """Yield every call that makes a key figure, and the names that the function around it gives texts to."""
    for room in ("results", "cosimulation", "studies"):
        for file in sorted((SOURCE / room).rglob("*.py")):
            for function in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if not isinstance(function, ast.FunctionDef):
                    continue
                given = {}
                for node in ast.walk(function):
                    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                        given.setdefault(node.targets[0].id, []).extend(_texts(node.value))
                for node in ast.walk(function):
                    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "KeyFigure":
                        yield f"{file.name}:{node.lineno}", node, given


def _argument(call, number, keyword):
    if number < len(call.args):
        return call.args[number]
    return next((each.value for each in call.keywords if each.arg == keyword), None)


def test_every_key_figure_in_the_code_has_its_name_and_definition_in_the_catalogue():
    seen, missing = 0, []
    for where, call, given in _calls():
        for number, keyword in ((0, "name"), (4, "definition")):
            node = _argument(call, number, keyword)
            texts = given.get(node.id, []) if isinstance(node, ast.Name) else list(_texts(node))
            seen += len(texts)
            told = (words(text) if keyword == "name" else text for text in texts)
            missing += [(where, text) for text in told if text and not _is_covered(text)]
    assert not missing
    assert seen > 80  # the search finds what there is


def test_every_kind_of_event_has_its_message_in_the_catalogue():
    at = {"time_s": 3600.0, "end_s": 3700.0, "track": "1", "position_km": 12.3, "subject": "A", "station": "B"}
    numbers = {
        "value": 1234.5,
        "limit": 1000.0,
        "to_km": 13.0,
        "again_s": None,
        "number": 0,
        "reasons": ["voltage", "line_current"],
    }
    row = at | numbers | {"change": ("state", "open"), "cause": "order", "place": "", "unit": "V", "limit_name": "u_min2",
                          "voltage_v": None}  # fmt: skip
    more = {
        "current_limited": [{"reasons": ["standstill_current"]}],
        "limit_violated": [{"place": "km 3"}, {"voltage_v": 120.0}, {"voltage_v": 120.0, "place": "km 3"}],
        "switched": [{"cause": "reclosure"}, {"cause": "reopening"}, {"cause": "no_return"}, {"change": ("units_in_service", 2)},
                     {"change": ("state", "rectifiers_out")}],
        "tripped": [{"again_s": 10.0}, {"again_s": 10.0, "number": 1}],
    }  # fmt: skip
    told = [events.message(row | {"kind": kind} | each) for kind in events.KINDS_TOLD for each in ({}, *more.get(kind, ()))]
    assert len({text.split()[0] for text in told}) > 10
    assert [text for text in told if not is_known(text)] == []
    patterns = [_pattern(sentence) for sentence in EVENTS]
    unused = [pattern.pattern for pattern in patterns if not any(pattern.fullmatch(text) for text in told)]
    assert unused == []  # a sentence that nobody says any more


# -- what runs record ------------------------------------------------------------------------------------------------


def _case(name):
    return load_scenario(data_folder("validation") / name).scenario


def _network():
    feeds_back = load("back", 6.0, power_kw=-9000.0)
    return make_scenario(load("depot"), feeds_back, substations=[station("A", 0.0, trip_current_a=400.0, reclose_after_s=2.0),
                                                                 station("B", 20.0)])  # fmt: skip


@pytest.fixture(scope="module", params=["network", "coupled-train", "leaky-rails", "motion-low-voltage-limit"])
def run(request):
    scenario = _network() if request.param == "network" else _case(request.param)
    results, *_ = run_in_memory(scenario)
    return results


def test_figures_of_a_run_are_known(run):
    assert run.key_figures
    assert {figure["definition"] for figure in run.key_figures if not is_known(figure["definition"])} == set()
    assert {figure["name"] for figure in run.key_figures if not is_known(words(figure["name"]))} == set()


def test_places_of_figures_are_known(run):
    patterns = [_pattern(sentence) for sentence in PLACES]
    places = {figure["place"] for figure in run.key_figures if figure["place"]}
    assert {place for place in places if not any(pattern.fullmatch(place) for pattern in patterns)} == set()


def test_verdicts_notes_and_events_of_a_run_are_known(run):
    assert {verdict["name"] for verdict in run.run["verdicts"] if not is_known(verdict["name"])} == set()
    assert {note for note in run.run["notes"] if not is_known(note)} == set()
    if "events" in run.tables:
        messages = {*run.table("events")["message"].astype(str)}
        assert {message for message in messages if not is_known(message)} == set()


def test_rails_are_known():
    figures = rail_run().results.key_figures
    assert {figure["name"] for figure in figures if not is_known(words(figure["name"]))} == set()


def test_columns_limits_and_words_of_inputs_come_from_their_declarations():
    assert {"position", "Mean tractive effort at the wheel.", "lowest non-permanent voltage", "no load voltage"} <= STATIC
    assert {"in service", "rectifiers out", "single track", "contact line", "current limited", "standstill current"} <= STATIC
    assert not [text for text in STATIC if "{" in text]  # they have no places


def test_no_sentence_stands_twice_within_a_list():
    for sentences in (FIGURES, VERDICTS, PLACES, EVENTS, NOTES):
        assert len(set(sentences)) == len(sentences)


def test_english_is_as_it_was_recorded():
    assert recorded("train 7, track 1, km 3.20") == "train 7, track 1, km 3.20"
