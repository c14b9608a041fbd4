"""One case becomes one row: the whole station and one vehicle, from its switching on to the end."""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from pathlib import Path

from gcs import __version__, ipc
from gcs.campaign.case import AIRBORNE, ERROR, GROUNDED, LANDED, LATE, Case, Row
from gcs.campaign.report_backend import ReportBackend
from gcs.campaign.simulators import Simulator, factory, truth_of
from gcs.campaign.truth import LOOK_NS, Looks, zones_about
from gcs.campaign.virtual_station import VirtualStation
from gcs.config import StationConfig
from gcs.flight_report.findings.finding import Level
from gcs.gate.geometry import TOLERANCE_M
from gcs.gate.policy.zonespec import ZoneSpec
from gcs.operator.client import Polled, Readable
from gcs.operator.console.line_queue import ScriptLines
from gcs.operator.console.plain import Plain, PlainConfig
from gcs.operator.errors import ExitError
from gcs.plan.formats.reader import read
from gcs.plan.zones import zone_specs
from gcs.record.writer import Recorder
from gcs.session.setup import Setup
from gcs.shell.environment import environment
from gcs.station.session import Session

START_NS = 1_700_000_000_000_000_000
STAMP = "20231114-221320"
"""`START_NS` as the names of records have it."""
VEHICLE_WAIT_S = 60.0


def fly(case: Case, record: Path | None = None, simulator: Simulator | None = None) -> Row:
    """Fly it, on `simulator` where one is made already.  With `record` it is recorded there, which
    changes nothing of the row.

    A bug, ours or the simulator's, is an outcome of this flight and of no other.
    """
    try:
        return _Flight(case, record, simulator).row()
    except Exception:  # noqa: BLE001 - the last resort: one bug must not end thousands of flights
        return Row(
            id=case.id, inputs=case.inputs, outcome=ERROR, error=traceback.format_exc(limit=-6)
        )


def own_zones(case: Case) -> tuple[ZoneSpec, ...]:
    """The fences of the mission files that the task names."""
    plans = (read(name, data) for name, data in case.task.files.items())
    return tuple(zone for plan in plans for zone in zone_specs(plan.fence))


class _TimeLimit:
    """Ends a flight as a Ctrl-C does that comes at its time: the vehicle is held."""

    def __init__(self, limit_ns: int) -> None:
        self._limit_ns: float = limit_ns
        self.name = ""
        self.was_met = False

    def fileno(self) -> int:
        return -1

    def forget(self) -> None:
        self.name = ""

    def pass_time(self, now_ns: int) -> None:
        if now_ns >= self._limit_ns:
            self.name, self.was_met, self._limit_ns = "the time is over", True, float("inf")


class _Flight:
    def __init__(self, case: Case, record: Path | None, simulator: Simulator | None) -> None:
        self._case = case
        self._simulator = simulator or factory(case.simulator)({**case.table, "start_ns": START_NS})
        policy = case.rules.policy
        truth = truth_of(self._simulator)
        autopilot = str(case.table.get("autopilot", ""))
        zones = zones_about(truth.home, policy, autopilot, own_zones(case))
        self._looks = Looks(zones, START_NS)
        self._look_ns = START_NS
        self._limit = _TimeLimit(START_NS + round(case.timeout_s * 1e9))
        self._backend = ReportBackend(to_file=record is not None)
        self._record = record
        self._recorder = _recorder(self._backend, record)
        config = StationConfig(endpoints=["virtual"], name="campaign", policy_path=case.rules.name)
        setup = Setup(
            config,
            __version__,
            policy,
            case.rules.text,
            ("a simulator on a virtual clock",),
            "",
            environment=environment(),
        )
        self._station = VirtualStation(
            Session(setup, START_NS),
            self._simulator,
            self._recorder,
            START_NS,
            case.task.files,
            self._time_passed,
        )
        self._out: list[str] = []
        self._err: list[str] = []

    def _time_passed(self, now_ns: int) -> None:
        self._limit.pass_time(now_ns)
        if now_ns >= self._look_ns:
            self._look_ns = now_ns + LOOK_NS
            self._looks.look(truth_of(self._simulator), now_ns)

    def row(self) -> Row:
        counts = _Counts(self._station)
        console = Plain(
            counts,
            self._limit,
            PlainConfig(timeout_s=VEHICLE_WAIT_S, strict=True, simulated=True),
            self._out.append,
            self._err.append,
        )
        error = ""
        try:
            code = console.run(ScriptLines(self._case.task.lines, self._case.task.name))
        except ExitError as problem:
            code, error = problem.exit_code, str(problem)
        looks, end_ns = self._looks, self._station.now_ns
        looks.look(truth_of(self._simulator), end_ns)
        self._recorder.close(end_ns)
        if self._record is not None:
            self._recorder.path.replace(self._record)
        went_wrong = self._backend.went_wrong()
        near, last = looks.nearest, truth_of(self._simulator)
        landed = looks.flew and last.landed
        began_s = looks.armed_s or 0.0
        end_s = looks.down_s if landed and looks.down_s else (end_ns - START_NS) / 1e9
        north, east, _ = last.pos_ned
        return Row(
            id=self._case.id,
            inputs=self._case.inputs,
            outcome=self._outcome(landed, error),
            breach=near.clear_m < -TOLERANCE_M,
            closest_m=near.clear_m if looks.flew else None,
            closest_of=near.of,
            closest_at_s=near.at_s if looks.flew else None,
            max_up_m=looks.max_up_m,
            max_distance_m=looks.max_distance_m,
            max_speed_m_s=looks.max_speed_m_s,
            touchdown_m_s=looks.touchdown_m_s,
            flight_s=end_s - began_s if looks.flew else 0.0,
            energy_wh=None if last.energy_j is None else last.energy_j / 3600.0,
            landed_east_m=east if landed else None,
            landed_north_m=north if landed else None,
            accepted=counts.accepted,
            refused=counts.refused,
            undone=counts.undone,
            warnings=sum(each.level is Level.WARNING for each in went_wrong),
            critical=sum(each.level is Level.CRITICAL for each in went_wrong),
            findings="; ".join(dict.fromkeys(each.title for each in went_wrong)),
            answers="\n".join(self._out),
            exit_code=int(code),
            digest=self._station.digest,
            error=error,
        )

    def _outcome(self, landed: bool, error: str) -> str:
        if error:
            return ERROR
        if self._limit.was_met:
            return LATE
        if not self._looks.flew:
            return GROUNDED
        return LANDED if landed else AIRBORNE


class _Counts:
    """The way to the station; counts what it answers."""

    def __init__(self, station: VirtualStation) -> None:
        self._station = station
        self.accepted = self.refused = self.undone = 0
        self.send, self.now_s, self.close = station.send, station.now_s, station.close

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        polled = self._station.poll(timeout_s, also)
        for event in polled.events:
            match event:
                case ipc.VerdictEvent(outcome="accepted"):
                    self.accepted += 1
                case ipc.VerdictEvent(outcome="refused"):
                    self.refused += 1
                case ipc.EndingEvent(ended=ended):
                    self.undone += ended != "complete"
                case _:
                    pass
        return polled


def _recorder(backend: ReportBackend, record: Path | None) -> Recorder:
    """What is recorded goes to the report at any rate: the times of a flight depend on it."""
    if record is None:
        return Recorder.without_file(backend, START_NS)
    return Recorder.open(record.parent, record.stem, STAMP, START_NS, backend=backend, sealed=True)
