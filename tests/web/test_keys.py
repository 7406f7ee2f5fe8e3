"""The key map of Zobory and Bekefi, figure 13: 32 keys, no overlap."""

import json
from collections import Counter

from tractionpower.web.keys import ACTION_KEYS, LEVEL_KEYS, STEP_KEYS, key_map
from tractionpower.web.orders import read_order
from tractionpower.web.server import page_file

FIGURE_13 = {
    "brake": {1: "1", 2: "2", 3: "3", 4: "4", 5: "5", 6: "6", 7: "7", 8: "8", 9: "9", 0: "0"}
    | dict(zip(range(10, 16), "QWERTY", strict=True)),
    "drive": dict(zip(range(1, 10), "ASDFGHJKL", strict=True)) | dict(zip([*range(10, 16), 0], "ZXCVBNM", strict=True)),
}


def test_every_level_has_the_key_of_the_figure():
    found = {"brake": {}, "drive": {}}
    for code, (control, level) in LEVEL_KEYS.items():
        found[control][level] = code.removeprefix("Digit").removeprefix("Key")
    assert found == FIGURE_13


def test_32_keys_of_levels_and_no_key_does_two_things():
    assert len(LEVEL_KEYS) == 32
    assert max(Counter([*LEVEL_KEYS, *STEP_KEYS, *ACTION_KEYS]).values()) == 1
    assert len(key_map()["keys"]) == len(LEVEL_KEYS) + len(STEP_KEYS) + len(ACTION_KEYS)


def test_the_rows_are_those_of_the_keyboard():
    codes = [code for row in key_map()["rows"] for code in row["codes"]]
    assert sorted(codes) == sorted(LEVEL_KEYS)


def test_what_a_key_sends_is_an_order():
    for code, sent in key_map()["keys"].items():
        assert read_order(json.dumps(sent)) is not None, code


def test_the_page_has_no_map_of_its_own():
    assert b"KeyQ" not in page_file("keys.js") + page_file("drive.js")
