"""The end of a session, and of an operator's stay: the vehicle is seen safe first."""

from __future__ import annotations

from gcs import ipc, toml
from gcs.exit_codes import ExitCode
from gcs.gate import inputs as gate_inputs
from gcs.gate.effects import Level
from gcs.session.effects import Emit, Finish
from gcs.session.setup import Setup
from gcs.session.speedup_waits import Times
from gcs.session.work import ForOwner, GateInput, Log, Work
from gcs.station.operator_control import LEAVING_NS
from gcs.station.operators import Operators
from gcs.station.vehicles import Vehicles
from gcs.vehicle.vehicle import Vehicle

NODE = "link"


class Ending:
    """Whether the session is being left, and what is said at its end."""

    def __init__(
        self, setup: Setup, times: Times, vehicles: Vehicles, operators: Operators
    ) -> None:
        self._setup = setup
        self._times = times
        self._vehicles = vehicles
        self._operators = operators
        self._leaving_since_ns: int | None = None
        self._told_outside: set[int] = set()
        self.finished = False

    def begin(self, reason: str, now_ns: int) -> list[Work]:
        """Hold where we fly, wait until that is seen (at most 3 s), then finish."""
        if self._leaving_since_ns is not None:
            return []
        self._leaving_since_ns = now_ns
        self._vehicles.closed = True
        lost = gate_inputs.OperatorLost(reason)
        return [Log(Level.INFO, NODE, f"leaving: {reason}"), GateInput(lost)]

    @property
    def under_way(self) -> bool:
        """Somebody leaves, and waits for the vehicle or until a time: every datagram may tell."""
        return self._leaving_since_ns is not None or bool(self._operators.control.leaving)

    def if_due(self, log_path: str, now_ns: int) -> list[Work]:
        """The end of the session, where the start is refused or the vehicle may be left."""
        if self.finished:
            return []
        bad_home = self._vehicles.first.port.bad_home
        if bad_home is not None and len(self._vehicles) == 1:
            where = where_is(bad_home.zone, self._setup)
            text = f"{where}: home is outside: {bad_home.sentence}"
            hint = "the vehicle returns and lands there: a fence round it, or another --policy"
            trouble = Emit(ipc.Trouble(text, hint, ExitCode.BAD_FILE))
            return [trouble, *self.finish(ExitCode.BAD_FILE, text)]
        refusal = self._vehicles.first.port.bad_start
        if len(self._vehicles) > 1:
            outside = self._outside()
            if outside:
                return outside
        elif refusal is not None:
            where = where_is(refusal.zone, self._setup)
            text = f"{where}: the vehicle stands outside: {refusal.sentence}"
            hint = "fly from inside the fence, or give a policy for this place with --policy"
            trouble = Emit(ipc.Trouble(text, hint, ExitCode.REFUSED_BY_GATE))
            return [trouble, *self.finish(ExitCode.REFUSED_BY_GATE, text)]
        if self._leaving_since_ns is None:
            return self._farewells(log_path, now_ns) if self._operators.control.leaving else []
        overdue = now_ns - self._leaving_since_ns >= self._times.real_ns(LEAVING_NS)
        return self.finish(0, self._last_words()) if self._vehicles.settled or overdue else []

    def _outside(self) -> list[Work]:
        """Of several vehicles, those that stand outside the fence are told and stay where they
        are: every request is verified.  The others may fly on."""
        told: list[Work] = []
        for slot, vehicle in enumerate(self._vehicles):
            if vehicle.port.bad_start is not None and slot not in self._told_outside:
                self._told_outside.add(slot)
                text = f"it stands outside the fence: {vehicle.port.bad_start.sentence}"
                told.append(ForOwner(slot, (Log(Level.ERROR, NODE, text),)))
        return told

    def _farewells(self, log_path: str, now_ns: int) -> list[Work]:
        """To those who leave a station that lives on."""
        settled = self._vehicles.settled
        words = self._last_words() if settled else "the vehicle was not seen to hold yet"
        return self._operators.farewells(settled, words, log_path, now_ns)

    def finish(self, exit_code: int, sentence: str) -> list[Work]:
        """Now, with this exit code."""
        self.finished = True
        return [
            *self._vehicles.each(_end_requests),
            *self._vehicles.each(lambda each: each.leave()),
            Log(Level.INFO, NODE, sentence),
            *self._vehicles.each(lambda each: each.remind()),
            Finish(exit_code, sentence),
        ]

    def _last_words(self) -> str:
        if len(self._vehicles) == 1:
            return _last_words(self._vehicles.first, "the vehicle")
        return "; ".join(_last_words(each, f"vehicle {each.sysid}") for each in self._vehicles)


def _end_requests(vehicle: Vehicle) -> list[Work]:
    """A request that came while the station was being left, or that the gate waited for."""
    if vehicle.gate.memory.task is None:
        return []
    return [GateInput(gate_inputs.OperatorLost("the station ends"))]


def _last_words(vehicle: Vehicle, name: str) -> str:
    """How it is left."""
    telemetry = vehicle.telemetry
    if telemetry is None:
        return "no vehicle was heard"
    if not vehicle.gate.settled:
        return f"{name} was not seen to hold within {LEAVING_NS / 1e9:.0f} s"
    if vehicle.gate.memory.on_ground:
        return f"{name} is on the ground" + (", still ARMED" if telemetry.armed else "")
    height = "" if telemetry.pos_ned is None else f", {-telemetry.pos_ned[2]:.1f} m up"
    return f"{name} is STILL FLYING in {telemetry.mode_name}{height}"


def where_is(zone: str, setup: Setup) -> str:
    """Where a zone stands in its policy file, for errors that show only with a vehicle.

    Such as `yard.toml:4: fence[1]`, as errors of a policy are told; without line and number where
    the zone is none of the file's own tables.
    """
    file = setup.config.policy_path or setup.policy.name
    doc = toml.read(setup.policy_text, file)
    tables = doc.data.get("fence", [])
    assert isinstance(tables, list)
    for number, table in enumerate(tables):
        if table.get("name") == zone:
            line = doc.lines.get(("fence", number), 0)
            return f"{file}:{line}: fence[{number + 1}]"
    return f"{file}: fence"
