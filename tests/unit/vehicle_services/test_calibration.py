"""PREFLIGHT_CALIBRATION: acks, texts and ends, as recorded (scenarios D1, D2, D5; clients.md 12).

One thing is not copied: while one calibration ran, PX4 answered a second one by a storm of DENIED
acks; this one says it once.
"""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, S, acks, long, of
from tests.unit.vehicle_services.flown_vehicle import Flown, in_the_air, on_the_ground
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.plant.faults import GyroBias
from vehicle_sim.wire import messages as m

pytestmark = pytest.mark.slow  # a vehicle flies

CALIBRATE = 241
ARM = long(400, 1)
CALIBRATING, STANDBY = 2, 3  # MAV_STATE


def calibrate(*params: float) -> m.CommandLong:
    return long(CALIBRATE, *params)


def told(bench: Flown, asked: m.CommandLong, ns: int) -> tuple[list[int], list[str]]:
    """The results of its acks, and the texts, within that time."""
    heard = bench.send(asked) + bench.advance(ns)
    results = [result for command, result in acks(heard) if command == asked.command]
    return results, heard_of_it(bench, heard)


def heard_of_it(bench: Flown, heard: list[m.Message]) -> list[str]:
    """No station beats here, which is told, too."""
    return [text for text in bench.texts(heard) if not text.startswith("Connection to ground")]


GYRO_DONE = [
    "[cal] calibration started: 2 gyro",
    *(f"[cal] progress <{part}>" for part in range(0, 101, 10)),
    "[cal] calibration done: gyro",
]


@pytest.mark.parametrize(
    ("params", "texts"),
    [
        ((1,), GYRO_DONE),
        ((0, 0, 1), ["[cal] calibration started: 2 baro", "[cal] calibration done: baro"]),
        ((0, 0, 0, 1), ["Calibration: Disabling RC input\t"]),
        ((0, 0, 0, 2), ["trim cal done\t"]),
        ((0, 0, 0, 0, 2), ["[cal] calibration started: 2 level", "[cal] calibration done: level"]),
        ((0, 0, 0, 0, 4), []),
        ((), []),
        ((1, 0, 1), GYRO_DONE),
    ],
)
def test_px4s_run_through_their_steps_and_end(params: tuple[float, ...], texts: list[str]) -> None:
    """D1, D5: ACCEPTED at once; of two in one command the first; none at all is ACCEPTED."""
    bench = on_the_ground("px4")
    assert told(bench, calibrate(*params), 5 * S) == ([Result.ACCEPTED], texts)
    assert bench.autopilot.system_status == STANDBY
    assert bench.result(ARM) == Result.ACCEPTED


@pytest.mark.parametrize("params", [(3,), (0, 0, 0, 0, 3)])
def test_px4_does_not_answer_what_it_does_not_know(params: tuple[float, ...]) -> None:
    """D1: p1 = 3 and p5 = 3."""
    assert told(on_the_ground("px4"), calibrate(*params), 5 * S) == ([], [])


def test_a_calibrating_px4_says_so_and_takes_no_arming_and_no_second_one() -> None:
    """D2."""
    bench = on_the_ground("px4")
    assert bench.result(calibrate(0, 0, 1), 500 * MS) == Result.ACCEPTED
    assert bench.autopilot.system_status == CALIBRATING
    results, texts = told(bench, ARM, 200 * MS)
    assert results == [Result.TEMPORARILY_REJECTED]
    assert texts == ["Transition denied: Init to Armed\t"]
    assert told(bench, calibrate(1), 200 * MS) == ([Result.TEMPORARILY_REJECTED], [])


@pytest.mark.slow
def test_px4s_gyro_calibration_denies_another_and_begins_anew_while_the_vehicle_moves() -> None:
    """D2: 20 tries of a second each; D1: done once it lies still."""
    for shaken_s, last in ((30.0, "[cal] calibration failed: gyro"), (3.0, "done: gyro")):
        bench = on_the_ground("px4")
        assert bench.result(calibrate(1), 0) == Result.ACCEPTED
        results, texts = told(bench, calibrate(0, 0, 1), 100 * MS)
        assert results == [Result.DENIED]
        assert "command denied during calibration: 241\t" in texts
        said: list[str] = []
        for tick in range(240):
            rate = 0.02 * (-1) ** (tick // 3) if tick < 10 * shaken_s else 0.0
            bench.autopilot.inject(GyroBias((rate, 0.0, 0.0)))
            said += heard_of_it(bench, bench.advance(100 * MS))
        assert said[-1].endswith(last)
        assert said.count("motion, retrying..") == pytest.approx(min(20.0, shaken_s), abs=1)


@pytest.mark.slow
def test_px4_cancels_a_gyro_calibration_but_none_that_waits_for_a_side() -> None:
    """D1, D5, D6: a cancel is all zero."""
    bench = on_the_ground("px4")
    assert bench.result(calibrate(1), 300 * MS) == Result.ACCEPTED
    results, texts = told(bench, calibrate(), 2 * S)
    assert results == [Result.ACCEPTED]
    assert texts == ["[cal] calibration cancelled", "[cal] calibration failed: gyro"]
    assert bench.autopilot.system_status == STANDBY
    results, texts = told(bench, calibrate(0, 1), S)
    assert texts == [
        "[cal] calibration started: 2 mag",
        "[cal] pending: back front left right up down",
        "[cal] hold vehicle still on a pending side",
    ]
    assert told(bench, calibrate(), 8 * S) == ([Result.TEMPORARILY_REJECTED], [])
    assert bench.autopilot.system_status == CALIBRATING
    assert "[cal] calibration failed: mag" in bench.texts(bench.advance(90 * S))
    assert bench.autopilot.system_status == STANDBY


def test_nothing_is_calibrated_while_armed() -> None:
    """D2, of ArduPilot."""
    bench = in_the_air("ardupilot")
    assert told(bench, calibrate(1), S) == ([Result.FAILED], ["Disarm to allow calibration"])


@pytest.mark.parametrize(
    ("params", "results", "texts", "acked_ms"),
    [
        ((1,), [Result.ACCEPTED], ["Initialising ArduPilot"], 530),
        ((0, 0, 1), [Result.ACCEPTED],
         ["Updating barometer calibration", "Barometer calibration complete"], 0),
        ((0, 0, 0, 0, 2), [Result.ACCEPTED],
         ["Initialising ArduPilot", "Trim OK: roll=0.01 pitch=-0.01 yaw=0.00"], 1090),
        ((0, 0, 0, 0, 4), [Result.ACCEPTED], ["Initialising ArduPilot"], 1000),
        *((each, [Result.UNSUPPORTED], [], 0)
          for each in ((3,), (0, 0, 0, 1), (0, 0, 0, 2), (0, 0, 0, 0, 3), (0, 0, 0, 0, 0, 0, 1),
                       (0, 1), ())),
    ],
)  # fmt: skip
def test_ardupilots_are_acked_when_they_end(
    params: tuple[float, ...], results: list[Result], texts: list[str], acked_ms: int
) -> None:
    """D1: the ack of gyro and level comes at the end; the simple one was recorded afterwards."""
    bench = on_the_ground("ardupilot")
    heard = bench.send(calibrate(*params))
    early = [result for command, result in acks(heard) if command == CALIBRATE]
    assert early == ([] if acked_ms else results)
    heard += bench.advance(max(0, acked_ms - 150) * MS)
    assert len(acks(heard)) == len(early)
    heard += bench.advance(2 * S)
    assert [result for command, result in acks(heard) if command == CALIBRATE] == results
    assert bench.texts(heard)[: len(texts)] == texts
    sticks = params[3:4] > (0,)  # D1: "PreArm: RC calibrating"
    assert bench.result(ARM) == (Result.FAILED if sticks else Result.ACCEPTED)


def test_ardupilot_rejects_an_accelerometer_calibration_soon_after_another() -> None:
    """D1: 3.7 s after the end of a level one; recorded afterwards: not 7.1 s after it."""
    bench = on_the_ground("ardupilot")
    level, simple = calibrate(0, 0, 0, 0, 2), calibrate(0, 0, 0, 0, 4)
    assert told(bench, level, 4_800 * MS)[0] == [Result.ACCEPTED]
    assert told(bench, simple, 3_400 * MS) == ([Result.TEMPORARILY_REJECTED], [])
    assert told(bench, simple, 2 * S) == ([Result.ACCEPTED], ["Initialising ArduPilot"])


def test_ardupilots_compass_calibration_is_started_and_cancelled() -> None:
    """D3: 42424 ACCEPTED, 42425 FAILED while it runs, 42426 ACCEPTED; PX4 knows none of them."""
    results = [Result.ACCEPTED, Result.FAILED, Result.ACCEPTED]
    bench, px4 = on_the_ground("ardupilot"), on_the_ground("px4")
    for command, result in zip((42424, 42425, 42426), results, strict=True):
        assert bench.result(long(command), 0) == result
        assert px4.result(long(command), 0) == Result.UNSUPPORTED


def positions(heard: list[m.Message]) -> list[float]:
    return [each.param1 for each in of(heard, m.CommandLong)]


def test_ardupilot_asks_for_sides_and_fails_as_the_vehicle_is_not_turned() -> None:
    """D1: asked once a second by a command; positions 1 and 2 are taken, then it has failed."""
    bench = on_the_ground("ardupilot")
    heard = bench.send(calibrate(0, 0, 0, 0, 1)) + bench.advance(4 * S)
    assert acks(heard) == [(CALIBRATE, Result.ACCEPTED)]
    assert bench.texts(heard) == [
        "Initialising ArduPilot",
        "Place vehicle level and press any key.",
    ]
    assert positions(heard) == [1.0] * 4
    assert bench.result(long(42429, 1), 0) == Result.ACCEPTED
    assert positions(bench.advance(1_100 * MS)) == [2.0]
    results, texts = told(bench, long(42429, 2), 100 * MS)
    assert (results, texts) == ([Result.ACCEPTED], ["Calibration FAILED"])
    assert positions(bench.advance(1_100 * MS)) == [16777216.0]
    assert bench.result(long(42429, 3), 0) == Result.FAILED
