"""What is saved and loaded again is the same scenario with the same hash."""

import tempfile

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.scenario_files import load_scenario, save_scenario
from tractionpower.model.limits import Limit, overlay
from tractionpower.model.line import Connection, Curve, Gradient, Line, SpeedLimit, Station, Track, TrackPoint
from tractionpower.model.scenario import Clock, Output, Scenario
from tractionpower.model.supply import ContactLine, Load, ReturnCircuit, SectionCabin, SectionPoint, Substation, Supply


def reals(low: float = -1e6, high: float = 1e6, **options) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False, **options)


def positive(high: float) -> st.SearchStrategy[float]:
    return reals(0.0, high, exclude_min=True)


def listed(strategy: st.SearchStrategy) -> st.SearchStrategy[tuple]:
    return st.lists(strategy, max_size=3).map(tuple)


def stretch(kind: type, **parts: st.SearchStrategy) -> st.SearchStrategy:
    ends = st.tuples(reals(), reals()).filter(lambda pair: pair[0] != pair[1]).map(sorted)
    return st.builds(lambda pair, **values: kind(from_km=pair[0], to_km=pair[1], **values), ends, **parts)


TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
# The cells of a CSV file lose the blanks at their ends, by contract.
CELLS = TEXTS.map(str.strip)
NAMES = st.text(st.characters(exclude_categories=["Cs", "Cc", "Z"], exclude_characters="[]"), min_size=1, max_size=8)
TRACKS = st.none() | st.lists(NAMES, max_size=3).map(tuple)
TIMES = reals(0.0, 3e6)

LINES = st.builds(
    Line,
    name=TEXTS,
    source=TEXTS,
    tracks=st.lists(stretch(Track, id=NAMES), min_size=1, max_size=3).map(tuple),
    stations=listed(
        st.builds(
            Station,
            id=NAMES,
            name=TEXTS,
            km=reals(),
            tracks=TRACKS,
            stop_km=st.none() | st.dictionaries(TEXTS, reals(), max_size=2),
        )
    ),
    gradients=listed(stretch(Gradient, permille=reals(-100, 100), tracks=TRACKS)),
    curves=listed(stretch(Curve, radius_m=reals(56, 1e5), tracks=TRACKS)),
    speed_limits=listed(
        stretch(
            SpeedLimit,
            kmh=positive(600),
            tracks=TRACKS,
            direction=st.sampled_from([None, "increasing", "decreasing"]),
            category=st.none() | TEXTS,
        )
    ),
    connections=listed(
        st.builds(
            lambda a, b: Connection(from_=a, to=b),
            st.builds(TrackPoint, track=NAMES, km=reals()),
            st.builds(TrackPoint, track=NAMES, km=reals()),
        )
    ),
)

SUBSTATIONS = st.builds(
    Substation,
    id=NAMES,
    km=reals(),
    no_load_voltage_v=positive(10_000),
    internal_resistance_ohm=positive(10),
    conducts=st.sampled_from(["forward", "both"]),
    state=st.sampled_from(["in_service", "rectifiers_out", "bypassed", "open"]),
    feeder_resistance_ohm=reals(0, 10),
    return_resistance_ohm=reals(0, 10),
    dissipative_resistance_ohm=st.none() | reals(0, 10),
    grid_voltage_pu=reals(0.5, 1.5),
    tracks=TRACKS,
)


@st.composite
def loads(draw: st.DrawFn) -> Load:
    quantity = draw(st.sampled_from(["power_kw", "current_a"]))
    times = draw(st.none() | st.tuples(TIMES, TIMES).filter(lambda pair: abs(pair[0] - pair[1]) > 1e-3).map(sorted))
    return Load(
        id=draw(NAMES),
        track=draw(NAMES),
        km=draw(reals()),
        limits=draw(st.sampled_from(["range", "none"])),
        fold_back_from_v=draw(st.none() | positive(5000)),
        from_=times[0] if times else None,
        to=times[1] if times else None,
        **{quantity: draw(reals())},
    )


SUPPLIES = st.builds(
    Supply,
    system=NAMES,
    substations=listed(SUBSTATIONS),
    section_cabins=listed(
        st.builds(SectionCabin, id=NAMES, km=reals(), state=st.sampled_from(["closed", "bypassed", "open"]), tracks=TRACKS)
    ),
    section_points=listed(st.builds(SectionPoint, id=NAMES, track=NAMES, km=reals(), state=st.sampled_from(["open", "closed"]))),
    contact_lines=st.lists(stretch(ContactLine, resistance_ohm_per_km=positive(10), tracks=TRACKS), min_size=1, max_size=3).map(
        tuple
    ),
    return_circuit=st.lists(
        stretch(ReturnCircuit, resistance_ohm_per_km=reals(0, 10), tracks=TRACKS), min_size=1, max_size=3
    ).map(tuple),
    loads=listed(loads()),
)

LIMITS = listed(
    st.builds(
        Limit,
        system=st.just("dc3000") | NAMES,
        name=st.sampled_from(["u_max2", "u_n", "mine"]),
        value=reals(),
        unit=CELLS,
        meaning=CELLS,
        source=CELLS,
        status=st.sampled_from(["verified", "secondary", "recalled", "user"]),
    )
).map(lambda rows: overlay(shipped_limits(), rows))

CLOCKS = st.builds(
    lambda pair, step, warm: Clock(start=pair[0], end=pair[1], step_s=step, warm_up=(pair[1] - pair[0]) / 2 if warm else None),
    st.tuples(TIMES, TIMES).filter(lambda pair: abs(pair[0] - pair[1]) > 1e-3).map(sorted),
    reals(0.02, 5.0),
    st.booleans(),
)

SCENARIOS = st.builds(
    Scenario,
    name=TEXTS,
    line=LINES,
    supply=SUPPLIES,
    clock=CLOCKS,
    coupling=st.sampled_from(["full", "constant_voltage"]),
    coupling_voltage_v=st.none() | positive(5000),
    seed=st.integers(0, 2**40),
    limits=LIMITS,
    output=st.builds(Output, every_s=st.none() | positive(1e3), tables=st.none() | listed(TEXTS)),
)


@settings(
    derandomize=True, deadline=None, max_examples=100, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)
@given(SCENARIOS)
def test_load_of_save_is_the_same(scenario):
    with tempfile.TemporaryDirectory() as folder:
        save_scenario(scenario, folder)
        loaded = load_scenario(folder)
    assert loaded.scenario == scenario
    assert loaded.scenario.input_hash == scenario.input_hash
    assert loaded.problems == ()
