"""When a flight is logged and what of it: from arming to disarming, on the vehicle's own time,
unless a parameter (SDLOG_MODE; LOG_DISARMED, LOG_BACKEND_TYPE) says more or nothing.

    GROUNDED --armed--> LOGGING --disarmed--> GROUNDED
                        |     '--the store fails--> FULL --disarmed--> GROUNDED
                        '--LOG_BYTES_MAX reached: on in a new log

A sample is due at the multiples of `SAMPLE_NS`; a status that changes is written at once.  Equal
flights give equal bytes: the date comes from `unix_start_ns` and the vehicle's time.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import StatusText, Vehicle, VehicleEvent
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Effect, Note
from vehicle_sim.flight_log.log_directory import LOG_BYTES_MAX, LogDirectory, LogFile
from vehicle_sim.flight_log.snapshot import Format, Head, Parameter, Snapshot, VehicleStatus
from vehicle_sim.storage.store import StoreError

SAMPLE_NS: Final = 100_000_000
FLUSH_BYTES: Final = 8192
NEVER: Final = 1 << 62
_ARMED, _UNTIL_DISARMED, _ALWAYS = 0, 1, 2  # SDLOG_MODE; -1 is never


def _px4_format() -> Format:
    from vehicle_sim.flight_log.px4 import Px4Format

    return Px4Format()


def _copter_format() -> Format:
    from vehicle_sim.flight_log.ardupilot import ArdupilotFormat

    return ArdupilotFormat()


_FORMATS: Final[dict[Personality, Callable[[], Format]]] = {
    "px4": _px4_format,
    "ardupilot": _copter_format,
}
"""A writer of logs is loaded with the first log."""


def _px4_wants(parameters: Parameters, armed: bool, has_armed: bool) -> bool:
    mode = parameters.get("SDLOG_MODE")
    if mode == _UNTIL_DISARMED:
        return armed or not has_armed
    return mode == _ALWAYS or (armed and mode == _ARMED)


def _copter_wants(parameters: Parameters, armed: bool, has_armed: bool) -> bool:
    get = parameters.get
    return get("LOG_BACKEND_TYPE") != 0 and (armed or get("LOG_DISARMED") != 0)


_WANTED: Final[dict[Personality, Callable[[Parameters, bool, bool], bool]]] = {
    "px4": _px4_wants,
    "ardupilot": _copter_wants,
}
"""Whether there is to be a log, by whether the vehicle is armed, and has been since power-up."""


@dataclass(slots=True)
class _Log:
    """The log being written."""

    path: str
    form: Format
    status: VehicleStatus
    armed_us: int
    parameters: dict[str, Parameter]
    version: int  # of the parameters
    buffer: bytearray
    size: int = 0
    turn: int = 0
    due_ns: int = 0


class Recorder:
    """One vehicle's flight recorder.

    `enabled=False`: nothing is ever written (for fleets in which nobody reads logs).
    """

    def __init__(
        self,
        vehicle: Vehicle,
        parameters: Parameters,
        shelf: LogDirectory,
        head: tuple[int, int],
        unix_start_ns: int = 0,
        enabled: bool = True,
    ) -> None:
        """`head`: system id and AUTOPILOT_VERSION.flight_sw_version."""
        self._vehicle = vehicle
        self._parameters = parameters
        self._shelf = shelf
        self._system, self._version = head
        self._unix_start_ns = unix_start_ns
        self._enabled = enabled
        self._log: _Log | None = None
        self._armed_us: int | None = None
        self._full = False
        self._has_armed = False
        self._opened: str | None = None

    @property
    def _wanted(self) -> bool:
        """Whether there is to be a log now."""
        wanted = _WANTED[self._parameters.personality]
        return wanted(self._parameters, self._vehicle.armed, self._has_armed)

    @property
    def due_ns(self) -> int:
        """When `step` is wanted next, in the vehicle's time; a change of status needs none."""
        if self._log is not None:
            return self._log.due_ns
        waiting = self._enabled and self._wanted and not self._full
        return self._vehicle.time_ns if waiting else NEVER

    def step(self, events: Sequence[VehicleEvent]) -> list[Effect]:
        """After each step of the vehicle, with what happened in it."""
        vehicle = self._vehicle
        self._has_armed = self._has_armed or vehicle.armed
        wanted = self._wanted
        if not wanted and self._log is None:
            self._armed_us, self._full = None, False
            return []
        if not self._enabled or self._full:
            return []
        try:
            self._record(events, wanted)
        except StoreError as error:
            self._log, self._full = None, True
            return [Note("warning", f"the flight log ends here: {error}")]
        return []

    def opened(self) -> str | None:
        """The path of the log that was opened since this was asked last."""
        path, self._opened = self._opened, None
        return path

    def flush(self) -> None:
        """What is buffered becomes readable.  Raises `StoreError`."""
        log = self._log
        if log is not None and log.buffer:
            self._shelf.append(log.path, bytes(log.buffer), self._unix_us() // 1_000_000)
            log.buffer.clear()

    def logs(self) -> tuple[LogFile, ...]:
        """Oldest first; the one being written up to now.  Raises `StoreError`."""
        self.flush()
        return self._shelf.logs()

    def read(self, path: str, offset: int, count: int) -> bytes:
        """Raises `StoreError`."""
        return self._shelf.read(path, offset, count)

    def erase(self) -> None:
        """Every log; one that is being written goes on in a new file.  Raises `StoreError`."""
        self._log, self._full = None, False
        for log in self._shelf.logs():
            self._shelf.remove(log.path)

    def _record(self, events: Sequence[VehicleEvent], wanted: bool) -> None:
        vehicle = self._vehicle
        time_ns = vehicle.time_ns
        time_us = time_ns // 1000
        if self._armed_us is None:
            self._armed_us = time_us
        log = self._log
        if log is None:
            log = self._begin(self._armed_us)
            self._opened = log.path
        for event in events:
            if isinstance(event, StatusText):
                log.buffer += log.form.text(time_us, event.severity, event.text)
        due = time_ns >= log.due_ns
        # The rest of the status is looked at with each sample: home costs a projection.
        was = log.status
        if due or vehicle.armed is not was.armed or vehicle.custom_mode != was.custom_mode:
            status = self._status()
            if status != log.status:
                log.buffer += log.form.change(self._snapshot(status, log.armed_us), log.status)
                log.status = status
        if due:
            self._sample(log)
        if not wanted:
            self.flush()
            self._log = self._armed_us = None
        elif len(log.buffer) >= FLUSH_BYTES:
            log.size += len(log.buffer)
            self.flush()
            if log.size >= LOG_BYTES_MAX:
                self._begin(log.armed_us)

    def _begin(self, armed_us: int) -> _Log:
        status = self._status()
        now = self._snapshot(status, armed_us)
        form = _FORMATS[self._parameters.personality]()
        parameters = self._read_parameters()
        dt_us = max(1, self._vehicle.dt_ns // 1000)
        head = Head(self._system, self._version, dt_us, tuple(parameters.values()))
        path = self._shelf.begin(self._unix_us() // 1_000_000)
        buffer = bytearray(form.head(head, now))
        version = self._parameters.version
        self._log = _Log(path, form, status, armed_us, parameters, version, buffer)
        return self._log

    def _sample(self, log: _Log) -> None:
        if self._parameters.version != log.version:
            log.version = self._parameters.version
            fresh = self._read_parameters()
            for name, parameter in fresh.items():
                if parameter != log.parameters.get(name):
                    log.buffer += log.form.parameter(self._vehicle.time_ns // 1000, parameter)
            log.parameters = fresh
        log.buffer += log.form.sample(self._snapshot(log.status, log.armed_us), log.turn)
        log.turn += 1
        log.due_ns = (self._vehicle.time_ns // SAMPLE_NS + 1) * SAMPLE_NS

    def _read_parameters(self) -> dict[str, Parameter]:
        parameters = self._parameters
        return {
            spec.name: Parameter(
                spec.name,
                parameters.value(spec.name),
                _float32(parameters.default(spec.name)),
                spec.integer,
            )
            for spec in parameters.specs
        }

    def _status(self) -> VehicleStatus:
        vehicle = self._vehicle
        return VehicleStatus(
            vehicle.armed,
            vehicle.custom_mode,
            vehicle.landed,
            vehicle.system_status,
            vehicle.origin,
            vehicle.home,
        )

    def _snapshot(self, status: VehicleStatus, armed_us: int) -> Snapshot:
        vehicle = self._vehicle
        return Snapshot(
            time_us=vehicle.time_ns // 1000,
            unix_us=self._unix_us() if self._unix_start_ns else 0,
            armed_us=armed_us,
            status=status,
            home_pos_ned=vehicle.home_pos_ned,
            estimate=vehicle.estimate,
            health=vehicle.health,
            readings=vehicle.readings,
            target=vehicle.target,
            attitude_goal=vehicle.attitude_goal,
            power=vehicle.power,
            motor_outputs=vehicle.motor_outputs,
        )

    def _unix_us(self) -> int:
        return (self._unix_start_ns + self._vehicle.time_ns) // 1000


def _float32(value: float) -> float:
    """As a parameter is stored; every default is within a float32's range."""
    return float(struct.unpack("<f", struct.pack("<f", value))[0])
