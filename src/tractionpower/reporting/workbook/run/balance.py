"""The balance of energies: from the substations to the trains, by substation, and by category of trains."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.run.feeders import heat_of
from tractionpower.reporting.workbook.run.substations import ordered
from tractionpower.reporting.workbook.run.sums import add_sums, total
from tractionpower.reporting.workbook.run.trains import ENERGIES, category_of, mass_t, place_of

_BALANCE = (
    Column("what", widest=64),
    Column("energy [kWh]", "0.0", key="energy"),
    Column("of what the busbars give [%]", "0.00", key="share"),
    Column("how it is found", "beside", widest=28),
)
_PLANTS = (
    Column("substation", widest=60),
    Column("energy at the busbars [kWh]", "0.0", key="energy"),
    Column("regulation [kWh]", "0.0", key="regulation"),
    Column("share of regulation [%]", "0.00", key="share"),
    Column("of it heat in copper and diodes [kWh]", "0.0", key="heat"),
)
_CATEGORIES = (
    Column("category of trains", widest=60, key="category"),
    Column("trains", "0", key="trains"),
    Column("gross [t km]", "0", key="tkm"),
    Column("taken [kWh]", "0.0", key="taken"),
    Column("returned [kWh]", "0.0", key="returned"),
    Column("net [kWh]", "0.0", key="net"),
    Column("net of all [%]", "0.0", key="share"),
    Column("net, specific [Wh/(t km)]", "0.0", key="specific"),
    Column("auxiliaries and heating [kWh]", "0.0", key="auxiliary"),
    Column("braking energy refused by the line [kWh]", "0.0", key="refused"),
)

BUSBARS = "balance_busbars"
_USES = {
    "auxiliary": mark("of what trains take: auxiliaries and heating"),
    "drive": mark("of what trains take: losses of drives"),
    "starting": mark("of what trains take: heat in starting resistors"),
    "refused": mark("not in the sums: braking energy that the line did not take"),
}


def add(page: Page) -> None:
    """Write the balance onto a sheet, as far as the run has key figures."""
    facts = page.book.facts
    if facts.value("", "source_energy_kwh") is not None and facts.value("", "regulation_energy_kwh") is not None:
        _balance(page)
    if any(facts.value(f"substation {s.id}", "plant_regulation_kwh") is not None for s in ordered(facts)):
        _plants(page)
    if any(facts.value(place_of(train), "energy_taken_kwh") is not None for train in facts.trains):
        _categories(page)


def _sum_of(facts: Facts, figure: str) -> float:
    return total(facts.value(place_of(train), figure) for train in facts.trains)


class _Lines:
    """Lines of the balance: each has a name by which later lines compute with it."""

    def __init__(self, page: Page) -> None:
        self.page, self.rows = page, list[list[Any]]()
        self.names, self.values = dict[str, int](), dict[str, float]()

    def add(self, name: str, words: str, value: float, how: str, text: str = "", *, counts: bool = True) -> None:
        """Add a line; with a `text` its energy is a formula. One that does not count has no share."""
        self.names[name], self.values[name] = len(self.rows), value
        whole = self.values.get(BUSBARS, 0.0) if name != BUSBARS else value
        share = Formula(f"IF({{{BUSBARS}}}=0,0,100*{{energy}}/{{{BUSBARS}}})", 100.0 * value / whole if whole else 0.0)
        self.rows.append([tr(words), Formula(text, value) if text else value, share if counts else None, tr(how)])


def _balance(page: Page) -> None:
    facts = page.book.facts
    source, regulation = (facts.value("", f"{name}_energy_kwh") or 0.0 for name in ("source", "regulation"))
    losses, heat = facts.value("", "line_loss_kwh") or 0.0, heat_of(facts)
    loads = total(facts.value(f"load {load.id}", "load_energy_kwh") for load in facts.scenario.supply.loads)
    taken, returned = _sum_of(facts, ENERGIES["taken"]), _sum_of(facts, ENERGIES["returned"])
    lines, busbars = _Lines(page), source - regulation
    lines.values[BUSBARS] = busbars
    figures, other = mark("key figure"), mark("sum of sheet Train energy")
    lines.add("balance_source", mark("rectifiers, at their no-load voltage, sum E I"), source, figures, "{kf_source_energy_kwh}")
    text = "{kf_regulation_energy_kwh}"
    lines.add(
        "balance_regulation", mark("regulation, sum (E - U) I, mostly commutation drop and no loss"), regulation, figures, text
    )
    difference = mark("difference")
    lines.add(BUSBARS, mark("substations, at the busbars"), busbars, difference, "{balance_source}-{balance_regulation}")
    found = mark("sum of sheet Feeders")
    lines.add("balance_feeders", mark("heat in feeders that have a resistance"), heat, found, "{feeders_heat}" if heat else "")
    text = "{kf_line_loss_kwh}-{balance_feeders}"
    words = mark("heat in contact lines and return circuit")
    lines.add("balance_lines", words, losses - heat, mark("all losses less feeders"), text)
    if facts.trains:
        lines.add("balance_taken", mark("trains, taken from the line"), taken, other, "{trains_all_taken}")
        lines.add("balance_returned", mark("trains, returned into the line"), returned, other, "{trains_all_returned}")
    if facts.scenario.supply.loads:
        lines.add("balance_loads", mark("fixed loads"), loads, mark("sum of sheet Substations"), "{loads_energy}")
    text = "{balance_busbars}-{balance_feeders}-{balance_lines}"
    text += "-{balance_taken}+{balance_returned}" if facts.trains else ""
    text += "-{balance_loads}" if facts.scenario.supply.loads else ""
    gap = busbars - heat - (losses - heat) - taken + returned - loads
    lines.add("balance_gap", mark("does not add up"), round(gap, 6), difference, f"ROUND({text},6)")
    if facts.trains:
        for key, words in _USES.items():
            name = f"balance_{key}"
            lines.add(name, words, _sum_of(facts, ENERGIES[key]), other, f"{{trains_all_{key}}}", counts=key != "refused")
    _write(page, lines)


def _write(page: Page, lines: _Lines) -> None:
    page.next += 1
    page.section("Energy balance")
    block = page.table(_BALANCE, lines.rows)
    for name, number in lines.names.items():
        page.book.define(name, page, block.cell("energy", block.first + number))
    gap = page.sheet[block.cell("energy", block.first + lines.names["balance_gap"])]
    gap._style = page.styles["exponent"]
    gap.offset(0, 1)._style = page.styles["exponent"]


def _plants(page: Page) -> None:
    facts = page.book.facts
    page.section("Substations: energy and regulation")
    rows: list[list[Any]] = []
    for number, s in enumerate(ordered(facts), 1):
        place = f"substation {s.id}"
        energy, regulation = facts.value(place, "energy_kwh"), facts.value(place, "plant_regulation_kwh")
        if energy is None or regulation is None:
            rows.append([s.id, energy, regulation, None, None])
            continue
        given = energy + regulation
        share = Formula(
            "IF({energy}+{regulation}=0,0,100*{regulation}/({energy}+{regulation}))", 100.0 * regulation / given if given else 0.0
        )
        rows.append(
            [
                s.id,
                Formula(f"INDEX({{substation_energies}},{number})", energy),
                regulation,
                share,
                facts.value(place, "plant_heat_kwh"),
            ]
        )
    block = page.table(_PLANTS, rows)
    sums = {key: "0.0" for key in ("energy", "regulation", "heat")}
    energy, regulation = (total(row[k] for row in rows) for k in (1, 2))
    text = "IF({energy}+{regulation}=0,0,100*{regulation}/({energy}+{regulation}))"
    add_sums(
        page, block, sums, rows, share=Formula(text, 100.0 * regulation / (energy + regulation) if energy + regulation else 0.0)
    )


def _categories(page: Page) -> None:
    """Write the energies by category of trains: sums over the rows of sheet Train energy that have its name exactly."""
    facts = page.book.facts
    page.section("Trains by category")
    groups: dict[str, list[dict[str, Any]]] = {}
    for train in facts.trains:
        groups.setdefault(category_of(facts, str(train["train"])), []).append(train)

    def summed(key: str, value: float) -> Formula:
        return Formula(f"SUMPRODUCT(EXACT({{trains_category}},{{category}})*1,{{trains_{key}}})", value)

    all_net = _sum_of(facts, ENERGIES["taken"]) - _sum_of(facts, ENERGIES["returned"])
    rows = [_category(facts, name, trains, summed, all_net) for name, trains in sorted(groups.items())]
    block = page.table(_CATEGORIES, rows)
    keys = ("trains", "tkm", "taken", "returned", "net", "auxiliary", "refused")
    at = {key: total(row[block.column(key) - 1] for row in rows) for key in ("tkm", "net")}
    specific = Formula("IF({tkm}>0,1000*{net}/{tkm},0)", 1000.0 * at["net"] / at["tkm"] if at["tkm"] > 0.0 else 0.0)
    styles = {key: "0" if key in ("trains", "tkm") else "0.0" for key in keys}
    add_sums(page, block, styles | {"share": "0.0"}, rows, specific=specific)


def _category(
    facts: Facts, name: str, trains: list[dict[str, Any]], summed: Callable[[str, float], Formula], all_net: float
) -> list[Any]:
    known = {key: total(facts.value(place_of(train), figure) for train in trains) for key, figure in ENERGIES.items()}
    gross = total(
        (mass_t(facts, str(train["train"])) or 0.0) * (facts.value(place_of(train), "length_km") or 0.0) for train in trains
    )
    net = known["taken"] - known["returned"]
    share = Formula("IF({trains_all_net}=0,0,100*{net}/{trains_all_net})", 100.0 * net / all_net if all_net else 0.0)
    specific = Formula("IF({tkm}>0,1000*{net}/{tkm},0)", 1000.0 * net / gross if gross > 0.0 else 0.0)
    count = Formula("SUMPRODUCT(EXACT({trains_category},{category})*1)", len(trains))
    return [
        name, count, summed("tkm", gross), summed("taken", known["taken"]), summed("returned", known["returned"]),
        Formula("{taken}-{returned}", net), share, specific, summed("auxiliary", known["auxiliary"]),
        summed("refused", known["refused"]),
    ]  # fmt: skip
