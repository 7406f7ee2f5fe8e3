from read_workbook import exactly, read_table


def test_all_key_figures_are_there_with_their_definitions(small, case):
    rows = read_table(small["Key figures"])
    assert len(rows) == len(case[0].key_figures)
    for row, figure in zip(rows, case[0].key_figures, strict=True):
        assert (row["name in key_figures.json"], row["unit"]) == (figure["name"], figure["unit"] or None)
        assert row["value"] == exactly(figure["value"])
        assert row["definition"] == figure["definition"]
        assert row["place"] == (figure["place"] or "whole run")


def test_a_time_is_a_time(small):
    assert read_table(small["Key figures"])[0]["time of day"] == 6 * 3600 + 20 * 60
