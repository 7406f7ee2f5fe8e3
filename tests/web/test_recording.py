"""What was driven, as a case that can be run again."""

import pytest
from fake_dynamics import fake_scenario

from tractionpower.io.dynamics_files import load_case
from tractionpower.model.dynamics.case import Command
from tractionpower.web.recording import COMMANDS_FILE, Driven, as_driven, commands_text, write_case


def test_what_is_set_at_one_time_is_one_row_and_the_later_word_holds():
    driven = Driven()
    driven.note(0.0, {"drive": 3})
    driven.note(0.0, {"brake": 2})
    driven.note(1.5, {"drive": 4})
    driven.note(1.5, {"drive": 5})
    driven.note(2.0, {"brake": "emergency"})
    assert driven.commands() == (
        Command(time_s=0.0, drive=3, brake=2),
        Command(time_s=1.5, drive=5),
        Command(time_s=2.0, brake="emergency"),
    )


def test_what_the_case_sets_at_the_start_holds_until_the_driver_sets_it():
    driven = Driven([Command(time_s=0.0, drive=2, reduction_bar=0.8)])
    assert driven.commands() == (Command(time_s=0.0, drive=2, reduction_bar=0.8),)
    driven.note(0.0, {"brake": 4})
    assert driven.commands() == (Command(time_s=0.0, drive=2, brake=4),)


def test_columns_that_say_nothing_are_left_out():
    rows = (Command(time_s=0.0, drive=3), Command(time_s=1.25, brake="emergency"))
    assert commands_text(rows).split() == ["time_s,drive,brake", "0.0,3,", "1.25,,emergency"]


def test_a_driven_case_reads_back_as_it_was(tmp_path):
    driven = Driven()
    driven.note(0.1 + 0.2, {"drive": 7})  # not 0.3: a time must come back to its last digit
    driven.note(2.0, {"brake": "full_service", "independent_bar": 1.5})
    driven.note(4.0, {"electric": 3.0, "brake": 0})
    scenario = as_driven(fake_scenario(), driven.commands(), 12.34)
    file = write_case(scenario, tmp_path / "driven")
    assert load_case(file).scenario == scenario
    assert load_case(file.parent).scenario == scenario
    assert scenario.case.commands[0].time_s == 0.1 + 0.2
    assert scenario.case.run.duration_s == 12.34


def test_a_drive_without_a_command_reads_back_too(tmp_path):
    scenario = as_driven(fake_scenario(), (), 5.0)
    file = write_case(scenario, tmp_path)
    assert load_case(file).scenario == scenario
    assert not (tmp_path / COMMANDS_FILE).exists()


def test_standstill_does_not_end_a_driven_case():
    scenario = as_driven(fake_scenario(), (), 5.0)
    assert scenario.case.run.ends == "duration"
    assert scenario.case.run.rows_limit is None


@pytest.mark.parametrize("again", [False, True])
def test_the_case_is_written_over_while_it_is_driven(tmp_path, again):
    write_case(as_driven(fake_scenario(), (), 1.0), tmp_path)
    later = as_driven(fake_scenario(), (Command(time_s=0.5, drive=1),), 2.0)
    write_case(later, tmp_path, with_stock=again)
    assert load_case(tmp_path).scenario == later
