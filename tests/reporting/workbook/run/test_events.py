import pyarrow as pa
from fake_results import make_case
from read_workbook import read_table, texts

from tractionpower.reporting.workbook.run.events import MOST
from tractionpower.results.results import Results


def test_events_are_those_of_the_table(small, case):
    frame = case[0].table("events")
    rows = read_table(small["Events"], 2)
    assert [row["in words"] for row in rows] == frame["message"].tolist()
    assert rows[0]["time of day"] == 6 * 3600
    assert rows[0]["place [km]"] == 12.345


def test_too_many_events_lose_routine_ones_first(write):
    results, scenario = make_case()
    events = results._source["events"]
    many = pa.concat_tables([events] * 500)  # 2000 low voltages among 6000
    book = write(Results(results.run, results.key_figures, {"events": many}), scenario)
    kinds = [row["event"] for row in read_table(book["Events"], 2)]
    assert kinds == ["low voltage"] * MOST
    assert any("2000 of 6000 events" in text for text in texts(book["Events"]))
    counts = {row["event"]: (row["how many"], row["of them in the list"]) for row in read_table(book["Events"])}
    assert counts == {"low voltage": (2000, 2000), "train entered": (2000, 0), "train left": (2000, 0)}
