from read_workbook import read_table, texts

from tractionpower.results.columns import TABLES


def test_every_column_is_defined(small):
    rows = {(row["where"], row["name in files"]): row for row in read_table(small["Definitions"])}
    for table, columns in TABLES.items():
        for column in columns:
            row = rows[f"table {table}", column.name]
            assert (row["meaning"], row["unit"]) == (column.quantity.meaning, column.quantity.unit or None)


def test_a_key_figure_is_defined_once(small, case):
    names = [row["name in files"] for row in read_table(small["Definitions"]) if row["where"] == "key figures"]
    assert len(names) == len(set(names))
    assert set(names) == {figure["name"] for figure in case[0].key_figures}


def test_the_model_tells_evidence_and_what_it_leaves_out(small):
    rows = {row["what"]: row["value"] for row in read_table(small["Model"], 1)}
    assert rows["largest current that does not balance at a node [A]"] == 3.2e-7
    assert rows["mean number of iterations in a step"] == 2.7
    words = " ".join(texts(small["Model"]))
    for subject in ("Harmonics", "transients", "input filters", "trains do not see each other", "stray currents", "Temperatures"):
        assert subject in words
