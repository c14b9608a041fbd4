"""The whole ground station against the whole vehicle, in one process, on a virtual clock.

A `Flight` is what a test's script is written in: `say` a request, `run` for some seconds, look at
verdicts, endings, states, and at the bytes that were on the wire.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Literal

import msgspec

from gcs import ipc
from gcs.config import StationConfig
from gcs.frames import Vec3
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.record.writer import Recorder
from gcs.resources import policy_path
from gcs.session import effects, inputs
from gcs.session.setup import Setup
from gcs.station.session import Session
from gcs.station.signatures import Keys
from gcs.wire.frame import Frame, split
from gcs.wire.signing import SecretKey
from tests.loopback import pymavlink_decoder
from tests.loopback.lossy_link import CLEAR, Air, Weather
from tests.loopback.observed import START_NS, Looks, Sent
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram as Inbound
from vehicle_sim.simulation.world import LinkSpec, SigningKey, Transmit, World
from vehicle_sim.simulation.world import Wake as WorldWake

Personality = Literal["px4", "ardupilot"]
PERSONALITIES: tuple[Personality, ...] = ("px4", "ardupilot")
HOMES: dict[Personality, Geodetic] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}
PEER = "ground station"
WAKE, WORLD_WAKE = inputs.Wake(), WorldWake()
MISSIONS = Path(__file__).parents[2] / "missions"


def lab_policy() -> Policy:
    """The lab-compatible policy, as shipped."""
    path = policy_path("lab")
    return parse_policy(path.read_text(encoding="utf-8"), str(path))


POLICIES = {"lab": lab_policy(), "default": DEFAULT}


CONFIG = StationConfig(endpoints=["test"], name="loopback")


class Flight(Looks):
    """One session, one vehicle, one link, one clock."""

    def new_recorder(self) -> Recorder | None:
        """What this flight is recorded with, if it is: for tests to replace."""
        return None

    def __init__(
        self,
        personality: Personality = "px4",
        *,
        seed: int = 1,
        policy: Policy = DEFAULT,
        up: Weather = CLEAR,
        down: Weather = CLEAR,
        params: dict[str, float] | None = None,
        param_file: dict[str, float] | None = None,
        firmware: Firmware | None = None,
        boot: Boot = "quick",
        config: StationConfig = CONFIG,
        vehicle_key: bytes | None = None,
        station_key: bytes | None = None,
        client_key: bytes | None = None,
        operator_control: bool = False,
    ) -> None:
        """`up` is the weather towards the vehicle, `down` towards the ground station; the keys are
        what either side signs with."""
        super().__init__()
        self.personality = personality
        self.policy = policy
        kept = param_file or {}
        parameters = self.parameters = Parameters(personality, firmware, kept)
        for name, value in {**kept, **(params or {})}.items():
            parameters.set(name, value)
        self.vehicle = Autopilot(
            personality, HOMES[personality], seed, params=parameters, boot=boot
        )
        profile = profile_of(personality, parameters.firmware)
        server = VehicleServer(
            self.vehicle, profile, parameters, 1, operator_control=operator_control
        )
        signing = None if vehicle_key is None else SigningKey(vehicle_key)
        links = [LinkSpec((PEER,))]
        self.world = World(
            [server], links, Fraction(1), START_NS, signing=signing, unix_start_ns=START_NS
        )
        if station_key is not None:
            config = msgspec.structs.replace(config, vehicle_key_path="vehicle.key")
        if client_key is not None:
            config = msgspec.structs.replace(config, client_key_path="client.key")
        setup = Setup(config, "test", policy, "", ("a simulated link",), "")
        keys = Keys(
            vehicle=None if station_key is None else SecretKey(station_key),
            client=None if client_key is None else SecretKey(client_key),
        )
        self.session = Session(setup, START_NS, keys)
        self.recorder = self.new_recorder()
        self.up, self.down = Air(up, 2 * seed), Air(down, 2 * seed + 1)
        self.finish: effects.Finish | None = None
        self.files: dict[str, bytes] = {}
        self.rule: Callable[[effects.AskRule], list[inputs.Input]] = lambda _: []
        self.vehicle_silent = False
        self.positions_lost = False
        self.heartbeats_lost = False
        self.attitudes_lost = False
        self.last_id = 0
        self._forged = 0

    def restart(
        self, params: dict[str, float] | None = None, personality: Personality | None = None
    ) -> None:
        """The vehicle is switched off and on; or another one, with its number, in its place."""
        personality = personality or self.personality
        parameters = Parameters(personality)
        for name, value in (params or {}).items():
            parameters.set(name, value)
        self.vehicle = Autopilot(personality, HOMES[personality], 1, params=parameters)
        profile = profile_of(personality, parameters.firmware)
        server = VehicleServer(self.vehicle, profile, parameters, 1)
        self.world = World(
            [server], [LinkSpec((PEER,))], Fraction(1), self.now_ns, unix_start_ns=self.now_ns
        )

    # ------------------------------------------------------------------------------- time

    def flown_by_hand(self) -> None:
        """A pilot takes the vehicle over; PX4 enters the mode only while there are sticks."""
        if self.personality == "px4":
            self.vehicle.parameters.set("NAV_RCL_ACT", 0)  # and stays in it when they are silent
            self.vehicle.joystick(0, 0, 500, 0, self.now_ns)
        self.vehicle.set_mode_kind("position")

    def run(self, seconds: float) -> None:
        """Let time pass."""
        until_ns = self.now_ns + round(seconds * 1e9)
        while self.finish is None and self._step(until_ns):
            pass
        self.now_ns = until_ns

    def until(self, true: Callable[[], bool], timeout_s: float = 30.0) -> None:
        """Let time pass until `true()`; fails the test when that does not come in time."""
        limit_ns = self.now_ns + round(timeout_s * 1e9)
        while not true():
            if not self._step(limit_ns):
                raise AssertionError(f"not within {timeout_s} s: {self.told()}")

    def _step(self, limit_ns: int) -> bool:
        """To the next thing that happens, if it does by `limit_ns`."""
        session_ns, world_ns = self.session.deadline_ns, self.world.deadline_ns
        up_ns, down_ns = self.up.next_ns, self.down.next_ns
        next_ns = max(self.now_ns, min(session_ns, world_ns, up_ns, down_ns))
        if next_ns > limit_ns:
            self.now_ns = limit_ns
            return False
        self.now_ns = next_ns
        if up_ns <= next_ns:
            for data in self.up.arrived(next_ns):
                self._vehicle(Inbound(0, PEER, data))
        if self.down.next_ns <= next_ns:
            for data in self.down.arrived(next_ns):
                self.feed(inputs.Datagram(0, data))
        if world_ns <= next_ns:
            self._vehicle(WORLD_WAKE)
        if session_ns <= next_ns:
            self.feed(WAKE)
        return True

    def _vehicle(self, given: Inbound | WorldWake) -> None:
        for output in self.world.handle(given, self.now_ns):
            if not isinstance(output, Transmit) or output.peer != PEER:
                continue
            if not self.vehicle_silent:
                data = self._without_lost(output.data)
                if data:
                    self.received.append(Sent(self.now_ns, data))
                    self.down.send(data, self.now_ns)

    def _without_lost(self, data: bytes) -> bytes:
        lost = {"LOCAL_POSITION_NED"} if self.positions_lost else set()
        lost |= {"HEARTBEAT"} if self.heartbeats_lost else set()
        lost |= {"ATTITUDE"} if self.attitudes_lost else set()
        if not lost:
            return data
        frames = (item for item in split(data) if isinstance(item, Frame))
        return b"".join(frame.raw for frame in frames if frame.name not in lost)

    def feed(self, given: inputs.Input) -> None:
        """Hand the session an input, now; then what its effects lead back to.

        As in the loop, nothing is heard any more once the session has finished.
        """
        if self.finish is not None:
            return
        now_ns = self.now_ns if self.recorder is None else self.recorder.input_ns(self.now_ns)
        follows = self.session.handle(given, now_ns)
        self._record(follows, now_ns)
        answers = [answer for effect in follows for answer in self._carry_out(effect)]
        for answer in answers:
            self.feed(answer)

    def fault(self, given: inputs.Input, report: str) -> list[effects.Effect]:
        """Tell the session that `given` raised while its effects were performed; its answer."""
        answer = self.session.fault(given, report, self.now_ns)
        self._record(answer, self.now_ns)
        return answer

    def _record(self, performed: list[effects.Effect], now_ns: int) -> None:
        recorder = self.recorder
        if recorder is None:
            return
        for effect in performed:
            if isinstance(effect, effects.Record):
                recorder.write(effect.item, now_ns)
        if self.now_ns >= recorder.deadline_ns:
            recorder.tick(self.now_ns)

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        """Do it; what the session is to hear of it."""
        match effect:
            case effects.Record(item):  # most of them
                self.records.append((self.now_ns, item))
            case effects.Transmit(link, data) if link > 0:
                self.to_client(link, data)
            case effects.Transmit(_, data):
                self.sent.append(Sent(self.now_ns, data))
                self.up.send(data, self.now_ns)
            case effects.Emit(ipc.Snapshot()):
                pass
            case effects.Emit(event):
                self.events.append(event)
                self.event_times_ns.append(self.now_ns)
            case effects.ReadFile(token, path):
                text = Path(path).read_bytes() if Path(path).is_file() else None
                return [inputs.FileRead(token, path, text, "" if text else "no such file")]
            case effects.WriteFile(token, path, data):
                self.files[path] = data
                return [inputs.FileWritten(token, path)]
            case effects.AskRule():
                return self.rule(effect)
            case effects.Finish():
                self.finish = effect
        return []

    def to_client(self, link: int, data: bytes) -> None:
        """A MAVLink client of a bridge is sent something."""
        raise AssertionError(f"this station has no link {link}")

    # --------------------------------------------------------------------------- operator

    def say(
        self,
        word: str,
        *,
        goal_enu: ipc.Maybe3 | None = None,
        up_m: float | None = None,
        yaw_deg: float | None = None,
        on: bool = True,
        force: bool = False,
        mode: str = "",
        path: str = "",
        name: str = "",
        value: float | None = None,
        offset: int = 0,
        item: int = 0,
    ) -> int:
        """One request; its number."""
        self.last_id = ask_id = self.last_id + 1
        if goal_enu is not None:
            a, b, c = (v if v is not None and math.isfinite(v) else None for v in goal_enu)
            goal_enu = (a, b, c)
        ask = ipc.Ask(
            ask_id,
            word,
            goal_enu=goal_enu,
            up_m=up_m,
            yaw_deg=yaw_deg,
            on=on,
            force=force,
            mode=mode,
            path=path,
            name=name,
            value=value,
            offset=offset,
            item=item,
        )
        self.feed(inputs.OperatorLine(1, ask))
        return ask_id

    def goto(self, east_m: float, north_m: float, up_m: float) -> int:
        """A go-to in the operator's frame."""
        return self.say("goto", goal_enu=(east_m, north_m, up_m))

    def done(self, ask_id: int, timeout_s: float = 60.0) -> str:
        """Wait for the ending of a request, or for the verdict that is its end; say which."""
        looked_at, outcome = -1, self.outcome(ask_id)

        def over() -> bool:
            nonlocal looked_at, outcome
            if len(self.events) != looked_at:
                looked_at, outcome = len(self.events), self.outcome(ask_id)
            return outcome is not None

        self.until(over, timeout_s)
        assert outcome is not None
        return outcome

    def do(self, word: str, *, up_m: float | None = None, path: str = "") -> None:
        """A request that must complete."""
        outcome = self.done(self.say(word, up_m=up_m, path=path))
        assert outcome == "complete", f"{word}: {outcome}: {self.told()}"

    def hovering(self, up_m: float = 1.0) -> Flight:
        """Connected, armed, taken off, in control."""
        self.connected()
        self.do("arm")
        self.do("takeoff", up_m=up_m)
        assert self.state is State.HOVERING
        self.run(0.01)  # what comes from here on is later than the end of the take-off
        return self

    def connected(self) -> Flight:
        """On the ground, with a position and a fence, and the vehicle ready to arm."""
        self.until(lambda: self.state is State.GROUNDED and self.vehicle.armable)
        self.until(lambda: self.home_ned is not None)
        self.run(1.0)
        return self

    # ------------------------------------------------------------------------------ faults

    def report(self, pos_enu: Vec3, v_enu: Vec3 = (0.0, 0.0, 0.0)) -> None:
        """Hand the session a position sample in the vehicle's name, in place of its own."""
        self.positions_lost = True
        east, north, up = pos_enu
        v_east, v_north, v_up = v_enu
        self._forged += 1
        boot_ms = (self.now_ns - START_NS) // 1_000_000 + 1
        data = pymavlink_decoder.local_position(
            boot_ms, (north, east, -up), (v_north, v_east, -v_up), self._forged
        )
        self.feed(inputs.Datagram(0, data))

    def push(self, v_enu: Vec3) -> None:
        """A gust: the vehicle has this velocity from now on, until its control has braked.

        The accelerometer feels such a blow, so the estimate has the velocity at once.
        """
        for block in (self.vehicle.blocks.body, self.vehicle.blocks.est):
            block.vel_e, block.vel_n, block.vel_d = v_enu[0], v_enu[1], -v_enu[2]

    def truth_enu(self) -> Vec3:
        """Where the vehicle really is."""
        north, east, down = self.vehicle.truth.pos_ned
        return (east, north, -down)
