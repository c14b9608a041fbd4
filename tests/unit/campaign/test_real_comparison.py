"""Flights beside a real autopilot: which it can fly, where it really was, and what differs."""

from __future__ import annotations

import math
import struct
from pathlib import Path

import pytest

from gcs.campaign.case import ERROR, LANDED, STARVED, Row, Value
from gcs.campaign.real_autopilot import ARDUCOPTER, PX4, arducopter, asked_of, px4
from gcs.campaign.real_comparison import NoneFitsError, chosen, compared
from gcs.campaign.real_truth import RealTruth
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, split
from gcs.wire.ids import Sensor
from gcs.wire.messages import BatteryStatus, Heartbeat
from tests.unit.campaign.campaigns import TEXT, planned

WRITER = FrameWriter(1, 1)


def frame(data: bytes) -> Frame:
    [found] = split(data)
    assert isinstance(found, Frame)
    return found


def hil_state(lat: float, lon: float, alt_m: float, v_ned: tuple[float, float, float]) -> Frame:
    """By the message's definition, not by our reading of it."""
    numbers = (round(lat * 1e7), round(lon * 1e7), round(alt_m * 1e3))
    speeds = [round(100.0 * each) for each in v_ned]
    payload = struct.pack("<Q4f3f3i3h2H3h", 0, 1, 0, 0, 0, 0, 0, 0, *numbers, *speeds, *[0] * 5)
    return frame(WRITER.write_payload(115, payload))


def sim_state(lat: float, lon: float, alt_m: float, v_ned: tuple[float, float, float]) -> Frame:
    floats = [0.0] * 15 + [alt_m, 0.0, 0.0, *v_ned]
    floats[13:15] = [lat, lon]
    payload = struct.pack("<21f2i", *floats, round(lat * 1e7), round(lon * 1e7))
    return frame(WRITER.write_payload(108, payload))


@pytest.mark.parametrize(("told", "autopilot"), [(hil_state, "px4"), (sim_state, "ardupilot")])
def test_where_it_really_was(told: type, autopilot: str) -> None:
    """A 10,000th of a degree north is 11.1 m, east at 60 degrees half of that."""
    truth = RealTruth(autopilot)
    assert not truth.known
    truth.take(told(60.0, 8.0, 488.0, (0.0, 0.0, 0.0)))
    assert truth.truth().landed
    truth.take(told(60.0001, 8.0001, 493.5, (1.5, -2.0, 0.25)))
    found = truth.truth()
    assert found.home == pytest.approx((60.0, 8.0, 488.0), abs=1e-7)
    assert found.pos_ned == pytest.approx((11.12, 5.56, -5.5), abs=0.03)
    assert found.v_ned == pytest.approx((1.5, -2.0, 0.25))
    assert not found.landed
    assert found.energy_j is None


def test_what_it_says_of_itself() -> None:
    truth = RealTruth("ardupilot")
    truth.take(hil_state(0.0, 0.0, 0.0, (0.0, 0.0, 0.0)))
    for drawn_mah in (-1, 100, 350):
        volts = (4000, 4000, 4000, *[0xFFFF] * 7)
        battery = BatteryStatus(drawn_mah, -1, 0, volts, 0, 0, 0, 0, 90)
        truth.take(frame(WRITER.write(battery)))
    assert truth.truth().energy_j == pytest.approx(0.25 * 12.0 * 3600.0)
    assert not truth.truth().armed
    truth.take(frame(FrameWriter(1, 191).write(Heartbeat(0, 18, 8, 128, 4))))
    assert not truth.truth().armed, "a companion is not the autopilot"
    truth.take(frame(WRITER.write(Heartbeat(0, 2, 3, 128 | 1, 4))))
    assert truth.truth().armed
    health = bytes(8) + struct.pack("<I", Sensor.PREARM_CHECK) + bytes(19)
    truth.take(frame(WRITER.write_payload(1, health)))
    assert truth.ready


def test_what_it_can_not_do_is_refused_by_its_key() -> None:
    own: dict[str, Value] = {"seed": 7, "airframe": "sih", "sensors": "good", "loss": 0.0}
    assert asked_of(PX4, {**own, "autopilot": "px4", "wind_m_s": 0, "wind_from_deg": 90.0}) == {}
    wind = {"wind_m_s": 4.0, "wind_from_deg": -90.0, "gust_m_s": 1}
    assert asked_of(ARDUCOPTER, {**own, "autopilot": "ardupilot", **wind}) == {
        "SIM_WIND_T": 1.0,
        "SIM_WIND_SPD": 4.0,
        "SIM_WIND_DIR": 270.0,
        "SIM_WIND_TURB": 1,
    }
    for kind, key, value in (
        (PX4, "wind_m_s", 1.0),
        (PX4, "autopilot", "ardupilot"),
        (PX4, "faults", "[[fault]]"),
        (ARDUCOPTER, "payload_kg", 0.5),
        (ARDUCOPTER, "loss", 0.1),
    ):
        with pytest.raises(ValueError, match=f"^{key}: "):
            asked_of(kind, {**own, key: value})


def test_chosen_are_flights_that_it_can_fly_spread_evenly(tmp_path: Path) -> None:
    plan = planned(tmp_path, TEXT)
    cases = [plan.case(n, plan.inputs([n / 40] * 5)) for n in range(40)]
    picked = chosen(cases, arducopter, 5)
    assert [case.id for case in picked] == [20, 24, 28, 32, 36]
    assert all(case.table["autopilot"] == "ardupilot" for case in picked)
    with pytest.raises(NoneFitsError, match="wind_m_s"):
        chosen(cases[1:20], px4, 5)


def row(number: int, closest_m: float | None, **more: object) -> Row:
    values = {"outcome": LANDED, "energy_wh": None, **more}
    breach = closest_m is not None and closest_m < 0.0
    return Row(id=number, inputs={"task": "up"}, closest_m=closest_m, breach=breach, **values)  # type: ignore[arg-type]


def test_pairs_are_compared_and_what_does_not_count_is_named() -> None:
    ours = {n: row(n, 2.0 + n, flight_s=40.0, energy_wh=3.0) for n in range(6)}
    real = {
        1: row(1, 3.5, flight_s=44.0),
        2: row(2, 3.0, flight_s=46.0),
        3: row(3, -0.25, outcome="late"),
        4: row(4, 9.0, outcome=STARVED),
        5: row(5, None, outcome=ERROR),
    }
    told = compared("px4-sitl", ours, real)
    assert (told.flights, told.compared, told.uncounted) == (5, 3, [4, 5])
    assert told.other_outcome == [3]
    assert (told.nearer, told.nearer_m) == ([2, 3], 5.25)
    assert (told.ours_closest_m, told.real_closest_m) == (3.0, -0.25)
    assert (told.breaches_ours, told.breaches_real) == (0, 1)
    by_name = {each.measure: each.quantiles for each in told.differences}
    assert by_name["closest_m"][2] == pytest.approx(-1.0)
    assert "energy_wh" not in by_name, "a real one without an ammeter has no such difference"
    assert any("nearer in 2 of 3, by 5.25 m" in line for line in told.lines())
    assert math.isclose(by_name["flight_s"][-1], 6.0)
