"""What wires carry: against the heat balance followed in time, sums by hand, and what may never happen."""

import math

import pytest

from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.conductors import Conductor, find_conductor
from tractionpower.model.limits import Limit, find_limit, overlay
from tractionpower.model.supply import ContactLine
from tractionpower.supply.ampacity import Weather, ampacity, heated_wires, weather_of

TABLE = shipped_conductors()
WEATHER = Weather(ambient_c=40.0, wind_mps=0.6, sun_wpm2=1000.0, emissivity=0.6, absorptivity=0.6)
COPPER_J_PER_M3K = 8900.0 * 385.0


def line(**how):
    return ContactLine.model_validate({"from_km": 0.0, "to_km": 1.0} | how)


def wires_of(*wires, **how):
    rows = [{"use": use, "count": count, "conductor": name} for use, count, name in wires]
    return heated_wires(line(wires=rows, **how), TABLE)


def given_off(wire, temperature_c, weather=WEATHER):
    """Return what a wire gives off less the sun [W/m], written once more."""
    d, film_k = wire.diameter_m, 273.15 + (temperature_c + weather.ambient_c) / 2.0
    re = 1.644e9 * weather.wind_mps * d * film_k**-1.78
    wind = math.pi * 0.02585 * (0.65 * re**0.2 + 0.23 * re**0.61) * (temperature_c - weather.ambient_c)
    glow = 5.67037e-8 * math.pi * d * weather.emissivity * ((temperature_c + 273.15) ** 4 - (weather.ambient_c + 273.15) ** 4)
    return wind + glow - weather.absorptivity * weather.sun_wpm2 * d


def warmed_up(wires, current_a, seconds, step_s=1.0, from_c=WEATHER.ambient_c):
    """Return the temperatures after so long with a current, from that of the air or another one on, step by step."""
    temperatures = [from_c for _ in wires]
    for _ in range(int(seconds / step_s)):
        ohms = [w.ohm_per_m * (1.0 + w.per_kelvin * (t - 20.0)) for w, t in zip(wires, temperatures, strict=True)]
        fall = current_a / sum(w.count / ohm for w, ohm in zip(wires, ohms, strict=True))
        for k, (w, ohm) in enumerate(zip(wires, ohms, strict=True)):
            copper_m2 = 0.0178e-6 / w.ohm_per_m  # cross-section that is left
            heat = fall**2 / ohm - given_off(w, temperatures[k])
            temperatures[k] += step_s * heat / (COPPER_J_PER_M3K * copper_m2)
    return temperatures


def test_one_wire_by_hand():
    (wire,) = wires_of(("contact", 1, "Cu100"))
    found = ampacity([wire], WEATHER)
    ohm_per_m = 0.183e-3 * (1.0 + 0.00393 * 60.0)
    assert found.current_a == pytest.approx(math.sqrt(given_off(wire, 80.0) / ohm_per_m), rel=1e-5)
    assert found.current_a == pytest.approx(396.0, abs=2.0)  # 35.1 W/m by wind, 7.6 by radiation, 7.2 from the sun
    assert found.temperatures_c == (80.0,)


@pytest.mark.parametrize("how", [{"type": "2C120-2C"}, {"type": "YC120-2CS150"}, {"type": "C95-2C", "wear_percent": 25.0}])
def test_the_current_warms_the_first_wire_to_its_highest_temperature_and_no_other_beyond(how):
    wires = heated_wires(line(**how), TABLE)
    found = ampacity(wires, WEATHER)
    temperatures = warmed_up(wires, found.current_a, 4 * 3600.0)
    assert temperatures == pytest.approx(found.temperatures_c, abs=0.01)
    assert all(t <= wire.highest_c + 0.01 for t, wire in zip(temperatures, wires, strict=True))
    ruling = [wire.conductor for t, wire in zip(temperatures, wires, strict=True) if t >= wire.highest_c - 0.01]
    assert found.ruling in ruling
    assert max(warmed_up(wires, 1.02 * found.current_a, 4 * 3600.0)[k] - wires[k].highest_c for k in range(len(wires))) > 0.5


def test_contact_lines_of_the_main_lines_carry_one_to_two_kiloamperes():
    for name, low, high in (("C120-2C", 1000.0, 1400.0), ("2C120-2C", 1400.0, 2000.0), ("CA-220", 1400.0, 2000.0)):
        assert low < ampacity(heated_wires(line(type=name), TABLE), WEATHER).current_a < high


def test_wear_wind_sun_and_air_act_as_they_must():
    new, worn = (wires_of(("contact", 2, "Cu100"), ("messenger", 1, "L120"), wear_percent=wear) for wear in (0.0, 20.0))
    base = ampacity(new, WEATHER).current_a
    assert ampacity(worn, WEATHER).current_a < base
    for better in ({"wind_mps": 1.0}, {"sun_wpm2": 0.0}, {"ambient_c": 20.0}):
        values = {name: getattr(WEATHER, name) for name in Weather.__slots__}
        assert ampacity(new, Weather(**values | better)).current_a > base
    calm = Weather(ambient_c=40.0, wind_mps=0.0, sun_wpm2=1000.0, emissivity=0.6, absorptivity=0.6)
    assert 0.0 < ampacity(new, calm).current_a < base
    assert ampacity(new, Weather(80.0, 0.6, 1000.0, 0.6, 0.6)).current_a == 0.0  # the sun alone warms it enough


def test_a_silver_copper_wire_may_be_hotter_and_the_messenger_rules():
    found = ampacity(wires_of(("contact", 2, "CuAg100"), ("messenger", 1, "L120")), WEATHER)
    assert found.ruling == "L120"
    assert found.temperatures_c[0] < 100.0


@pytest.mark.parametrize(
    ("burst_s", "low_c", "high_c"), [(120, 84.0, 90.0), (240, 79.0, 84.0), (300, 77.0, 82.0), (480, 70.0, 80.0)]
)
def test_the_window_of_contact_lines_suits_trains_that_take_minutes_to_pass(burst_s, low_c, high_c):
    (wire,) = wires_of(("contact", 1, "Cu100"))
    window_s = find_limit(shipped_limits(), "dc", "window_contact_line_s").value
    burst_a = ampacity([wire], WEATHER).current_a * math.sqrt(window_s / burst_s)  # its mean over the window is the rating
    (sunny,) = warmed_up([wire], 0.0, 2 * 3600.0)
    assert low_c < warmed_up([wire], burst_a, burst_s, from_c=sunny)[0] < high_c


def test_what_is_not_known_is_told():
    assert heated_wires(line(resistance_ohm_per_km=0.05), TABLE) == "its wires are not known"
    assert heated_wires(line(type="KB70-C"), TABLE) == "its wires are not known"
    thin = Conductor(kind="wire", name="thin", resistance_ohm_per_km=0.5)
    told = heated_wires(line(wires=[{"use": "contact", "conductor": "thin"}]), (*TABLE, thin))
    assert told == "diameter_mm or highest_c of wire thin is not known"


def test_the_weather_is_that_of_the_limits_table_and_a_system_may_have_its_own():
    shipped = shipped_limits()
    assert weather_of(shipped, "dc3000") == WEATHER
    own = overlay(shipped, [Limit(system="dc3000", name="wire_wind_mps", value=1.0)])
    assert weather_of(own, "dc3000").wind_mps == 1.0
    assert weather_of(own, "dc1500").wind_mps == 0.6
    assert weather_of([limit for limit in shipped if limit.name != "wire_sun_wpm2"], "dc3000") is None


def test_all_wires_of_shipped_contact_lines_can_be_rated():
    for kind in (row for row in TABLE if row.kind == "contact_line" and row.wires):
        wires = heated_wires(line(type=kind.name), TABLE)
        assert not isinstance(wires, str), kind.name
        for wire in wires:
            area = find_conductor(TABLE, "wire", wire.conductor).area_mm2
            filled = area / (math.pi / 4.0 * find_conductor(TABLE, "wire", wire.conductor).diameter_mm ** 2)
            assert 0.7 < filled < 1.0, wire.conductor  # stranded some 0.76, grooved some 0.9
