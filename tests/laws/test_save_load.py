"""What is saved and loaded again is the same scenario with the same hash."""

import tempfile
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.limits_files import shipped_limits
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.io.scenario_files import load_scenario, save_scenario
from tractionpower.model.conductors import Conductor, overlay_conductors
from tractionpower.model.contingency import OUTAGE_KINDS, Contingency
from tractionpower.model.drive import (
    CurrentPoint,
    EfficiencyPoint,
    EffortPoint,
    Grouping,
    InverterDrive,
    MagnetisationPoint,
    PowerOverVoltage,
    Relay,
    SeriesMotorDrive,
    StartingResistors,
    TableDrive,
)
from tractionpower.model.limits import Limit, overlay
from tractionpower.model.line import Connection, Curve, Gradient, Line, SpeedLimit, Station, Track, TrackPoint
from tractionpower.model.loads import Load, LoadPoint
from tractionpower.model.ratings import DutyRow, RectifierUnit, duty_of, overlay_duty, overlay_units
from tractionpower.model.scenario import Clock, Output, Scenario
from tractionpower.model.sizing import Sizing, SizingSearch, UsefulVoltageStudy, Window, Zone
from tractionpower.model.supply import (
    ContactLine,
    ReturnCircuit,
    SectionCabin,
    SectionPoint,
    Substation,
    Supply,
    Wire,
)
from tractionpower.model.switchgear import Feeder
from tractionpower.model.timetable import Call, Join, Leg, Rotation, Service, Split, Start, Timetable, TrainRun
from tractionpower.model.vehicle import Adhesion, Auxiliaries, Brake, Part, Resistance, Train, Vehicle
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter


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

RATED = st.none() | positive(1e4)

SUBSTATIONS = st.builds(
    lambda by_unit, ohm, **more: Substation(**{"unit_resistance_ohm" if by_unit else "internal_resistance_ohm": ohm}, **more),
    st.booleans(),
    positive(10),
    id=NAMES,
    km=reals(),
    no_load_voltage_v=positive(10_000),
    unit=st.sampled_from([None, "PD-17", "ADIF-3000", "own"]),
    rated_current_a=RATED,
    duty_class=st.sampled_from([None, "V", "IX", "own"]),
    units=st.integers(1, 5),
    units_in_service=st.sampled_from([None, 0, 1]),
    reserve_units=st.integers(0, 2),
    reserve_after_s=reals(0, 1e4),
    reserve_overload_percent=reals(0, 200),
    supply_point=st.none() | NAMES,
    contract_power_kw=RATED,
    feeder_rated_current_a=RATED,
    return_rated_current_a=RATED,
    conducts=st.sampled_from(["forward", "both"]),
    state=st.sampled_from(["in_service", "rectifiers_out", "bypassed", "open"]),
    feeder_resistance_ohm=reals(0, 10),
    return_resistance_ohm=reals(0, 10),
    dissipative_resistance_ohm=st.none() | reals(0, 10),
    grid_voltage_pu=reals(0.5, 1.5),
    tracks=TRACKS,
)


DAYS = st.none() | st.lists(st.sampled_from(["mon", "tue", "sat", "sun"]), min_size=1, max_size=3).map(tuple)
PORTIONS = st.lists(NAMES, min_size=2, max_size=3).map(tuple)
TURNS = st.fixed_dictionaries(
    {
        "rotations": listed(st.builds(Rotation, id=st.none() | NAMES, runs=PORTIONS, turn_round_s=reals(0, 1e4))),
        "joins": listed(st.builds(Join, portions=PORTIONS, into=NAMES, coupling_s=reals(0, 1e4))),
        "splits": listed(st.builds(Split, run=NAMES, portions=PORTIONS, uncoupling_s=reals(0, 1e4))),
    }
)


@st.composite
def loads(draw: st.DrawFn) -> Load:
    quantity = draw(st.sampled_from(["power_kw", "current_a"]))
    demand = draw(st.just(None) | st.lists(reals(0.0), min_size=1, max_size=60))
    given = {quantity: draw(reals())}
    if demand is not None:  # a profile, long enough now and then for a file of its own
        sign = draw(st.sampled_from([-1.0, 1.0]))
        given = {"profile": tuple(LoadPoint(time=0.25 * k, **{quantity: sign * value}) for k, value in enumerate(demand))}
    times = draw(st.none() | st.tuples(TIMES, TIMES).filter(lambda pair: abs(pair[0] - pair[1]) > 1e-3).map(sorted))
    return Load(
        id=draw(NAMES),
        track=draw(NAMES),
        km=draw(reals()),
        limits=draw(st.sampled_from(["range", "none"])),
        fold_back_from_v=draw(st.none() | positive(5000)),
        from_=times[0] if times else None,
        to=times[1] if times else None,
        **given,
    )


WIRES = st.builds(
    Wire,
    conductor=st.sampled_from(["Cu100", "own"]),
    count=st.integers(1, 3),
    use=st.sampled_from(["contact", "messenger", "feeder"]),
    wear_percent=st.none() | reals(0, 60),
)
CONTACT_LINES = st.one_of(
    stretch(ContactLine, resistance_ohm_per_km=positive(10), rated_current_a=RATED, tracks=TRACKS),
    stretch(ContactLine, type=st.sampled_from(["C120-2C", "CA-220", "own", "unknown"]), wear_percent=st.none() | reals(0, 60)),
    stretch(ContactLine, wires=st.lists(WIRES, min_size=1, max_size=3).map(tuple), temperature_c=st.none() | reals(-50, 200)),
)
RETURNS = stretch(ReturnCircuit, resistance_ohm_per_km=reals(0, 10), rated_current_a=RATED, tracks=TRACKS) | stretch(
    ReturnCircuit, rail=st.sampled_from(["60E1", "own"]), wear_percent=reals(0, 60)
)

SUPPLIES = st.builds(
    Supply,
    system=NAMES,
    substations=listed(SUBSTATIONS),
    section_cabins=listed(
        st.builds(
            SectionCabin,
            id=NAMES,
            km=reals(),
            state=st.sampled_from(["closed", "bypassed", "open"]),
            feeder_rated_current_a=RATED,
            tracks=TRACKS,
        )
    ),
    section_points=listed(st.builds(SectionPoint, id=NAMES, track=NAMES, km=reals(), state=st.sampled_from(["open", "closed"]))),
    contact_lines=st.lists(CONTACT_LINES, min_size=1, max_size=3).map(tuple),
    return_circuit=st.lists(RETURNS, min_size=1, max_size=3).map(tuple),
    feeders=listed(
        st.builds(
            Feeder,
            at=NAMES,
            track=NAMES,
            side=st.sampled_from(["low_km", "high_km", "return"]),
            cable=st.sampled_from(["YAKY-500", "own"]),
            cables=st.integers(1, 9),
            length_m=positive(1e4),
            rated_current_a=RATED,
        )
    ),
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

CONDUCTORS = listed(
    st.builds(
        Conductor,
        kind=st.sampled_from(["wire", "cable", "rail"]),
        name=st.sampled_from(["own", "Cu100", "YAKY-500", "60E1"]),
        resistance_ohm_per_km=positive(10),
        area_mm2=st.none() | positive(1e4),
        per_kelvin=reals(0, 0.02),
        rated_current_a=RATED,
        diameter_mm=RATED,
        highest_c=RATED,
        source=CELLS,
        status=st.sampled_from(["verified", "secondary", "recalled", "user"]),
    )
    | st.builds(
        Conductor,
        kind=st.just("contact_line"),
        name=st.sampled_from(["own", "C120-2C"]),
        resistance_ohm_per_km=st.none() | positive(10),
        wires=st.sampled_from(["contact 1 own", "messenger 2 L150 + contact 2 Cu100 + feeder 1 own"]),
        source=CELLS,
    )
).map(lambda rows: overlay_conductors(shipped_conductors(), rows))

# A class is replaced as a whole: by some of its own rows, too.
DUTY = st.one_of(
    st.sampled_from([(), ("V", 1), ("IX", 2)]).map(
        lambda pick: duty_of(DUTY_CLASSES.shipped, pick[0])[: pick[1]] if pick else ()
    ),
    st.lists(
        st.builds(
            DutyRow,
            duty_class=st.sampled_from(["V", "VI", "own"]),
            window_s=st.sampled_from([0.0, 60.0, 7200.0, 0.1]),
            multiple=positive(100),
            meaning=CELLS,
            source=CELLS,
        ),
        max_size=4,
        unique_by=lambda row: (row.duty_class, row.window_s),
    ),
).map(lambda rows: overlay_duty(DUTY_CLASSES.shipped, rows))

UNITS = listed(
    st.builds(
        RectifierUnit,
        unit=st.sampled_from(["PD-17", "own"]),
        rated_current_a=positive(1e4),
        rated_voltage_v=positive(1e4),
        duty_class=st.sampled_from(["V", "own", "missing"]),
        pulses=st.integers(2, 24),
        transformer_mva=RATED,
        short_circuit_percent=st.none() | positive(100),
        load_loss_kw=st.none() | reals(0, 100),
        source=CELLS,
    )
).map(lambda rows: overlay_units(RECTIFIER_UNITS.shipped, rows))

ENDS = st.tuples(TIMES, TIMES).filter(lambda pair: abs(pair[0] - pair[1]) > 1e-3).map(sorted)
SIZINGS = st.builds(
    Sizing,
    utilisation_percent=positive(200),
    useful_voltage=st.builds(
        UsefulVoltageStudy,
        zones=listed(stretch(Zone, id=NAMES, tracks=TRACKS)),
        windows=listed(ENDS.map(lambda pair: Window(from_=pair[0], to=pair[1]))),
        line_class=st.sampled_from(["conventional", "high_speed"]),
    ),
    search=st.builds(SizingSearch, most_units=st.integers(1, 9), contact_lines=listed(NAMES), unit_points=reals(0)),
)
CONTINGENCIES = st.builds(
    Contingency,
    kinds=st.sampled_from([("unit",), OUTAGE_KINDS[::-1]]),
    cabin_modes=st.sampled_from([("open",), ("open", "bypassed")]),
    devices=st.none() | listed(NAMES),
    low_grid_voltage_pu=st.none() | reals(0.5, 1.0),
    begins=st.none() | TIMES,
)

# --- trains: any text may be an identifier, so capitals, slashes, dots and names of devices are drawn often

STOCK_NAMES = NAMES | st.sampled_from(
    ["EP09", "ep09", "a/b", "A/B", "..", "con", "CON", "x.yaml", "50%", "%41", "\u00f3", "o\u0301", "L" * 300]
)
SHARES = reals(0.0, 1.0, exclude_min=True)


def least_two(strategy: st.SearchStrategy) -> st.SearchStrategy[tuple]:
    return st.lists(strategy, min_size=2, max_size=3).map(tuple)


def rising(high: float) -> st.SearchStrategy[list[float]]:
    return st.lists(positive(high), min_size=2, max_size=4, unique=True).map(sorted)


def maybe_dropped(strategy: st.SearchStrategy) -> st.SearchStrategy:
    return st.none() | strategy


FOLDS = {"fold_back_from_v": maybe_dropped(positive(5000)), "fold_back_to_v": maybe_dropped(positive(5000))}
LIMITED = {"max_current_a": maybe_dropped(positive(5000)), "knee_factor": maybe_dropped(SHARES)}

INVERTERS = st.builds(
    lambda constant, table, over, **more: InverterDrive(
        kind="inverter",
        efficiency=None if table else constant,
        efficiency_map=table,
        power_over_voltage=tuple(PowerOverVoltage(voltage_v=v, power_kw=v) for v in over),
        **more,
    ),
    SHARES,
    listed(st.builds(EfficiencyPoint, speed_kmh=reals(0, 300), load_percent=reals(0, 100), efficiency=SHARES)),
    st.just([]) | rising(4000),
    starting_effort_kn=positive(1000),
    power_kw=positive(9000),
    pull_out_kmh=maybe_dropped(positive(300)),
    **LIMITED,
    **FOLDS,
)

SERIES_MOTORS = st.builds(
    lambda currents, fields, **more: SeriesMotorDrive(
        kind="series_motors",
        magnetisation=tuple(MagnetisationPoint(current_a=current, emf_vs_per_rev=current) for current in currents),
        field_steps_percent=tuple(reversed(fields)),
        **more,
    ),
    rising(2000),
    rising(100),
    motors=st.integers(1, 12),
    groupings=st.lists(
        st.builds(
            Grouping, series=st.integers(1, 8), parallel=st.integers(1, 8), starting_current_a=maybe_dropped(positive(900))
        ),
        min_size=1,
        max_size=3,
    ).map(tuple),
    starting_current_a=positive(900),
    motor_resistance_ohm=reals(0, 1),
    gear_ratio=positive(9),
    wheel_diameter_m=positive(2),
    gear_efficiency=SHARES,
    starting_resistors_ohm=maybe_dropped(
        st.builds(
            StartingResistors, series=listed(reals(0, 9)), series_parallel=listed(reals(0, 9)), parallel=listed(reals(0, 9))
        )
    ),
    relay=maybe_dropped(
        st.builds(lambda pair, delay: Relay(off_v=pair[0], on_v=pair[1], delay_s=delay), rising(4000), reals(0, 9))
    ),
    notch_time_s=reals(0, 9),
    **LIMITED,
)

POINTS = {"speed_kmh": reals(0, 300), "voltage_v": maybe_dropped(positive(5000))}
TABLES = st.builds(
    TableDrive,
    kind=st.just("table"),
    effort=least_two(st.builds(EffortPoint, effort_kn=reals(0, 900), **POINTS)),
    current=least_two(st.builds(CurrentPoint, current_a=reals(0, 5000), **POINTS)),
    **LIMITED,
    **FOLDS,
)

VEHICLES = st.builds(
    lambda mass, share, **more: Vehicle(
        mass_t=mass, adhesive_mass_t=None if share is None else max(mass * share, 5e-324), **more
    ),
    reals(1, 500),
    maybe_dropped(SHARES),
    id=STOCK_NAMES,
    name=TEXTS,
    source=TEXTS,
    kind=st.sampled_from(["locomotive", "multiple_unit", "coach", "wagon"]),
    load_t=reals(0, 100),
    length_m=positive(500),
    max_speed_kmh=positive(600),
    axles=maybe_dropped(st.integers(1, 40)),
    rotating_mass_factor=reals(1, 2),
    resistance=st.builds(
        Resistance,
        a_n=reals(0, 9e3),
        specific_c_n_per_kn_per_kmh2=reals(0, 1),
        tunnel_factor_single_track=maybe_dropped(reals(1, 9)),
    ),
    adhesion=st.builds(Adhesion, c=reals(0, 1)),
    drive=st.none() | INVERTERS | SERIES_MOTORS | TABLES,
    brake=st.builds(
        Brake, regenerates=st.none() | st.booleans(), service_rate_mps2=positive(5), efficiency=maybe_dropped(SHARES)
    ),
    auxiliaries=st.builds(Auxiliaries, power_kw=reals(0, 900), heating=st.sampled_from(["resistive", "constant_power"])),
)

CALLS = st.builds(
    Call,
    station=NAMES,
    arrival=maybe_dropped(TIMES),
    departure=maybe_dropped(TIMES),
    min_dwell_s=reals(0, 900),
    stops=st.booleans(),
)
LEGS = st.builds(
    lambda track, pair: Leg(track=track, from_km=pair[0], to_km=pair[1]),
    NAMES,
    st.tuples(reals(), reals()).filter(lambda pair: pair[0] != pair[1]),
)


@st.composite
def rolling_stock(draw: st.DrawFn) -> dict[str, object]:
    """Draw runs, and just the trains and vehicles that they use."""
    vehicles = {vehicle.id: vehicle for vehicle in draw(st.lists(VEHICLES, min_size=1, max_size=3))}
    parts = st.lists(
        st.builds(
            Part,
            id=st.sampled_from(sorted(vehicles)),
            count=st.integers(1, 40),
            load_percent=reals(0, 200),
            powered=st.booleans(),
        ),
        min_size=1,
        max_size=3,
    ).map(tuple)
    kinds = st.builds(
        Train,
        id=STOCK_NAMES,
        name=TEXTS,
        source=TEXTS,
        category=st.none() | TEXTS,
        vehicles=parts,
        max_speed_kmh=maybe_dropped(positive(600)),
        service_rate_mps2=maybe_dropped(positive(5)),
        mass_distribution=st.sampled_from(["uniform", "point"]),
    )
    trains = {train.id: train for train in draw(st.lists(kinds, max_size=3))}
    what = st.fixed_dictionaries({"vehicles": parts})
    if trains:
        what |= st.fixed_dictionaries({"train": st.sampled_from(sorted(trains))})
    runs = st.builds(
        lambda which, **more: TrainRun(**which, **more),
        what,
        id=NAMES,
        category=st.none() | TEXTS,
        route=st.lists(LEGS, min_size=1, max_size=3).map(tuple),
        start=st.builds(Start, time=TIMES, speed_kmh=reals(0, 300)),
        end=st.sampled_from([None, "leave", "stop", "stay"]),
        calls=listed(CALLS),
        days=DAYS,
    )
    services = st.builds(
        lambda what, ends, **more: Service(**what, first=ends[0], last=ends[1], **more),
        what,
        st.tuples(TIMES, TIMES).map(sorted),
        id=NAMES,
        headway_s=reals(1.0, 1e5),
        route=st.lists(LEGS, min_size=1, max_size=3).map(tuple),
        start_speed_kmh=reals(0, 300),
        calls=listed(CALLS),
        days=DAYS,
    )
    timetable = Timetable(
        trains=draw(listed(runs)), services=draw(listed(services)), carry_over=draw(st.booleans()), **draw(TURNS)
    )
    owners = (*timetable.trains, *timetable.services)
    used = [trains[run.train] for run in owners if run.train is not None]
    of_vehicles = {part.id for owner in (*used, *owners) for part in owner.vehicles}
    return {
        "timetable": timetable,
        "trains": tuple(trains[name] for name in sorted({train.id for train in used})),
        "vehicles": tuple(vehicles[name] for name in sorted(of_vehicles)),
    }


CLOCKS = st.builds(
    lambda pair, step, warm: Clock(start=pair[0], end=pair[1], step_s=step, warm_up=(pair[1] - pair[0]) / 2 if warm else None),
    st.tuples(TIMES, TIMES).filter(lambda pair: abs(pair[0] - pair[1]) > 1e-3).map(sorted),
    reals(0.02, 5.0),
    st.booleans(),
)

SCENARIOS = st.builds(
    lambda stock, **more: Scenario(**stock, **more),
    rolling_stock(),
    name=TEXTS,
    line=LINES,
    supply=SUPPLIES,
    clock=CLOCKS,
    coupling=st.sampled_from(["full", "constant_voltage"]),
    coupling_voltage_v=st.none() | positive(5000),
    seed=st.integers(0, 2**40),
    limits=LIMITS,
    conductors=CONDUCTORS,
    duty_classes=DUTY,
    rectifier_units=UNITS,
    sizing=SIZINGS,
    contingency=CONTINGENCIES,
    coast_without_voltage_s=reals(0, 900),
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


@settings(
    derandomize=True, deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)
@given(SCENARIOS)
def test_a_scenario_kept_with_results_is_the_same(scenario):
    with tempfile.TemporaryDirectory() as folder:
        RunWriter(Path(folder), "study", scenario.input_hash, scenario=scenario).finish({"study": "study"}, [])
        kept = Results.open(folder).scenario
    assert kept == scenario
    assert kept.input_hash == scenario.input_hash
