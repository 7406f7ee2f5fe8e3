"""The sheets of load duration, demand and sharing, read back."""

import pytest
from read_workbook import read_table


def test_load_duration_and_demand_have_charts(book, study):
    assert len(book["Current duration"]._charts) == 4  # rails without a rating have no currents here
    assert len(book["Demand"]._charts) == 1
    rows = {row["supply point"]: row for row in read_table(book["Demand"])}
    demand = study[0].table("demand")
    for name, own in demand.groupby("supply_point", observed=True):
        assert rows[name]["highest demand [kW]"] == pytest.approx(own["power_kw"].max())
        assert rows[name]["quarter begins"] == pytest.approx(own.loc[own["power_kw"].idxmax(), "from_s"])
        assert rows[name]["mean [kW]"] == pytest.approx(own["power_kw"].mean())
        contract = own["contract_power_kw"].max()
        beyond, verdict = rows[name]["quarters beyond it"], rows[name]["holds"]
        if contract > 0.0:
            assert (beyond, verdict) == ((own["met"] == "no").sum(), "no" if (own["met"] == "no").any() else "yes")
        else:
            assert (beyond, verdict) == (None, "no contract")


def test_every_contract_is_judged_against_its_own_cell(book, formulas, study):
    contracts = study[0].table("demand").groupby("supply_point", observed=True)["contract_power_kw"].max().dropna()
    rows = [row for row in read_table(book["Acceptance"]) if row["what is judged"] == "highest demand of a quarter of an hour"]
    assert {row["place of the worst"] for row in rows} == {f"supply point {name}" for name in contracts.index}
    limits = [row["limit value"] for row in read_table(formulas["Acceptance"]) if str(row["limit"]) == "contract_power_kw"]
    assert len(set(limits)) == len(contracts) + 1
    assert sum(limit.startswith("=contract_") for limit in limits) == len(contracts)


def test_points_without_a_contract_are_told_and_count_as_no_limit(book):
    rows = read_table(book["Acceptance"])
    (bare,) = [row for row in rows if row["verdict"] == "no contract"]
    assert (bare["found"], bare["margin"], bare["place of the worst"]) == (None, None, "see sheet Demand")
    ((sheet, cell),) = book.defined_names["acceptance_all"].destinations
    assert book[sheet][cell.replace("$", "")].value == len(rows) - 1


def test_shares_of_a_zone_add_up(book):
    shares = {}
    for row in read_table(book["Sharing"]):
        shares.setdefault(row["zone"], []).append(row["share [%]"])
    assert all(sum(own) == pytest.approx(100.0) for own in shares.values())
