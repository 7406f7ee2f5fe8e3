import json

import pytest

from tractionpower.errors import UsageError
from tractionpower.io.schemas import schema, schema_names


@pytest.mark.parametrize("name", schema_names())
def test_schemas_are_json_and_refuse_unknown_keys(name):
    made = json.loads(json.dumps(schema(name)))
    assert made["$schema"].startswith("https://json-schema.org/")
    assert made["additionalProperties"] is False


def test_keys_are_those_of_the_files_and_carry_units():
    load = schema("supply")["$defs"]["Load"]["properties"]
    assert "from" in load
    assert load["power_kw"]["unit"] == "kW"


def test_a_list_of_rows_may_be_a_csv_file():
    kinds = [node.get("type") for node in schema("line")["properties"]["gradients"]["anyOf"]]
    assert kinds == ["array", "string"]


def test_lists_within_rows_may_be_csv_files_as_well():
    kinds = [node.get("type") for node in schema("timetable")["$defs"]["TrainRun"]["properties"]["calls"]["anyOf"]]
    assert kinds == ["array", "string"]
    kinds = [node.get("type") for node in schema("vehicle")["$defs"]["TableDrive"]["properties"]["effort"]["anyOf"]]
    assert kinds == ["array", "string"]


def test_the_kinds_of_drive_are_told_apart():
    union = schema("vehicle")["properties"]["drive"]["anyOf"][0]
    assert union["discriminator"]["propertyName"] == "kind"
    assert len(union["oneOf"]) == 3


def test_an_unknown_schema_names_the_nearest():
    with pytest.raises(UsageError, match="did you mean supply"):
        schema("suply")
