"""PREFLIGHT_CALIBRATION and the motor test: what runs, what it says, and how it ends.

Nothing is learned by it: the simulated sensors' errors stay.  The texts and times are those that
PX4 1.14 and ArduCopter 4.7 were recorded with, by a vehicle that stands still.  So what asks to be
turned over is never satisfied: PX4 gives up after 90 s (from memory of its orientation detection),
ArduCopter at the second position.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import (
    CommandDone,
    CommandSent,
    Result,
    StatusText,
    VehicleEvent,
)
from vehicle_sim.numerics.vectors import Vec3

PREFLIGHT_CALIBRATION: Final = 241
ACCELCAL_VEHICLE_POS: Final = 42429
_STILL: Final = (0.0, 0.0, 0.0)
_FAILED_POSITION: Final = 16777216.0  # ACCELCAL_VEHICLE_POS_FAILED
_GIVES_UP_S: Final = 90.0
_ASKED_EVERY_NS: Final = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Line:
    """A STATUSTEXT, and when it is said."""

    at_s: float
    severity: int
    text: str


@dataclass(frozen=True, slots=True)
class Procedure:
    """`acked_s`: when the command is answered; None = at once.  `cancels`: PX4 obeys a cancel.

    `tries`: how often it is tried while the vehicle moves, and what is said in the end (`failed`).
    """

    lines: tuple[Line, ...]
    lasts_s: float
    name: str = ""
    acked_s: float | None = None
    cancels: bool = False
    positions: bool = False
    tries: int = 1
    failed: tuple[str, ...] = ()


def _started(name: str) -> Line:
    return Line(0.0, 6, f"[cal] calibration started: 2 {name}")


def _simple(name: str, lasts_s: float) -> Procedure:
    done = Line(lasts_s, 6, f"[cal] calibration done: {name}")
    return Procedure((_started(name), done), lasts_s, name)


def _sides(name: str) -> Procedure:
    return Procedure(
        (
            _started(name),
            Line(0.05, 6, "[cal] pending: back front left right up down"),
            Line(0.1, 6, "[cal] hold vehicle still on a pending side"),
            Line(_GIVES_UP_S, 2, f"[cal] calibration failed: {name}"),
        ),
        _GIVES_UP_S,
        name,
    )


_GYRO: Final = Procedure(
    (
        _started("gyro"),
        *(Line(0.04 + 0.00095 * part, 6, f"[cal] progress <{part // 10}>")
          for part in range(0, 1001, 100)),
        Line(1.0, 6, "[cal] calibration done: gyro"),
    ),
    1.0,
    "gyro",
    cancels=True,
    tries=20,
    failed=("ERROR: Motion during calibration", "[cal] calibration failed: gyro"),
)  # fmt: skip
_MOVES_RAD_S: Final = 0.0105
"""PX4's calibration of the gyroscope begins anew where its rate changes by more than 0.6 deg/s."""
_AIRSPEED: Final = Procedure(
    (_started("airspeed"), Line(0.05, 2, "[cal] Ensure sensor is not measuring wind")),
    _GIVES_UP_S,
    "airspeed",
    cancels=True,
)
_RADIO_OFF: Final = Procedure((Line(0.0, 6, "Calibration: Disabling RC input"),), 0.0)
_TRIM: Final = Procedure((Line(0.4, 6, "trim cal done"),), 0.4, "trim")
_RADIO: Final = "RC calibrating"
_COMPASS: Final = "Compass calibrated requires reboot"
_NOTHING: Final = Procedure((), 0.0)

# By the number (1..7) and the value of the parameter that is not 0; the first one counts.
_PX4: Final[dict[tuple[int, float], Procedure]] = {
    (1, 1.0): _GYRO,
    (2, 1.0): _sides("mag"),
    (3, 1.0): _simple("baro", 3.0),
    (4, 1.0): _RADIO_OFF,
    (4, 2.0): _TRIM,
    (5, 1.0): _sides("accel"),
    (5, 2.0): _simple("level", 0.6),
    (5, 4.0): _NOTHING,
    (6, 1.0): _AIRSPEED,
    (7, 1.0): _NOTHING,
}

_BEGINS: Final = Line(0.03, 6, "Initialising ArduPilot")
_COPTER: Final[dict[tuple[int, float], Procedure]] = {
    (1, 1.0): Procedure((_BEGINS,), 0.53, acked_s=0.53),
    (3, 1.0): Procedure(
        (Line(0.0, 6, "Updating barometer calibration"),
         Line(0.0, 6, "Barometer calibration complete")),
        0.0,
    ),
    (5, 1.0): Procedure(
        (_BEGINS, Line(0.54, 2, "Place vehicle level and press any key.")),
        0.54,
        acked_s=0.54,
        positions=True,
    ),
    (5, 4.0): Procedure((_BEGINS,), 1.0, acked_s=1.0),
    (5, 2.0): Procedure(
        (_BEGINS, Line(1.1, 6, "Trim OK: roll=0.01 pitch=-0.01 yaw=0.00")), 1.1, acked_s=1.1
    ),
}  # fmt: skip


def motor_test(seconds: float) -> Procedure:
    """ArduCopter's DO_MOTOR_TEST; the motors of this vehicle stand still meanwhile."""
    finished = Line(seconds, 6, "finished motor test")
    return Procedure((Line(0.0, 6, "starting motor test"), finished), seconds)


class Calibration:
    """At most one procedure at a time, in simulated time."""

    __slots__ = (
        "_acked", "_asked_ns", "_began_ns", "_highest", "_lowest", "_position", "_said",
        "_tries", "accel_again_ns", "against_arming", "running",
    )  # fmt: skip

    def __init__(self) -> None:
        self.running: Procedure | None = None
        self._position = 0.0
        self._asked_ns = 0
        self._began_ns = 0
        self._said = 0
        self._acked = True
        self._tries = 0
        self.accel_again_ns = 0  # before this ArduPilot calibrates no accelerometer
        self._lowest = self._highest = _STILL
        self.against_arming: tuple[str, ...] = ()

    @property
    def busy(self) -> bool:
        """PX4 says MAV_STATE_CALIBRATING, and does not arm."""
        return self.running is not None and bool(self.running.name)

    def mind_radio(self, wanted: float) -> None:
        """ArduPilot's parameter 4: a station calibrates the sticks by itself, until it says 0."""
        others = tuple(why for why in self.against_arming if why != _RADIO)
        self.against_arming = (*others, _RADIO) if wanted > 0.0 else others

    def compass_done(self) -> None:
        """ArduPilot's FIXED_MAG_CAL_YAW: what was found counts from the next start on."""
        others = tuple(why for why in self.against_arming if why != _COMPASS)
        self.against_arming = (*others, _COMPASS)

    @property
    def listens(self) -> bool:
        """PX4's procedure looks at commands while it runs."""
        return self.running is not None and self.running.cancels

    def begin(self, procedure: Procedure, time_ns: int) -> Result:
        self.running = procedure
        self._began_ns, self._said, self._tries = time_ns, 0, 0
        self._lowest = self._highest = _STILL
        self._position = 0.0
        self._acked = procedure.acked_s is None
        return Result.ACCEPTED if self._acked else Result.IN_PROGRESS

    def cancel_px4(self) -> tuple[Result, list[VehicleEvent]]:
        """All parameters 0: it is cancelled, where the procedure looks at that at all."""
        running = self.running
        if running is None or not running.cancels:
            return (Result.TEMPORARILY_REJECTED if self.busy else Result.ACCEPTED), []
        self.running = None
        texts: list[VehicleEvent] = [StatusText(2, "[cal] calibration cancelled")]
        if running.name == "gyro":
            texts.append(StatusText(2, "[cal] calibration failed: gyro"))
        return Result.ACCEPTED, texts

    def turned(self, position: float) -> tuple[Result, list[VehicleEvent]]:
        """ACCELCAL_VEHICLE_POS from the station: it says that the vehicle lies so now."""
        if position != self._position or self._position == 0.0:
            return Result.FAILED, []
        if position == 1.0:
            self._position = 2.0
            return Result.ACCEPTED, []
        self._position = _FAILED_POSITION
        self.against_arming = (*self.against_arming, "3D Accel calibration needed")
        return Result.ACCEPTED, [StatusText(2, "Calibration FAILED")]

    def update(self, time_ns: int, rates_frd: Vec3 = _STILL) -> list[VehicleEvent]:
        """What is said now; called ten times a second with what the gyroscope shows."""
        found: list[VehicleEvent] = []
        running = self.running
        if running is not None:
            past_s = (time_ns - self._began_ns) * 1e-9
            if running.failed and self._moves(rates_frd) and past_s >= running.lasts_s:
                return self._again(running, time_ns)
            while self._said < len(running.lines) and running.lines[self._said].at_s <= past_s:
                line = running.lines[self._said]
                found.append(StatusText(line.severity, line.text))
                self._said += 1
            if not self._acked and running.acked_s is not None and past_s >= running.acked_s:
                self._acked = True
                found.append(CommandDone(PREFLIGHT_CALIBRATION, Result.ACCEPTED))
            if past_s >= running.lasts_s:
                self.running = None
                self._position = 1.0 if running.positions else 0.0
                self._asked_ns = time_ns - _ASKED_EVERY_NS
        if self._position > 0.0 and time_ns - self._asked_ns >= _ASKED_EVERY_NS:
            self._asked_ns = time_ns
            found.append(CommandSent(ACCELCAL_VEHICLE_POS, self._position))
        return found

    def _moves(self, rates_frd: Vec3) -> bool:
        """Whether the vehicle has moved since this try began."""
        if self._lowest == self._highest == _STILL:
            self._lowest = self._highest = rates_frd
        pairs = zip(self._lowest, self._highest, rates_frd, strict=True)
        bounds = [(min(low, rate), max(high, rate)) for low, high, rate in pairs]
        (a, d), (b, e), (c, f) = bounds
        self._lowest, self._highest = (a, b, c), (d, e, f)
        return any(high - low > _MOVES_RAD_S for low, high in bounds)

    def _again(self, running: Procedure, time_ns: int) -> list[VehicleEvent]:
        """Another try, until there were enough of them; what was left to say of this one first."""
        self._tries += 1
        last = [line for line in running.lines[self._said :] if line.at_s < running.lasts_s]
        found: list[VehicleEvent] = [StatusText(line.severity, line.text) for line in last]
        found.append(StatusText(2, "motion, retrying.."))
        if self._tries >= running.tries:
            self.running = None
            return [*found, *(StatusText(2, text) for text in running.failed)]
        self._began_ns, self._said = time_ns, 1
        self._lowest = self._highest = _STILL
        return found


def px4_procedure(parameters: tuple[float, ...]) -> Procedure | None:
    """The first that is asked for; None = a value that PX4 does not know, and does not answer."""
    return _first(_PX4, parameters)


def copter_procedure(parameters: tuple[float, ...]) -> Procedure | None:
    return _first(_COPTER, parameters)


def _first(
    known: dict[tuple[int, float], Procedure], parameters: tuple[float, ...]
) -> Procedure | None:
    for number, value in enumerate(parameters, start=1):
        if value != 0.0:
            return known.get((number, value))
    return None
