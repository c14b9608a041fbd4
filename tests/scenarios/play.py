"""Play a real autopilot's scenario to our vehicle: the same messages at the same times."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from math import inf
from typing import Any, Final

from pymavlink.dialects.v20 import all as mavlink

from tests.contract.client import Sky
from tests.scenarios.facts import Item, Scenario, Step
from tests.scenarios.names import mission_ack, mode_name, mode_numbers, plan_item
from tests.scenarios.streams import PERIOD_S, STREAMS, message
from tests.scenarios.untold import SHAKEN, UNTOLD
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.faults import GyroBias

HOMES: Final[dict[Personality, Geodetic]] = {
    "px4": Geodetic(47.397742, 8.545594, 32.5),
    "ardupilot": Geodetic(47.397742, 8.545594, 488.08),
}
"""Where the real ones' simulations began."""

PARAMETERS: Final[dict[Personality, dict[str, float]]] = {
    "px4": {"SDLOG_MODE": 1.0},
    "ardupilot": {},
}
"""The real ones' defaults where ours are others on purpose (`parameters/tables/deliberate.py`)."""

FIRMWARE: Final[dict[Personality, Firmware]] = {"px4": "1.14", "ardupilot": "4.7"}
"""What was recorded."""

PLAYED: Final = (
    *("COMMAND_LONG", "COMMAND_INT", "PARAM_SET", "mission", "MISSION_CLEAR_ALL", "###"),
    *("FENCE_OPTIONS", "silent", "all silent", "255 ", "beats"),
)
"""What steps begin with that can be played; "###" is a remark."""

UNTOLD_WHOLLY: Final = ("C8_upload_item_kinds",)
"""Their uploads are figures, not steps; `test_mission_answers.py` has them."""

FROM_POWER_UP: Final = {"H7_force_arm_not_ready"}
"""Begun with the start of the process: played to a vehicle that boots as the real one."""

READY_S: Final = 3.0
LAST_S: Final = 0.1
"""Until what the last step led to has been said."""
SHAKING_RAD_S: Final = 0.02
ANSWER_S: Final = 1.5
"""How long the recorder waited for an answer."""


@dataclass(frozen=True)
class Seen:
    """What the vehicle said of itself, at `t` seconds."""

    t: float
    mode: str
    armed: bool
    landed: str


@dataclass
class Played:
    """`acks` has, for each step, the answer's name, or None; `seen` begins with the start."""

    acks: list[str | None] = field(default_factory=list)
    seen: list[Seen] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)


def play(personality: Personality, scenario: Scenario) -> Played:
    """The scenario from its first step to its end, on a vehicle that is ready."""
    return _Player(personality, scenario).play()


def playable(personality: Personality, scenario: Scenario) -> bool:
    """It is known what was sent: by the steps, or by the table of streams."""
    told = all(step.sent.startswith(PLAYED) for step in scenario.steps)
    streams = (personality, scenario.scenario) in STREAMS
    known = scenario.scenario not in UNTOLD_WHOLLY
    return bool(scenario.steps) and known and (told or streams)


class _Player:
    def __init__(self, personality: Personality, scenario: Scenario) -> None:
        self._personality, self._scenario = personality, scenario
        self._starting = scenario.scenario in FROM_POWER_UP
        self._sky = Sky(
            personality,
            home=_start(personality, scenario),
            firmware=FIRMWARE[personality],
            parameters=PARAMETERS[personality],
            boot="real" if self._starting else "quick",
            camera=False,
        )
        self._client = self._sky.client()
        self._played = Played()
        self._zero_s = 0.0
        self._next_s = inf
        self._first_ned: Vec3 | None = None

    def play(self) -> Played:
        self._client.beat_if_due()
        if not self._starting:
            self._sky.run(READY_S)
            self._prepare()
        self._client.forget()
        self._zero_s = self._sky.now_ns / 1e9
        self._played.seen.append(self._now())
        told = [(step, True) for step in self._scenario.steps]
        untold = UNTOLD.get((self._personality, self._scenario.scenario), ())
        both = [*told, *((step, False) for step in untold)]
        both.sort(key=lambda pair: pair[0].t)
        times = [step.t for step, _ in both]
        for (step, compared), next_s in zip(both, [*times[1:], inf], strict=True):
            self._next_s = next_s
            self._until(step.t)
            answer = self._take(step)
            if compared:
                self._played.acks.append(answer)
            self._note()
        self._until(self._scenario.end_s + LAST_S)
        self._played.texts = self._client.texts()
        return self._played

    def _prepare(self) -> None:
        """Flown before, in the air and in the mode, as the real one was."""
        start = self._scenario.start
        if self._scenario.flown_before and not start.armed:
            self._client.long(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
            self._sky.run(1.0)
            self._client.long(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0)
            self._sky.run(1.0)
        if start.armed:
            self._client.take_off(max(1.0, start.up or 0.0))
        if start.mode not in (None, self._now().mode):
            self._set_mode(str(start.mode))
            self._sky.run(1.0)

    # ------------------------------------------------------------------------------ seeing

    def _until(self, t: float) -> None:
        while (left_s := self._zero_s + t - self._sky.now_ns / 1e9) > 1e-9:
            now_s = t - left_s
            self._shake(now_s)
            streaming = self._stream(now_s)
            self._sky.run(min(PERIOD_S if streaming else 0.1, left_s))
            self._note()

    def _stream(self, t: float) -> bool:
        """Send one message of what is streamed now; False where nothing is."""
        streams = STREAMS.get((self._personality, self._scenario.scenario), ())
        now = next((stream for begin, end, stream in streams if begin <= t < end), None)
        if now is None:
            return False
        if self._first_ned is None:
            self._first_ned = self._sky.vehicles[0].estimate.pos_ned
        self._client.send(message(now, self._first_ned))
        return True

    def _shake(self, t: float) -> None:
        begin_s, end_s = SHAKEN.get(self._scenario.scenario, (inf, 0.0))
        if self._personality == "px4" and begin_s <= t:
            by_rad_s = SHAKING_RAD_S if t < end_s else 0.0
            by_rad_s *= 1.0 if t % 0.6 < 0.3 else -1.0
            self._sky.vehicles[0].inject(GyroBias((by_rad_s, 0.0, 0.0)))

    def _now(self) -> Seen:
        vehicle = self._sky.vehicles[0]
        return Seen(
            self._sky.now_ns / 1e9 - self._zero_s,
            mode_name(self._personality, vehicle.custom_mode),
            vehicle.armed,
            vehicle.landed.name,
        )

    def _note(self) -> None:
        now = self._now()
        last = self._played.seen[-1]
        if (now.mode, now.armed, now.landed) != (last.mode, last.armed, last.landed):
            self._played.seen.append(now)

    # ----------------------------------------------------------------------------- sending

    def _take(self, step: Step) -> str | None:
        words = step.words
        if words[0] in ("COMMAND_LONG", "COMMAND_INT"):
            return self._command(step)
        if words[0].startswith(("PARAM_SET", "FENCE_OPTIONS=")):
            name, _, value = words[-1].partition("=")
            return "ok" if self._set_parameter(name, float(value)) else "no"
        if words[0] == "MISSION_CLEAR_ALL":
            return self._clear(int(words[-1]))
        if words[:2] == ["mission", "upload"]:
            return self._upload(step.items, int(words[-1]))
        if words[0] == "LOG_REQUEST_LIST":
            self._client.send(mavlink.MAVLink_log_request_list_message(1, 1, 0, 0xFFFF))
        if words[0] == "LOG_REQUEST_DATA":  # the whole of the first one
            self._client.send(mavlink.MAVLink_log_request_data_message(1, 1, 1, 0, 0xFFFFFFFF))
        if "silent" in step.sent:
            for client in self._sky.clients.values():
                client.beats = False
            if "77 beats" in step.sent:
                self._sky.client("other", system=77)
        elif "beats" in step.sent or "again" in step.sent:
            self._client.beats = True
            self._client.beat_ns = self._sky.now_ns
            self._client.beat_if_due()
        return None

    def _command(self, step: Step) -> str | None:
        number = mavlink.enums["MAV_CMD"]
        command = next(key for key, entry in number.items() if entry.name == step.words[1])
        values = step.values
        before = len(self._client.heard)
        if step.words[0] == "COMMAND_LONG":
            message: Any = mavlink.MAVLink_command_long_message(1, 1, command, 0, *values)
        else:
            x, y = (0 if math.isnan(value) else int(value) for value in values[4:6])
            message = mavlink.MAVLink_command_int_message(
                1, 1, step.frame or 0, command, 0, 0, *values[:4], x, y, values[6]
            )
        self._client.send(message)
        self._wait("COMMAND_ACK", before)
        for heard in self._client.heard[before:]:
            if heard.message.get_type() == "COMMAND_ACK" and heard.message.command == command:
                name: str = mavlink.enums["MAV_RESULT"][heard.message.result].name
                return name.removeprefix("MAV_RESULT_")
        return None

    def _wait(self, kind: str, before: int) -> list[Any]:
        """Until a message of that kind came, or the recorder's patience is over.

        It is over at the next step, too: the recorder waited less in some scenarios.
        """
        end_s = min(self._sky.now_ns / 1e9 + ANSWER_S, self._zero_s + self._next_s)
        while self._sky.now_ns / 1e9 < end_s:
            found = [h.message for h in self._client.heard[before:] if h.message.get_type() == kind]
            if found:
                return found
            self._stream(self._sky.now_ns / 1e9 - self._zero_s)
            self._sky.run(PERIOD_S)
            self._note()
        return []

    def _set_parameter(self, name: str, value: float) -> bool:
        own = self._sky.parameters[0]
        before = len(self._client.heard)
        whole = name in own and own.spec(name).integer
        if whole and self._personality == "px4":  # an integer's bytes stand for it
            (value,) = struct.unpack("<f", struct.pack("<i", round(value)))
        kind = mavlink.MAV_PARAM_TYPE_INT32 if whole else mavlink.MAV_PARAM_TYPE_REAL32
        self._client.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), value, kind))
        return any(m.param_id == name for m in self._wait("PARAM_VALUE", before))

    def _clear(self, kind: int) -> str | None:
        before = len(self._client.heard)
        self._client.send(mavlink.MAVLink_mission_clear_all_message(1, 1, kind))
        return mission_ack(self._wait("MISSION_ACK", before))

    def _upload(self, items: tuple[Item, ...], kind: int) -> str | None:
        before = len(self._client.heard)
        self._client.send(mavlink.MAVLink_mission_count_message(1, 1, len(items), kind))
        for _ in range(3 * len(items) + 3):
            asked = [
                h.message
                for h in self._client.heard[before:]
                if h.message.get_type() in ("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK")
            ]
            if not asked:
                return None
            if asked[-1].get_type() == "MISSION_ACK":
                return mission_ack(asked[-1:])
            before = len(self._client.heard)
            self._client.send(plan_item(items[asked[-1].seq], asked[-1].seq, kind))
        return None

    def _set_mode(self, name: str) -> None:
        numbers = mode_numbers(self._personality, name)
        self._client.long(mavlink.MAV_CMD_DO_SET_MODE, 1, *numbers)


def _start(personality: Personality, scenario: Scenario) -> Geodetic:
    """Where the real one stood at the start of a scenario."""
    home = HOMES[personality]
    start = scenario.start
    north, east = round(start.n or 0.0), round(start.e or 0.0)
    where = projection(personality, home).to_geodetic((north, east, 0.0))
    return Geodetic(where.lat_deg, where.lon_deg, home.alt_amsl_m)
