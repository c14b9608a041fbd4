"""Hostile MAVLink clients before the bridge and the whole vehicle behind it, over links that lose.

Each client sends random frames of the whole dialect with random bytes in them, and, as often, what
a real client sends that flies: arm, take off, go-tos, streams, missions; inside the fence, outside
it, straight at it.  Each also lies about who it is.  All follows from one seed.

What is checked while it flies, without a look at the gate:

- the vehicle's truth never leaves the fence by more than the margin, whatever was sent;
- nothing on the vehicle's link moves it or is denied, but what the station made itself.
"""

from __future__ import annotations

import math
import random
import struct
from collections import Counter
from collections.abc import Callable
from typing import Any, Final

from pymavlink.dialects.v20 import all as dialect
from pymavlink.generator.mavcrc import x25crc

from gcs.bridge.catalog import Kind, command_row, message_row
from gcs.bridge.routing import TARGETS
from gcs.gate.policy.parse import parse_policy
from gcs.session import effects, inputs
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import STATION, VEHICLE, Client
from tests.loopback.flight import PERSONALITIES
from tests.loopback.lossy_link import Air, Weather
from tests.loopback.plan_clients import UPLOADS, PlanFlight, PlanItem, mission

HALF_M: Final = 30.0
CEILING_M: Final = 25.0
TOWER: Final = (12.0, 20.0, -5.0, 5.0)
"""West, east, south, north of an exclusion zone."""
POLICY: Final = parse_policy(
    f"""
[stream]
tilt_deg = 10.0
hover_thrust_error = 0.02
attitude_error_m_s2 = 0.5
[[fence]]
name = "box"
kind = "box"
east_m = [-{HALF_M}, {HALF_M}]
north_m = [-{HALF_M}, {HALF_M}]
floor_up_m = 0.0
ceiling_up_m = {CEILING_M}
[[fence]]
name = "tower"
kind = "box"
inclusion = false
east_m = [{TOWER[0]}, {TOWER[1]}]
north_m = [{TOWER[2]}, {TOWER[3]}]
""",
    "hostile.toml",
)
SAFE: Final = frozenset({Kind.HARMLESS, Kind.POINTING, Kind.CONFIGURATION})
FORWARDED: Final = frozenset(
    {
        "DO_SET_ROI_LOCATION",
        "DO_SET_ROI_WPNEXT_OFFSET",
        "DO_SET_ROI_NONE",
        "DO_SET_ROI_SYSID",
        "DO_SET_ROI",
        "DO_CHANGE_SPEED",
    }
)
"""Of the commands that are judged as motion these are let through, as docs/bridge.md says: they
turn the nose, or make the vehicle fly slower."""
COMMANDS: Final = tuple(sorted(dialect.enums["MAV_CMD"]))
NUMBERS: Final = (0.0, 1.0, -1.0, math.nan, math.inf, 1e9, -1e30, 21196.0, 21.0, 5.0)
LOOKED_AT_S: Final = 0.1
NEAR_GROUND_M: Final = 0.3


class Overheard(Air):
    """A client's way to the bridge; every frame that is sent on it is remembered."""

    said: set[bytes]

    def send(self, data: bytes, now_ns: int) -> None:
        self.said.update(item.raw for item in split(data) if isinstance(item, Frame))
        super().send(data, now_ns)


class HostileFlight(PlanFlight):
    """Raises AssertionError in the moment in which a promise is broken."""

    def __init__(self, seed: int) -> None:
        self.dice = dice = random.Random(seed)
        self.said: set[bytes] = set()
        """Every frame that a client has sent."""
        self.passed: Counter[str] = Counter()
        self.outmost_m = -math.inf
        self.last_words: list[str] = []
        badness = dice.choice((0.0, 0.1, 0.3))
        weather = Weather(loss=0.6 * badness, duplicate=badness, delay_s=(0.001, 0.001 + badness))
        super().__init__(
            PERSONALITIES[seed % 2],
            seed=seed + 1,
            policy=POLICY,
            vehicle_weather=Weather(loss=0.3 * badness, delay_s=(0.001, 0.001 + 0.3 * badness)),
            client_weather=weather,
        )
        self.hostile = [self.join(245, 190), self.join(255, 190)]

    def join(self, sysid: int = 245, compid: int = 190) -> Client:
        link = 1 + len(self.clients)
        client = super().join(sysid, compid)
        way = self.to_bridge[link] = Overheard(self.client_weather, 1000 * self.seed + 2 * link)
        way.said = self.said
        return client

    # --------------------------------------------------------------------------- promises

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        if isinstance(effect, effects.Transmit) and effect.link == 0:
            for item in split(effect.data):
                if isinstance(item, Frame):
                    self._passes(item)
        return super()._carry_out(effect)

    def _passes(self, frame: Frame) -> None:
        """A frame on its way to the vehicle: the station's own, or one that moves nothing.

        On the ground ArduPilot is set to GUIDED, which moves nothing, by the client's own frame.
        """
        if frame.raw not in self.said and (frame.sysid, frame.compid) == STATION:
            return
        row = message_row(frame.msgid)
        if row.kind is Kind.CARRIER:
            row = command_row(command_of(frame))
        self.passed[row.name] += 1
        grounded = row.kind is Kind.MOTION and -self.vehicle.truth.pos_ned[2] < NEAR_GROUND_M
        safe = row.kind in SAFE or row.name in FORWARDED
        assert safe or grounded, f"{row.name} ({row.kind}) reaches the vehicle"

    def flies(self, seconds: float) -> None:
        """Let time pass, and look where the vehicle really is."""
        until_ns = self.now_ns + round(seconds * 1e9)
        while self.now_ns < until_ns:
            self.run(min(LOOKED_AT_S, (until_ns - self.now_ns) / 1e9))
            self._look()

    def _look(self) -> None:
        east, north, up = self.truth_enu()
        outside_m = max(abs(east) - HALF_M, abs(north) - HALF_M, up - CEILING_M)
        west, east_end, south, north_end = TOWER
        inside_m = min(east - west, east_end - east, north - south, north_end - north)
        self.outmost_m = max(self.outmost_m, outside_m, inside_m)
        assert self.outmost_m <= POLICY.margin_h_m, (
            f"the truth {self.truth_enu()} is {self.outmost_m:.2f} m outside: {self.last_words}"
        )

    # ------------------------------------------------------------------------------ saying

    def say_raw(self, client: Client, data: bytes) -> None:
        """Over the client's link."""
        self.to_bridge[client.link].send(data, self.now_ns)

    def say_as(self, client: Client, message: Any) -> None:
        """A message of pymavlink."""
        self.last_words = [*self.last_words[-15:], f"{self.now_ns / 1e9:.2f} {str(message)[:120]}"]
        self.say_raw(client, message.pack(client.mav))

    def place(self, east_m: float, north_m: float) -> tuple[int, int]:
        """Degrees x 1e7."""
        items = mission(self.personality, (north_m, east_m, 10.0))
        waypoint = items[-2]
        return round(waypoint.lat_deg * 1e7), round(waypoint.lon_deg * 1e7)


def command_of(frame: Frame) -> int:
    """The command of a COMMAND_LONG or COMMAND_INT, whose payload may be cut."""
    at = 28
    (command,) = struct.unpack("<H", frame.payload.ljust(at + 2, b"\0")[at : at + 2])
    return int(command)


# ----------------------------------------------------------------------------------- acts

Act = Callable[[HostileFlight, Client], None]


def long(*params: float, command: int, target: tuple[int, int] = VEHICLE) -> Any:
    filled = params + (0.0,) * (7 - len(params))
    return dialect.MAVLink_command_long_message(*target, command, 0, *filled)


def random_frame(flight: HostileFlight, client: Client) -> None:
    """Any message of the dialect, with any bytes, from anybody, for the vehicle or for others."""
    dice = flight.dice
    msgid = dice.choice(list(dialect.mavlink_map))
    cls = dialect.mavlink_map[msgid]
    size = cls.unpacker.size
    payload = bytearray(
        dice.choice((bytes(size), dice.randbytes(size), bytes(dice.choices((0, 1, 255), k=size))))
    )
    if msgid in TARGETS and dice.random() < 0.9:
        system_at, component_at = TARGETS[msgid]
        if system_at < size:  # the dialects differ in a few messages
            payload[system_at] = 1
        if 0 <= component_at < size:
            payload[component_at] = dice.choice((0, 1, 1))
    sysid, compid = dice.choice(((245, 190), (245, 190), (1, 1), STATION, (0, 0)))
    say_frame(flight, client, msgid, cls.crc_extra, bytes(payload), sysid, compid)


def say_frame(
    flight: HostileFlight,
    client: Client,
    msgid: int,
    crc_extra: int,
    payload: bytes,
    sysid: int,
    compid: int,
) -> None:
    """A MAVLink 2 frame made by hand."""
    payload = payload.rstrip(b"\0") or b"\0"
    seq = flight.dice.randrange(256)
    head = struct.pack(
        "<BBBBBBBHB", 0xFD, len(payload), 0, 0, seq, sysid, compid, msgid & 0xFFFF, msgid >> 16
    )
    crc = x25crc(head[1:] + payload)
    crc.accumulate(struct.pack("<B", crc_extra))
    flight.say_raw(client, head + payload + struct.pack("<H", crc.crc))


def random_command(flight: HostileFlight, client: Client) -> None:
    """Any MAV_CMD with numbers that mean much."""
    dice = flight.dice
    command, params = dice.choice(COMMANDS), dice.choices(NUMBERS, k=7)
    if dice.random() < 0.5:
        flight.say_as(client, long(*params, command=command))
        return
    x, y = flight.place(dice.uniform(-60, 60), dice.uniform(-60, 60))
    message = dialect.MAVLink_command_int_message(
        *VEHICLE, dice.choice((0, 3, 5, 6)), command, 0, 0, *params[:4], x, y, params[6]
    )
    flight.say_as(client, message)


def arms_and_takes_off(flight: HostileFlight, client: Client) -> None:
    flight.say_as(client, long(1, command=dialect.MAV_CMD_COMPONENT_ARM_DISARM))
    flight.flies(1.5)
    if flight.personality == "ardupilot":
        flight.say_as(client, long(1, 4, command=dialect.MAV_CMD_DO_SET_MODE))
        flight.flies(0.5)
    up_m = flight.dice.choice((5.0, 8.0, 12.0, 12.0, 60.0, math.nan))
    take_off = (0, 0, 0, math.nan, math.nan, math.nan, up_m)
    flight.say_as(client, long(*take_off, command=dialect.MAV_CMD_NAV_TAKEOFF))
    flight.flies(6.0)


def goes(flight: HostileFlight, client: Client) -> None:
    """DO_REPOSITION, or a position target; anywhere."""
    dice = flight.dice
    reach_m = dice.choice((12.0, 20.0, 27.99, 27.99, 28.5, 40.0, 3000.0))
    east, north = dice.uniform(-reach_m, reach_m), dice.uniform(-reach_m, reach_m)
    up_m = dice.choice((5.0, 8.0, 10.0, 15.0, 24.6, 24.8, 80.0, -5.0))
    x, y = flight.place(east, north)
    match dice.randrange(3):
        case 0:
            flight.say_as(
                client,
                dialect.MAVLink_command_int_message(
                    *VEHICLE, 6, dialect.MAV_CMD_DO_REPOSITION, 0, 0, -1, 1, 0, math.nan, x, y, up_m
                ),
            )
        case 1:
            flight.say_as(client, local_target(north, east, -up_m, 3576))
        case _:
            flight.say_as(
                client,
                dialect.MAVLink_set_position_target_global_int_message(
                    0, *VEHICLE, 6, 3576, x, y, up_m, 0, 0, 0, 0, 0, 0, 0, 0
                ),
            )
    flight.flies(dice.choice((0.2, 2.0, 6.0)))


def local_target(x: float, y: float, z: float, mask: int, v: tuple[float, ...] = (0, 0, 0)) -> Any:
    return dialect.MAVLink_set_position_target_local_ned_message(
        0, *VEHICLE, 1, mask, x, y, z, *v, 0, 0, 0, 0, 0
    )


def velocity_at_the_fence(flight: HostileFlight, client: Client) -> None:
    """At 20 Hz, at any speed, straight on; some of it in the body's frame, some of it climbing."""
    dice = flight.dice
    speed, turn = dice.choice((2.0, 8.0, 25.0)), dice.uniform(0.0, math.tau)
    v = (speed * math.cos(turn), speed * math.sin(turn), dice.choice((0.0, 0.0, -3.0, 2.0)))
    frame = dice.choice((1, 1, 8, 7))
    for _ in range(dice.choice((20, 100, 160))):
        flight.say_as(
            client,
            dialect.MAVLink_set_position_target_local_ned_message(
                0, *VEHICLE, frame, 3527, 0, 0, 0, *v, 0, 0, 0, 0, 0
            ),
        )
        flight.flies(0.05)


def gets_going(flight: HostileFlight, client: Client) -> None:
    """Off the ground, or out of a hold: what it takes to be a danger again."""
    if not flight.vehicle.armed:
        arms_and_takes_off(flight, client)
        return
    for _ in range(10):
        east, north, up = flight.truth_enu()
        flight.say_as(client, local_target(north, east, -up, 3576))
        flight.flies(0.1)
    guided = (1, 6, 0) if flight.personality == "px4" else (1, 4, 0)
    flight.say_as(client, long(*guided, command=dialect.MAV_CMD_DO_SET_MODE))
    flight.flies(1.5)


def sticks(flight: HostileFlight, client: Client) -> None:
    """Manual control, overridden channels, attitude targets: for a second."""
    dice = flight.dice
    x, y = dice.choice((-1000, 0, 1000)), dice.choice((-1000, 0, 1000))
    for _ in range(20):
        flight.say_as(client, dialect.MAVLink_manual_control_message(1, x, y, 1000, 0, 0))
        channels = (2000, 1000, 2000, 1500, 1000, 1000, 1000, 1000)
        flight.say_as(client, dialect.MAVLink_rc_channels_override_message(*VEHICLE, *channels))
        flight.say_as(
            client,
            dialect.MAVLink_set_attitude_target_message(
                0, *VEHICLE, 0, [0.9, 0.3, 0.3, 0.0], 0, 0, 0, 0.9
            ),
        )
        flight.flies(0.05)


def joystick_at_the_fence(flight: HostileFlight, client: Client) -> None:
    """Let go of once, so that it flies; then pushed anywhere, for long, and let go of or lost."""
    dice = flight.dice
    ends = (-1000, -1000, 0, 400, 1000, 1000, 0x7FFF)
    pushed = (dice.choice(ends), dice.choice(ends), dice.choice((0, 500, 500, 1000)))
    turned = dice.choice((0, 0, -1000, 300))
    by_channels = flight.personality == "ardupilot" and dice.random() < 0.3
    for count in range(dice.choice((30, 125, 200))):
        x, y, z = (0, 0, 500) if count < 3 else pushed
        if by_channels:
            raw = (1500 + y // 2, 1500 - x // 2, 1000 + z, 1500 + turned // 2)
            message = dialect.MAVLink_rc_channels_override_message(
                *VEHICLE, *(each if 900 < each < 2500 else 0xFFFF for each in raw), *(0,) * 4
            )
        else:
            message = dialect.MAVLink_manual_control_message(1, x, y, z, turned * (count > 2), 0)
        flight.say_as(client, message)
        flight.flies(0.04)
    if dice.random() < 0.5:
        for _ in range(30):
            flight.say_as(client, dialect.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0))
            flight.flies(0.04)


def attitudes_at_the_fence(flight: HostileFlight, client: Client) -> None:
    """Leans one way for long, or changes all the time; a thrust near the one that keeps the height
    (vehicle-sim's MPC_THR_HOVER, the middle of a climb rate), or any."""
    dice, hover = flight.dice, {"px4": 0.43, "ardupilot": 0.5}[flight.personality]
    if dice.random() < 0.4:
        gets_going(flight, client)
        north, east = dice.uniform(-8.0, 8.0), dice.uniform(-15.0, 0.0)
        for _ in range(50):
            flight.say_as(client, local_target(north, east, -dice.choice((10.0, 12.0)), 3576))
            flight.flies(0.1)
    changes, mask = dice.random() < 0.3, dice.choice((7, 7, 7, 0, 3, 0x87))
    tilt, way, thrust = 0.0, 0.0, hover
    for count in range(dice.choice((10, 60, 150))):
        if changes or not count:
            tilt, way = dice.choice((0.0, 5.0, 9.9, 9.9, 20.0)), dice.uniform(0.0, math.tau)
            thrust = dice.choice((hover, hover, 1.03 * hover, 0.97 * hover, 1.0, 0.0))
        half = math.radians(tilt) / 2.0
        q = (math.cos(half), math.sin(half) * math.cos(way), math.sin(half) * math.sin(way), 0.0)
        flight.say_as(
            client,
            dialect.MAVLink_set_attitude_target_message(0, *VEHICLE, mask, q, 0, 0, 0.2, thrust),
        )
        flight.flies(0.05)


def modes(flight: HostileFlight, client: Client) -> None:
    dice = flight.dice
    main, sub = dice.randrange(12), dice.randrange(10)
    if dice.random() < 0.5:
        flight.say_as(client, long(1, main, sub, command=dialect.MAV_CMD_DO_SET_MODE))
    else:
        custom = dice.choice((main, (sub << 24) | (main << 16)))
        flight.say_as(client, dialect.MAVLink_set_mode_message(1, 1, custom))


def words(flight: HostileFlight, client: Client) -> None:
    """What ends or disturbs a flight."""
    dice = flight.dice
    flight.say_as(
        client,
        dice.choice(
            (
                long(1, command=dialect.MAV_CMD_DO_FLIGHTTERMINATION),
                long(0, 21196, command=dialect.MAV_CMD_COMPONENT_ARM_DISARM),
                long(0, command=dialect.MAV_CMD_COMPONENT_ARM_DISARM),
                long(0, command=dialect.MAV_CMD_DO_FENCE_ENABLE),
                long(1, command=dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN),
                long(1, 0, 0, 0, 47.5, 8.6, 500, command=dialect.MAV_CMD_DO_SET_HOME),
                long(command=dialect.MAV_CMD_NAV_RETURN_TO_LAUNCH),
                long(0, 50, 50, command=dialect.MAV_CMD_DO_CHANGE_SPEED),
                long(80, 1, command=dialect.MAV_CMD_DO_CHANGE_ALTITUDE),
                long(15, 5, *[math.nan] * 5, command=dialect.MAV_CMD_DO_ORBIT),
                long(command=dialect.MAV_CMD_MISSION_START),
                dialect.MAVLink_set_gps_global_origin_message(1, 475000000, 86000000, 0),
                dialect.MAVLink_set_home_position_message(
                    1, 475000000, 86000000, 0, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0
                ),
                dialect.MAVLink_mission_set_current_message(*VEHICLE, dice.randrange(5)),
                dialect.MAVLink_mission_clear_all_message(*VEHICLE, dice.randrange(3)),
            )
        ),
    )


def parameters(flight: HostileFlight, client: Client) -> None:
    dice = flight.dice
    names = [b"FENCE_ENABLE", b"GF_ACTION", b"MPC_XY_VEL_MAX", b"WPNAV_SPEED", b"COM_OBL_RC_ACT"]
    names += [b"FENCE_RADIUS", b"RTL_RETURN_ALT", b"RTL_ALT", b"SYSID_MYGCS", b"NAV_DLL_ACT"]
    message = dialect.MAVLink_param_set_message(
        *VEHICLE, dice.choice(names), dice.choice((0.0, 1.0, 1e6, math.nan)), 9
    )
    flight.say_as(client, message)


def lies(flight: HostileFlight, client: Client) -> None:
    """In the vehicle's name, or the station's: positions, heartbeats, GPS, answers."""
    dice = flight.dice
    sysid, compid = dice.choice(((1, 1), STATION))
    liar = dialect.MAVLink(None, srcSystem=sysid, srcComponent=compid)
    now_ms = flight.now_ns // 1_000_000 % 2**31
    message = dice.choice(
        (
            dialect.MAVLink_local_position_ned_message(now_ms, 0, 0, -10, 0, 0, 0),
            dialect.MAVLink_heartbeat_message(2, 12, 209, 393216, 4, 3),
            dialect.MAVLink_home_position_message(
                475000000, 86000000, 0, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0
            ),
            dialect.MAVLink_gps_global_origin_message(475000000, 86000000, 0),
            dialect.MAVLink_extended_sys_state_message(0, 1),
            dialect.MAVLink_command_ack_message(400, 0, 0, 0, *STATION),
            local_target(500.0, 0.0, -10.0, 3576),
            long(1, 21196, command=400),
        )
    )
    flight.say_raw(client, message.pack(liar))
    gps = (0, 0, 0, 0, 0, 3, 475000000, 86000000, 500.0, 1, 1, 0, 0, 0, 1, 1, 1, 10)
    flight.say_as(client, dialect.MAVLink_gps_input_message(*gps))


def uploads(flight: HostileFlight, client: Client) -> None:
    """A mission: inside, or cutting the tower, or leaving the fence; at times started."""
    dice = flight.dice
    reach_m = dice.choice((20.0, 27.0, 45.0))
    places = [
        (dice.uniform(-reach_m, reach_m), dice.uniform(-reach_m, reach_m), dice.choice((8.0, 15.0)))
        for _ in range(dice.randint(1, 4))
    ]
    items: list[PlanItem] = mission(flight.personality, *places)
    flight.uploads.clear()
    dice.choice(UPLOADS)(flight, client, items)
    flight.flies(dice.choice((0.3, 3.0)))
    if dice.random() < 0.7:
        flight.say_as(client, long(command=dialect.MAV_CMD_MISSION_START))
        flight.flies(dice.choice((1.0, 8.0)))


def waits(flight: HostileFlight, client: Client) -> None:
    flight.flies(flight.dice.choice((0.1, 1.0, 4.0)))


def noise(flight: HostileFlight, client: Client) -> None:
    flight.say_raw(client, flight.dice.randbytes(flight.dice.choice((1, 40, 3000))))


def beats(flight: HostileFlight, client: Client) -> None:
    flight.say_as(client, dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))


ACTS: Final[tuple[Act, ...]] = (
    *[random_frame] * 20,
    *[random_command] * 10,
    *[gets_going] * 14,
    *[goes] * 16,
    *[velocity_at_the_fence] * 8,
    sticks,
    *[joystick_at_the_fence] * 4,
    *[attitudes_at_the_fence] * 2,
    *[modes] * 3,
    *[words] * 5,
    *[parameters] * 4,
    *[lies] * 6,
    *[uploads] * 4,
    *[waits] * 4,
    noise,
    *[beats] * 6,
)


FLYING: Final[tuple[Act, ...]] = (
    *[gets_going] * 6,
    *[goes] * 20,
    *[velocity_at_the_fence] * 12,
    *[joystick_at_the_fence] * 8,
    *[attitudes_at_the_fence] * 6,
    *[uploads] * 3,
    *[lies] * 3,
    *[random_frame] * 6,
    *[parameters] * 2,
    *[waits] * 3,
    *[beats] * 3,
)
"""Of clients that want to get somewhere."""


PILOTS: Final[tuple[Act, ...]] = (
    *[gets_going] * 4,
    *[goes] * 3,
    *[joystick_at_the_fence] * 16,
    *[modes] * 2,
    sticks,
    velocity_at_the_fence,
    *[random_frame] * 4,
    *[waits] * 3,
    *[beats] * 3,
)
"""Of clients with a joystick."""


LEANERS: Final[tuple[Act, ...]] = (
    *[gets_going] * 2,
    *[goes] * 2,
    *[attitudes_at_the_fence] * 16,
    velocity_at_the_fence,
    joystick_at_the_fence,
    *[random_frame] * 2,
    *[waits] * 2,
    *[beats] * 2,
)
"""Of clients that fly attitudes."""


def flown(seed: int, seconds: float = 40.0, acts: tuple[Act, ...] | None = None) -> HostileFlight:
    """Hostile flight number `seed`, with a take-off at its beginning.  Raises AssertionError."""
    flight = HostileFlight(seed)
    flight.connected()
    arms_and_takes_off(flight, flight.hostile[0])
    acts = acts or flight.dice.choice((ACTS, FLYING, FLYING))
    while flight.elapsed_s < seconds and flight.finish is None:
        client = flight.hostile[0] if flight.dice.random() < 0.7 else flight.hostile[1]
        for _ in range(flight.dice.choice((1, 1, 1, 5))):
            flight.dice.choice(acts)(flight, client)
        for each in flight.hostile:
            beats(flight, each)
        flight.flies(flight.dice.choice((0.0, 0.1, 0.5)))
    return flight
