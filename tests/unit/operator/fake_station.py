"""A small scripted station that speaks `gcs.ipc`: a point that flies, and a gate of four rules.

`FakeStation` is pure and runs on the time it is given.  `FakeConnection` puts it in place of a
`StationClient` on a virtual clock.  Run as a program it takes the place of `gcs.shell.station`:
the `name` in its configuration chooses the scenario (see `SCENARIOS`).
"""

from __future__ import annotations

import math
import os
import select
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import msgspec

from gcs import config, ipc
from gcs.operator.client import Polled, Readable, StationEnded, StationEvent

TICK_S = 0.1
SPEED_M_S = 2.0
PHOTO_S = 2.0
UPLOAD_S = 1.0
FENCE_M = 150.0
MISSION = ((2.0, 0.0, 2.0), (2.0, 2.0, 2.0), (0.0, 0.0, 2.0))
FREE = ("HOVERING",)
LANDED_KNOWN_S = 1.0
SCENARIOS = ("flight", "airborne", "silent", "late landed", "slow upload", "port in use", "crash")


FIRST = ipc.OperatorInfo(1, "gcs fly, pid 4710")


@dataclass
class FakeStation:
    """States carry the gate's names; every accepted request ends exactly once."""

    scenario: str = "flight"
    state: str = "GROUNDED"
    armed: bool = False
    control: str = "NONE"
    pos: ipc.Vec3 = (0.0, 0.0, 0.0)
    target: ipc.Vec3 | None = None
    mission: tuple[ipc.Vec3, ...] = ()
    left: list[ipc.Vec3] = field(default_factory=list)
    current: ipc.Ask | None = None
    photo_until_s: float = 0.0
    upload: ipc.Ask | None = None
    upload_until_s: float = 0.0
    done: bool = False
    time_s: float = 0.0
    in_control: ipc.OperatorInfo | None = FIRST
    stream_told: str = ""
    shown: int = 1
    """The system id of the vehicle that is told of; all of them fly alike."""
    others: list[ipc.OtherVehicle] = field(default_factory=list)
    refusals: dict[ipc.Vec3, tuple[str, str]] = field(default_factory=dict)
    """Goals that are refused, with code and sentence."""
    preflight_rows: list[ipc.PreflightRow] = field(default_factory=list)
    """Beside one that passes and a caution."""
    client: int = 1
    """The number of the operator who talks with it; 1 has started it."""

    def hello(self) -> list[ipc.Event]:
        fence = ipc.FenceShape(
            "circle", True, centre_en=(0.0, 0.0), radius_m=FENCE_M, ceiling_up_m=50.0
        )
        if self.scenario == "port in use":
            self.done = True
            text = "udpin://127.0.0.1:14550: address in use"
            return [ipc.Trouble(text, "close the other station", 9), ipc.Bye(9, "", text)]
        if self.scenario == "airborne":
            self.state, self.armed, self.pos = "EXTERNAL", True, (1.0, 1.0, 2.0)
        return [
            ipc.Hello(
                "0.1.0",
                "logs/x.mcap",
                ["udpin://127.0.0.1:14550"],
                "default",
                [fence],
                client=self.client,
            ),
            self._log("link: up"),
        ]

    def handle(self, command: ipc.Command, now_s: float) -> list[ipc.Event]:
        match command:
            case ipc.Leave(reason):
                self.done = True
                self.state = "HOLDING" if self.pos[2] > 0.1 else self.state
                return [*self._end("aborted", "OPERATOR"), ipc.Bye(0, "logs/x.mcap", reason)]
            case ipc.Pending(goal_enu):
                return [self._log(f"Keyboard: {goal_enu}")]
            case ipc.Ask():
                return self._asked(command, now_s)
            case ipc.Show(sysid):
                self.shown = sysid
                return [self.snapshot(), ipc.History([], [])]
            case ipc.Stream(v_enu=v_enu):
                return self._streamed(v_enu)
            case ipc.Check(asked):
                east, north, up = (metres or 0.0 for metres in asked.goal_enu or (0.0, 0.0, 0.0))
                code, sentence = self.refusals.get((east, north, up), ("", ""))
                outcome = "refused" if code else "accepted"
                told = ipc.Checked(asked.id, asked.word, outcome, code, sentence, goal_code=code)
                return [msgspec.structs.replace(told, goal_sentence=sentence)]
            case ipc.Preflight(number):
                rows = [
                    ipc.PreflightRow("gps", "pass", "3D fix, 10 satellites"),
                    ipc.PreflightRow(
                        "failsafes", "caution", "off", ["gcs param set NAV_DLL_ACT 2"]
                    ),
                    *self.preflight_rows,
                ]
                return [ipc.PreflightReport(number, rows, 1)]
            case ipc.Join() | ipc.Subscribe() | ipc.ListOperations() | ipc.WatchTopics():
                return []
            case ipc.Renew() | ipc.Note():
                return []

    def tick(self, now_s: float) -> list[ipc.Event]:
        self.time_s = now_s
        events: list[ipc.Event] = []
        if self.state == "TAKING_PICTURE" and now_s >= self.photo_until_s:
            events += [*self._to("HOVERING", "photo"), *self._end("complete")]
        if self.upload is not None and now_s >= self.upload_until_s:
            events.append(ipc.EndingEvent(self.upload.id, self.upload.word, "complete"))
            self.upload = None
        if self.target is not None:
            self._move(self.target)
            if self.pos == self.target:
                events += self._arrive()
        return [*events, self.snapshot()]

    def _asked(self, ask: ipc.Ask, now_s: float) -> list[ipc.Event]:
        if ask.word in ("abort", "hold"):
            events = self._end("aborted", "OPERATOR")
            self.target, self.left = None, []
            return [*events, *self._quick(ask, "HOLDING" if self.pos[2] > 0.1 else self.state)]
        if self._landed() == "UNDEFINED":
            return self._refuse(ask, "IN_AIR", "not known to stand on the ground")
        if ask.word in ("arm", "disarm"):
            self.armed = ask.word == "arm"
            return self._quick(ask, self.state)
        if ask.word in ("control", "resume"):
            self.control = "OURS"
            return self._quick(ask, "HOVERING")
        if ask.word == "mission_upload":
            self.mission = MISSION
            if self.scenario == "slow upload":
                self.upload, self.upload_until_s = ask, now_s + UPLOAD_S
                return [ipc.VerdictEvent(ask.id, ask.word, "accepted")]
            return self._quick(ask, self.state, ipc.ProgressEvent(ask.id, "upload", 3, 3, "items"))
        if ask.word in (
            "mission_download",
            "mission_clear",
            "fence_upload",
            "fence_download",
            "fence_clear",
            "fence_put",
            "rally_upload",
            "rally_download",
            "rally_clear",
            "mission_set_current",
            "mode",
            "fence",
        ):
            return self._quick(ask, self.state)
        return self._motion(ask, now_s)

    def _streamed(self, v_enu: ipc.Maybe3 | None) -> list[ipc.Event]:
        """A sample: faster than 10 m/s is refused, and told where that changes."""
        if self.state != "STREAMING" or v_enu is None:
            return []
        told = "refused" if math.hypot(*(v or 0.0 for v in v_enu)) > 10.0 else "accepted"
        if told == self.stream_told:
            return []
        self.stream_told = told
        reason = ("POLICY", "too fast") if told == "refused" else ("", "")
        return [ipc.StreamVerdictEvent(told, *reason)]

    def _motion(self, ask: ipc.Ask, now_s: float) -> list[ipc.Event]:
        if ask.word == "stream_end":
            ended = self._end("complete") if self.state == "STREAMING" else []
            return [*ended, *self._quick(ask, "HOVERING")]
        goal = ask.goal_enu
        if goal is not None and any(metres is None for metres in goal):
            return self._refuse(ask, "NON_FINITE", "the goal is not a number")
        if ask.word == "takeoff":
            if not self.armed:
                return self._refuse(ask, "NOT_ARMED", "the vehicle is not armed")
            self.control = "OURS"
            return self._begin(ask, "TAKING_OFF", (*self.pos[:2], ask.up_m or 0.0))
        if ask.word in ("land", "rtl"):
            ended = self._end("superseded")
            return [*ended, *self._begin(ask, "LANDING", (*self.pos[:2], 0.0))]
        if self.state in ("HOLDING", "EXTERNAL"):
            code = "HOLDING" if self.state == "HOLDING" else "NOT_IN_CONTROL"
            return self._refuse(ask, code, f"the vehicle is {self.state}")
        if self.state not in FREE:
            return self._refuse(ask, "BUSY", f"the vehicle is {self.state}")
        if ask.word == "stream_begin":
            self.stream_told = ""
            return self._begin(ask, "STREAMING", None)
        if ask.word == "orbit":
            return self._begin(ask, "STREAMING", None)
        if ask.word == "photo":
            self.photo_until_s = now_s + PHOTO_S
            return self._begin(ask, "TAKING_PICTURE", None)
        if ask.word == "mission_start":
            self.left = list(self.mission)
            return self._begin(ask, "FLYING_MISSION", self.left.pop(0))
        assert goal is not None
        east, north, up = (metres or 0.0 for metres in goal)
        if (east, north, up) in self.refusals:
            return self._refuse(ask, *self.refusals[east, north, up])
        if math.hypot(east, north) > FENCE_M:
            distance_m = math.hypot(east, north) - FENCE_M
            sentence = f"{distance_m:.0f} m outside the fence `circle`"
            return self._refuse(ask, "OUTSIDE_FENCE", sentence)
        return self._begin(ask, "MOVING", (east, north, up))

    def _begin(self, ask: ipc.Ask, state: str, target: ipc.Vec3 | None) -> list[ipc.Event]:
        self.current, self.target = ask, target
        accepted = ipc.VerdictEvent(ask.id, ask.word, "accepted", goal_enu=ask.goal_enu)
        return [accepted, *self._to(state, ask.word)]

    def _quick(self, ask: ipc.Ask, state: str, *between: ipc.Event) -> list[ipc.Event]:
        return [
            ipc.VerdictEvent(ask.id, ask.word, "accepted"),
            *between,
            *self._to(state, ask.word),
            ipc.EndingEvent(ask.id, ask.word, "complete"),
        ]

    def _refuse(self, ask: ipc.Ask, code: str, sentence: str) -> list[ipc.Event]:
        goal = ask.goal_enu
        return [
            ipc.VerdictEvent(ask.id, ask.word, "refused", code, sentence, goal_enu=goal),
            self._log(f"Refused ({code}): {sentence}", 3),
        ]

    def _end(self, how: str, code: str = "") -> list[ipc.Event]:
        if self.current is None:
            return []
        ask, self.current = self.current, None
        return [ipc.EndingEvent(ask.id, ask.word, how, code)]

    def _to(self, state: str, event: str) -> list[ipc.Event]:
        if state == self.state:
            return []
        before, self.state = self.state, state
        return [
            ipc.StateEvent(before, state, event, self.control, "NOMINAL"),
            self._log(f"Current State: {state}"),
        ]

    def _arrive(self) -> list[ipc.Event]:
        if self.left:
            self.target = self.left.pop(0)
            return []
        self.target = None
        landed = self.state == "LANDING"
        self.armed = self.armed and not landed
        return [*self._to("GROUNDED" if landed else "HOVERING", "there"), *self._end("complete")]

    def _move(self, target: ipc.Vec3) -> None:
        away_m = math.dist(self.pos, target)
        step = min(1.0, SPEED_M_S * TICK_S / away_m) if away_m else 1.0
        if step == 1.0:
            self.pos = target
            return
        moved = [here + step * (there - here) for here, there in zip(self.pos, target, strict=True)]
        self.pos = (moved[0], moved[1], moved[2])

    def _log(self, text: str, level: int = 2) -> ipc.LogEvent:
        return ipc.LogEvent(0, level, "gate", text)

    def _landed(self) -> str:
        if self.scenario == "late landed" and self.time_s < LANDED_KNOWN_S:
            return "UNDEFINED"
        return "IN_AIR" if self.pos[2] > 0.1 else "ON_GROUND"

    def snapshot(self) -> ipc.Snapshot:
        heard = self.scenario != "silent"
        return ipc.Snapshot(
            time_ns=int(self.time_s * 1e9),
            state=self.state if heard else "NO_VEHICLE",
            control=self.control,
            severity="NOMINAL",
            conditions=[],
            vehicle=f"{self.shown}/1 px4 quadrotor" if heard else "",
            mode="OFFBOARD" if self.control == "OURS" else "AUTO.LOITER",
            armed=self.armed if heard else None,
            landed=self._landed(),
            pos_enu=self.pos if heard else None,
            v_enu=(0.0, 0.0, 0.0),
            yaw_deg=30.0,
            position_age_s=0.02,
            active_goal_enu=self.target,
            home_enu=(0.0, 0.0, 0.0),
            battery_pct=98.0,
            battery_v=16.4,
            heartbeat_age_s=0.4,
            rx_hz=120.0,
            lost_pct=0.0,
            setpoint_hz=20.0 if self.control == "OURS" else 0.0,
            mission_seq=None,
            mission_total=len(self.mission) or None,
            log_path="logs/x.mcap",
            recording=True,
            recorded_mb=1.2,
            in_control=self.in_control,
            others=[each for each in self.others if each.vehicle != self.shown],
        )


class FakeConnection:
    """In place of a `StationClient`: each poll advances a virtual clock to the next tick."""

    def __init__(self, station: FakeStation | None = None) -> None:
        self.station = station or FakeStation()
        self.sent: list[ipc.Command] = []
        self.asked_at_s: list[float] = []
        self.time_s = 0.0
        self.closed = False
        self._events: list[StationEvent] = list(self.station.hello())

    def now_s(self) -> float:
        return self.time_s

    def send(self, command: ipc.Command) -> bool:
        wire = ipc.decode_command(ipc.encode(command))
        self.sent.append(wire)
        if isinstance(wire, ipc.Ask):
            self.asked_at_s.append(self.time_s)
        self._events.extend(self.station.handle(wire, self.time_s))
        return not self.station.done

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        files = [source for source in also if source.fileno() >= 0]
        ready = select.select(files, [], [], 0.0)[0] if files else []
        if not self._events and not ready:
            self.time_s += TICK_S
            self._events.extend(self._ended_or_tick())
        events, self._events = self._events, []
        return Polled(events, ready)

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        raise AssertionError("this one is polled")

    def close(self) -> StationEnded:
        self.closed = True
        return self._ended()

    def _ended_or_tick(self) -> Sequence[StationEvent]:
        return [self._ended()] if self.station.done else self.station.tick(self.time_s)

    def _ended(self) -> StationEnded:
        return StationEnded(ipc.Bye(0, "logs/x.mcap", "left"), 0, "")


class NoInterrupts:
    """Nobody presses Ctrl-C, unless `name` is set."""

    def __init__(self) -> None:
        self.name = ""

    def fileno(self) -> int:
        return -1

    def forget(self) -> None:
        self.name = ""


def main() -> None:
    """In place of `python -m gcs.shell.station`, in real time."""
    setup = config.decode(sys.argv[1])
    station = FakeStation(setup.name)
    sys.stdout.buffer.write(b"".join(map(ipc.encode, station.hello())))
    rest = b""
    start_s = next_s = time.monotonic()
    while not station.done:
        sys.stdout.buffer.flush()
        now_s = (time.monotonic() - start_s) * setup.speedup
        ready, _, _ = select.select([0], [], [], max(0.0, next_s - time.monotonic()))
        events: list[ipc.Event] = []
        if ready:
            data = os.read(0, 65536)
            if not data:
                return
            *lines, rest = (rest + data).split(b"\n")
            for line in lines:
                events += station.handle(ipc.decode_command(line), now_s)
        if time.monotonic() >= next_s:
            next_s += TICK_S / setup.speedup
            events += station.tick(now_s)
        if station.scenario == "crash" and now_s > 0.3:
            sys.exit("fake station: planted failure")
        sys.stdout.buffer.write(b"".join(map(ipc.encode, events)))
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
