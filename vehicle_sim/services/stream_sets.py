"""What is sent unasked, and on which links: sets of message number -> interval in nanoseconds.

PX4 starts each of its links in a mode with its own set: MAVLINK_MODE_NORMAL on UDP port 14550, for
ground stations, and MAVLINK_MODE_ONBOARD on 14540, for programs.  The rates are those that PX4
1.14.3's own simulation was recorded with on both, before anything was asked for.  Not sent here,
for want of what they tell of: DISTANCE_SENSOR (no range sensor), LINK_NODE_STATUS and
TIME_ESTIMATE_TO_TARGET.  Not recorded, and from memory of PX4's sources: RC_CHANNELS and
MANUAL_CONTROL, which want a radio, and rates while an orbit or a goal is flown on 14540.

ArduCopter sends HEARTBEAT and TIMESYNC; all else is asked for, by a message or by its parameters.
What its groups of REQUEST_DATA_STREAM hold is of arducopter_4_7_flight.tlog, which asked for all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final, Literal, TypeAlias

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.profile import DATA_STREAMS, Profile
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import DataStream

S_NS: Final = 1_000_000_000
Intervals: TypeAlias = dict[int, int]
Groups: TypeAlias = Mapping[DataStream, tuple[type[m.Message], ...]]
Change: TypeAlias = Literal["arming", "mode"]


class LinkMode(Enum):
    """Who is thought to be at the other end of a link, by PX4's words."""

    NORMAL = "normal"
    """A ground station."""
    ONBOARD = "onboard"
    """A program that flies the vehicle."""


ONBOARD_PORTS: Final = range(14540, 14550)
"""Of PX4's own simulation: one a vehicle; the tenth and later ones share the last."""


def intervals(rates_hz: Mapping[type[m.Message], float]) -> Intervals:
    """Rates [Hz] as intervals by the number of the message."""
    return {m.IDS[kind]: round(S_NS / rate_hz) for kind, rate_hz in rates_hz.items()}


POSITION_ONLY: Final = intervals(
    {m.Heartbeat: 1, m.SysStatus: 1, m.LocalPositionNed: 10, m.GlobalPositionInt: 1}
)
"""What a vehicle of a large fleet sends unasked, in place of all that its autopilot does."""

PX4_NORMAL: Final = intervals(
    {
        m.Heartbeat: 1,
        m.SysStatus: 1,
        m.ExtendedSysState: 1,
        m.LocalPositionNed: 50,
        m.GlobalPositionInt: 50,
        m.Attitude: 50,
        m.AttitudeQuaternion: 50,
        m.AttitudeTarget: 50,
        m.PositionTargetLocalNed: 50,
        m.ServoOutputRaw: 50,
        m.RcChannels: 20,
        m.MissionCurrent: 10,
        m.ManualControl: 5,
        m.VfrHud: 4,
        m.OrbitExecutionStatus: 2,
        m.GpsRawInt: 1,
        m.Altitude: 1,
        m.ScaledPressure: 1,
        m.OpenDroneIdLocation: 1,
        m.OpenDroneIdSystem: 1,
        m.PositionTargetGlobalInt: 1,
        m.BatteryStatus: 0.5,
        m.EstimatorStatus: 0.5,
        m.HomePosition: 0.5,
        m.UtmGlobalPosition: 0.5,
        m.CurrentEventSequence: 1 / 3,
        m.Vibration: 0.1,
        m.Ping: 0.1,
    }
)
PX4_ONBOARD: Final = intervals(
    {
        m.Heartbeat: 1,
        m.SysStatus: 2,
        m.ExtendedSysState: 5,
        m.HighresImu: 50,
        m.AttitudeQuaternion: 50,
        m.LocalPositionNed: 30,
        m.Odometry: 30,
        m.Attitude: 20,
        m.RcChannels: 20,
        m.AttitudeTarget: 10,
        m.ServoOutputRaw: 10,
        m.VfrHud: 10,
        m.Altitude: 10,
        m.MissionCurrent: 10,
        m.Timesync: 10,
        m.GlobalPositionInt: 5,
        m.PositionTargetLocalNed: 5,
        m.ManualControl: 5,
        m.OrbitExecutionStatus: 5,
        m.GpsRawInt: 1,
        m.PositionTargetGlobalInt: 1,
        m.BatteryStatus: 1,
        m.EstimatorStatus: 1,
        m.ScaledPressure: 1,
        m.OpenDroneIdLocation: 1,
        m.OpenDroneIdSystem: 1,
        m.SystemTime: 1,
        m.UtmGlobalPosition: 1,
        m.Ping: 1,
        m.HomePosition: 0.5,
        m.Vibration: 0.5,
        m.CurrentEventSequence: 1 / 3,
    }
)
ARDUPILOT_REAL: Final = intervals({m.Heartbeat: 1, m.Timesync: 0.1})


@dataclass(frozen=True, slots=True)
class StreamSets:
    """What a vehicle sends unasked, by the mode of the link, and what it greets a peer with."""

    by_mode: Mapping[LinkMode, Intervals]
    greeting: tuple[type[m.Message], ...] = (m.Heartbeat, m.GpsGlobalOrigin, m.HomePosition)
    """Sent at once to a peer that was not there before."""
    groups: Groups = field(default_factory=lambda: DATA_STREAMS)
    """What REQUEST_DATA_STREAM asks for."""
    beats_at_once: frozenset[Change] = frozenset({"arming", "mode"})
    """What is followed by a HEARTBEAT out of turn."""


def _without(groups: Groups, *kinds: type[m.Message]) -> Groups:
    return {
        stream: tuple(kind for kind in group if kind not in kinds)
        for stream, group in groups.items()
    }


def same_on_all(sent: Intervals) -> StreamSets:
    return StreamSets(dict.fromkeys(LinkMode, sent))


REAL: Final[dict[Personality, StreamSets]] = {
    "px4": StreamSets(
        {LinkMode.NORMAL: PX4_NORMAL, LinkMode.ONBOARD: PX4_ONBOARD},
        (m.Heartbeat, m.GpsGlobalOrigin),
        beats_at_once=frozenset(),
    ),
    "ardupilot": replace(
        same_on_all(ARDUPILOT_REAL),
        greeting=(m.Heartbeat,),
        groups=_without(
            DATA_STREAMS,
            *(m.ExtendedSysState, m.AttitudeQuaternion, m.PositionTargetLocalNed, m.Hwstatus),
        ),
        beats_at_once=frozenset({"mode"}),
    ),
}
"""As recorded from the real ones."""


def unasked(profile: Profile) -> StreamSets:
    """What this vehicle sends unless it is told otherwise: more, and the same on every link."""
    return same_on_all(profile.intervals_ns)


def mode_of_port(port: int) -> LinkMode:
    """PX4's convention, for a link that does not say what it is."""
    return LinkMode.ONBOARD if port in ONBOARD_PORTS else LinkMode.NORMAL
