"""Parameters of the simulated vehicle through a station: listed, read, set, described."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.parameter_files.described import PATHS, described
from gcs.parameter_files.reader import read
from tests.loopback.flight import Flight, Personality
from tests.loopback.lossy_link import CLEAR, Air, Weather
from tests.sample_files import elsewhere

LOSSY = Weather(loss=0.2)
GUARDED: dict[Personality, tuple[str, float]] = {
    "px4": ("NAV_DLL_ACT", 2.0),
    "ardupilot": ("FS_GCS_ENABLE", 1.0),
}
FREE: dict[Personality, tuple[str, float]] = {
    "px4": ("SDLOG_MODE", 1.0),
    "ardupilot": ("LOG_DISARMED", 1.0),
}


def told(flight: Flight) -> dict[str, int | float | None]:
    """Every parameter that the operator was told."""
    events = flight.of(ipc.ParametersEvent)
    return {each.name: each.value for event in events for each in event.parameters}


def sentence(flight: Flight, ask_id: int) -> str:
    """Of the ending, else of the verdict."""
    answers = flight.endings(ask_id) or flight.verdicts(ask_id)
    return answers[-1].sentence


@pytest.mark.parametrize("weather", [CLEAR, LOSSY])
def test_1369_parameters_of_a_file_by_ftp(weather: Weather) -> None:
    path = elsewhere("params", "arducopter_sitl.parm")
    held = {name: float(each.value) for name, each in read("f", path.read_bytes()).items()}
    flight = Flight("ardupilot", firmware="4.7", param_file=held, up=weather, down=weather)
    flight.run(3.0)
    before_s = flight.elapsed_s
    assert flight.done(flight.say("param_list")) == "complete"
    found = told(flight)
    assert len(held) == 1369
    assert set(held) <= set(found)
    assert all(math.isclose(found[name] or 0.0, held[name], rel_tol=1e-6) for name in held)
    if weather is CLEAR:
        assert flight.elapsed_s - before_s < 0.9
    assert max(len(event.parameters) for event in flight.of(ipc.ParametersEvent)) <= 50


@pytest.mark.parametrize("weather", [CLEAR, LOSSY])
def test_a_px4_s_by_messages(weather: Weather) -> None:
    flight = Flight("px4", up=weather, down=weather)
    flight.run(3.0)
    assert flight.done(flight.say("param_list")) == "complete"
    assert told(flight) == {
        spec.name: flight.parameters.value(spec.name) for spec in flight.parameters.specs
    }


def test_one_is_read_and_another_name_is_told_with_those_near(personality: Personality) -> None:
    flight = Flight(personality).connected()
    name, value = GUARDED[personality]
    flight.parameters.set(name, value)
    ask_id = flight.say("param_get", name=name)
    assert flight.done(ask_id) == "complete"
    assert sentence(flight, ask_id).startswith(f"{name} = {value:g} (int")
    ask_id = flight.say("param_get", name=f"{name}X")
    assert flight.done(ask_id) == "refused BAD_PARAMETER"
    assert f"no parameter {name}X; near: {name}" in sentence(flight, ask_id)


def test_what_safety_stands_on_is_set_on_the_ground_and_not_in_the_air(
    personality: Personality,
) -> None:
    flight = Flight(personality).connected()
    name, value = GUARDED[personality]
    ask_id = flight.say("param_set", name=name, value=value)
    assert flight.done(ask_id) == "complete"
    assert flight.parameters.value(name) == value
    assert sentence(flight, ask_id) == f"{name} = {value:g}; it was 0"
    flight.hovering()
    ask_id = flight.say("param_set", name=name, value=0.0)
    assert flight.done(ask_id) == "refused IN_AIR"
    assert "what the vehicle does when a link" in sentence(flight, ask_id)
    assert flight.parameters.value(name) == value
    free, free_value = FREE[personality]
    assert flight.done(flight.say("param_set", name=free, value=free_value)) == "complete"
    assert flight.parameters.value(free) == free_value
    assert flight.done(flight.say("param_list")) == "complete"  # by messages: files are not read


def test_a_write_that_was_lost_is_not_made_up_for_once_the_vehicle_is_armed() -> None:
    flight = Flight("px4").connected()
    flight.up = Air(Weather(loss=1.0), 1)
    ask_id = flight.say("param_set", name="NAV_DLL_ACT", value=2.0)
    flight.run(0.1)
    flight.vehicle.arm(False)
    flight.run(0.2)
    flight.up = Air(CLEAR, 1)
    assert flight.done(ask_id) == "aborted IN_AIR"
    assert flight.parameters.value("NAV_DLL_ACT") == 0.0


def test_over_a_link_that_loses_some_it_is_set_or_told(personality: Personality) -> None:
    name, value = GUARDED[personality]
    for seed in range(1, 8):
        flight = Flight(personality, seed=seed, up=LOSSY, down=LOSSY)
        flight.run(3.0)
        ask_id = flight.say("param_set", name=name, value=value)
        done = flight.done(ask_id)
        assert (flight.parameters.value(name) == value) or done != "complete"
        assert len(flight.verdicts(ask_id)) == 1


@pytest.mark.parametrize(
    ("value", "code"), [(1.5, "BAD_PARAMETER"), (1e12, "BAD_PARAMETER"), (None, "NON_FINITE")]
)
def test_what_it_cannot_hold_is_refused(value: float | None, code: str) -> None:
    flight = Flight("px4").connected()
    ask_id = flight.say("param_set", name="NAV_DLL_ACT", value=value)
    assert flight.done(ask_id) == f"refused {code}"
    assert flight.parameters.value("NAV_DLL_ACT") == 0.0


def test_a_value_that_the_vehicle_does_not_take_is_told() -> None:
    """ArduCopter 4.7 answers with PARAM_ERROR; a second request meanwhile is BUSY."""
    flight = Flight("ardupilot", firmware="4.7").connected()
    ask_id = flight.say("param_set", name="RTL_ALT_M", value=1e30)
    busy = flight.say("param_get", name="RTL_ALT_M")
    assert flight.done(busy) == "refused BUSY"
    assert flight.done(ask_id) in ("complete", "aborted")


def test_a_px4_says_what_its_parameters_mean() -> None:
    flight = Flight("px4", up=LOSSY, down=LOSSY)
    flight.run(3.0)
    missing = flight.done(flight.say("file_read", path=PATHS[0]))  # there is no compression here
    assert missing == "aborted VEHICLE_REFUSED"
    assert flight.done(flight.say("file_read", path=PATHS[1])) == "complete"
    data = b"".join(event.data for event in flight.of(ipc.FileDataEvent))
    known = described(PATHS[1], data)["NAV_DLL_ACT"]
    assert [choice.description for choice in known.values][:2] == ["off", "hold"]
