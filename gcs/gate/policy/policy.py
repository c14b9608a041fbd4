"""The policy: what is allowed, how close, how fast, how old; one object, immutable, complete.

A policy file mirrors `Policy` key for key: an attribute path here is a TOML path there.  No
field has a default: every default stands in `default.toml`, and only there, with a comment that
says what the key means.  `parse.py` lays a file's keys over those.  The annotations are the
limits that a value must keep.

Seconds, metres, metres per second.  Heights named `up_m` count from home (the take-off point),
unless a zone says otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

from gcs.gate.condition import Condition, Severity
from gcs.gate.policy.zonespec import Height, Text, ZoneSpec

MOST = 1.0e5
"""The largest value of any number: metres, seconds, metres per second."""

FromZero: TypeAlias = Annotated[float, Meta(ge=0.0, le=MOST)]
FromHundredth: TypeAlias = Annotated[float, Meta(ge=0.01, le=MOST)]
FromTenth: TypeAlias = Annotated[float, Meta(ge=0.1, le=MOST)]
FromOne: TypeAlias = Annotated[float, Meta(ge=1.0, le=MOST)]
Deceleration: TypeAlias = Annotated[float, Meta(ge=0.1, le=50.0)]
PositionAge: TypeAlias = Annotated[float, Meta(ge=0.05, le=10.0)]
HeartbeatAge: TypeAlias = Annotated[float, Meta(ge=1.0, le=60.0)]
"""The greatest ages: with older ones a vehicle that is not heard would be flown on."""
Tilt: TypeAlias = Annotated[float, Meta(ge=0.0, le=45.0)]
YawError: TypeAlias = Annotated[float, Meta(ge=1.0, le=180.0)]
ThrustError: TypeAlias = Annotated[float, Meta(ge=0.0, le=0.5)]
DeadBand: TypeAlias = Annotated[float, Meta(ge=0.0, le=0.9)]


class _Section(Struct, frozen=True, forbid_unknown_fields=True):
    """A table of the policy file."""


class Arrival(_Section, frozen=True):
    """A goal is reached nearer than `radius_m`, slower than `speed_m_s` (None: at any speed), with
    the nose within `yaw_deg` of the heading that it names (None: wherever it points), for
    `dwell_s` without a break.

    Beside the goal, not above or below it, the radius grows by the horizontal accuracy that the
    vehicle reports, up to its own acceptance radius and to `max_radius_m`.
    """

    radius_m: FromHundredth
    max_radius_m: FromHundredth
    speed_m_s: FromHundredth | None
    yaw_deg: YawError | None
    dwell_s: FromZero


class Braking(_Section, frozen=True):
    """What an autopilot is trusted to do when it is told to stop; see `stopping.py`."""

    react_s: Annotated[float, Meta(ge=0.0, le=10.0)]
    a_brake_h_m_s2: Deceleration
    a_brake_v_m_s2: Deceleration
    position_error_h_m: FromZero
    position_error_v_m: FromZero


class Approach(_Section, frozen=True):
    """How an autopilot slows down by itself: for a position that it is sent, and on a path of its
    own; see `stopping.py`."""

    react_s: Annotated[float, Meta(ge=0.0, le=10.0)]
    a_brake_h_m_s2: Deceleration
    a_brake_v_m_s2: Deceleration


class Pace(_Section, frozen=True):
    """How the speed of a vehicle that is sent to a position is governed, along one axis: level, or
    vertical; see `pace.py`.

    The speed asked for is at most `most_m_s`, no more than `gain_m_s` above the vehicle's own, and
    so low that the vehicle can slow down for its goal by `end_m_s2`.  The vehicle takes `lag_s` to
    follow a speed that falls.  The autopilot flies towards a position `d` metres away at
    `follow_per_s` d, and no faster than it can slow down for it by `follow_m_s2`.  With
    room for `past_m` past its goal it is asked for less than its speed only where its stop does not
    fit.  Without, it is asked for `near_m_s` at most, for less than its speed as long as it is
    faster than the law, and to fly back at up to `back_m_s`.
    """

    most_m_s: FromTenth
    near_m_s: FromTenth
    gain_m_s: FromTenth
    end_m_s2: Deceleration
    lag_s: Annotated[float, Meta(ge=0.0, le=10.0)]
    follow_per_s: Annotated[float, Meta(ge=0.05, le=10.0)]
    follow_m_s2: Deceleration
    past_m: Annotated[float, Meta(ge=0.0, le=100.0)]
    back_m_s: Annotated[float, Meta(ge=0.0, le=10.0)]


class Paces(_Section, frozen=True):
    """Along the ground, and up or down."""

    level: Pace
    vertical: Pace


class Overshoot(_Section, frozen=True):
    """How far an autopilot flies past a goal that it is sent: a share of its leg, and at most so
    many metres; beside the goal and above or below it."""

    share_h: Annotated[float, Meta(ge=0.0, le=1.0)]
    most_h_m: FromZero
    share_v: Annotated[float, Meta(ge=0.0, le=1.0)]
    most_v_m: FromZero


class Speeds(_Section, frozen=True):
    """The slowest speeds at which a healthy vehicle flies to a goal and turns, for deadlines."""

    cruise_m_s: FromHundredth
    climb_m_s: FromHundredth
    descend_m_s: FromHundredth
    turn_deg_s: FromOne


class TakeOffLimits(_Section, frozen=True):
    """`max_up_m` is metres above the take-off point."""

    max_up_m: FromTenth
    timeout_s: FromOne


class ControlTimes(_Section, frozen=True):
    """Taking control: how long to stream before asking, how long to wait for the heartbeat.

    Beside it: how often a hold is commanded until the heartbeat shows it, how long a request that
    ends on the ground waits for the disarmed heartbeat, and within what time a forced disarm is to
    be asked for again.
    """

    stream_s: FromZero
    timeout_s: FromTenth
    hold_every_s: FromTenth
    disarm_wait_s: FromTenth
    force_repeat_s: FromOne


class MissionRules(_Section, frozen=True):
    """`blocked_return` is about the vehicle's own failsafe return from somewhere in a mission.

    "refuse" refuses a mission where such a return leaves the fence in any way, "refuse_exclusions"
    where it enters an exclusion zone; it is told otherwise, as it always is with "warn".
    """

    blocked_return: Literal["refuse", "refuse_exclusions", "warn"]


class BatteryLimits(_Section, frozen=True):
    """From where on a battery is low, or critical: a share of its charge, and its voltage (None:
    no voltage is).  What the vehicle itself calls low or critical is so, too.

    A full battery flies for `endurance_s`: a mission is refused that would not be over before the
    battery is low.  None: the time of a mission is not judged.
    """

    low_pct: Annotated[float, Meta(ge=0.0, le=100.0)]
    critical_pct: Annotated[float, Meta(ge=0.0, le=100.0)]
    low_v: FromTenth | None
    critical_v: FromTenth | None
    endurance_s: FromOne | None


class LinkLimits(_Section, frozen=True):
    """From where on a link is poor: more frames lost than `max_lost_pct` in `window_s`, or a radio
    whose signal is not `min_radio_margin_db` above its noise."""

    max_lost_pct: Annotated[float, Meta(ge=1.0, le=100.0)]
    window_s: FromOne
    min_radio_margin_db: FromZero


class SeparationLimits(_Section, frozen=True):
    """Two vehicles that will be nearer than `least_m` within `within_s`, if each flies straight on,
    are too close, until they stay `hysteresis_m` farther apart than that."""

    least_m: FromZero
    hysteresis_m: FromZero
    within_s: Annotated[float, Meta(ge=0.0, le=60.0)]


class GpsLimits(_Section, frozen=True):
    """From where on a GPS with a fix is poor."""

    min_satellites: Annotated[int, Meta(ge=0, le=64)]
    max_hdop: FromTenth
    max_accuracy_h_m: FromTenth


class BridgeRules(_Section, frozen=True):
    """What MAVLink clients of `gcs bridge` may change on the vehicle, and what they may cost.

    "refuse" refuses it, "forward" lets it through unchanged, "on_ground" does so while the vehicle
    is disarmed on the ground.  Everything is recorded, whatever is said here.  In names of
    parameters `*` stands for any letters.
    """

    parameters: Literal["guard", "refuse", "forward"]
    parameters_allowed: tuple[Text, ...]
    parameters_guarded: tuple[Text, ...]
    fence: Literal["refuse", "forward"]
    rally: Literal["refuse", "forward"]
    home: Literal["refuse", "on_ground", "forward"]
    origin: Literal["refuse", "on_ground", "forward"]
    calibration: Literal["refuse", "on_ground"]
    reboot: Literal["refuse", "on_ground"]
    signing: Literal["refuse", "forward"]
    termination: Literal["refuse", "forward"]
    rtcm: Literal["refuse", "forward"]
    ftp_writes: Literal["refuse", "forward"]
    downloads: Literal["refuse", "on_ground", "forward"]
    on_board: Literal["verify", "refuse"]
    manual_modes: tuple[Text, ...]
    extra_denied: tuple[Text, ...]
    extra_harmless: tuple[Text, ...]
    message_hz: FromOne
    messages_hz: FromOne
    client_rate_hz: FromOne
    client_gone_s: FromOne
    max_clients: Annotated[int, Meta(ge=1, le=64)]


class ArmingRules(_Section, frozen=True):
    """`preflight`: "no_fail" refuses to arm while any row of `gcs preflight` fails."""

    preflight: Literal["off", "no_fail"]


class SigningRules(_Section, frozen=True):
    """`unsigned` is about frames without a signature on a link that has a key."""

    unsigned: Literal["refuse", "warn"]


class StreamRules(_Section, frozen=True):
    """What a client's setpoint stream may ask for, and how long one sample of it counts.

    A position older than `position_age_s` is none to judge a sample by.  Refused samples are flown
    again once they were good for `good_again_s`; a stream without a sample for `ends_after_s` is
    over.  `stick_*` is what a client's full stick asks for, and never more than the most that a
    stream may ask for; `stick_dead_band` is the share of a stick's way that counts as the middle.

    An attitude tilts by at most `tilt_deg`, and none is flown where that is 0.  A vehicle hovers at
    the thrust that it says, but for a share of `hover_thrust_error`; it has an attitude after
    `attitude_settle_s`, and accelerates by up to `attitude_error_m_s2` otherwise than that says.
    """

    deadman_s: FromTenth
    good_again_s: FromZero
    ends_after_s: FromTenth
    position_age_s: FromTenth
    max_speed_h_m_s: FromZero
    max_speed_up_m_s: FromZero
    max_speed_down_m_s: FromZero
    max_a_m_s2: FromZero
    max_yaw_rate_deg_s: FromZero
    tilt_deg: Tilt
    hover_thrust_error: ThrustError
    attitude_error_m_s2: FromZero
    attitude_settle_s: FromZero
    stick_speed_h_m_s: FromZero
    stick_speed_up_m_s: FromZero
    stick_speed_down_m_s: FromZero
    stick_yaw_rate_deg_s: FromZero
    stick_dead_band: DeadBand


class Policy(_Section, frozen=True):
    """Everything the gate decides by; `default.toml` says what each key means.

    `braking`, `approach`, `overshoot` and `pace` are by the autopilot's name; `severities` has
    every `Condition`.
    """

    name: Text

    fence: tuple[ZoneSpec, ...]
    fence_switchable: bool
    bounds_inclusive: bool
    margin_h_m: FromZero
    margin_v_m: FromZero
    mission_wind_m_s: FromZero
    max_up_m: FromZero
    min_up_m: Height
    max_distance_m: FromZero

    brake_slack_h_m: FromZero
    brake_slack_v_m: FromZero
    allow_stop_outside: bool
    creep_m: FromZero
    braking: Mapping[str, Braking]
    approach: Mapping[str, Approach]
    overshoot: Mapping[str, Overshoot]
    pace: Mapping[str, Paces]

    position_age_s: PositionAge
    stale_grace_s: FromZero
    heartbeat_age_s: HeartbeatAge
    jump_speed_m_s: FromOne

    arrival: Arrival
    speeds: Speeds
    deadline_factor: FromOne
    deadline_min_s: FromTenth
    takeoff: TakeOffLimits
    arm_timeout_s: FromOne
    land_timeout_s: FromOne
    photo_timeout_s: FromTenth
    control: ControlTimes

    battery: BatteryLimits
    link: LinkLimits
    gps: GpsLimits
    separation: SeparationLimits
    severities: Mapping[Condition, Severity]
    rtl_blocked: Literal["hold", "land", "forward"]
    mission: MissionRules
    bridge: BridgeRules
    signing: SigningRules
    stream: StreamRules
    retarget: Literal["refuse", "replace", "clients"]
    allow_force_disarm: bool
    arm_requires_recording: bool
    arming: ArmingRules

    def braking_of(self, autopilot: str) -> Braking:
        """The autopilot's own; for one that is not listed, the worst of every entry."""
        own = self.braking.get(autopilot)
        if own is not None:
            return own
        every = tuple(self.braking.values())
        return Braking(
            react_s=max(b.react_s for b in every),
            a_brake_h_m_s2=min(b.a_brake_h_m_s2 for b in every),
            a_brake_v_m_s2=min(b.a_brake_v_m_s2 for b in every),
            position_error_h_m=max(b.position_error_h_m for b in every),
            position_error_v_m=max(b.position_error_v_m for b in every),
        )

    def approach_of(self, autopilot: str) -> Approach:
        """The autopilot's own; for one that is not listed, the worst of every entry."""
        own = self.approach.get(autopilot)
        if own is not None:
            return own
        every = tuple(self.approach.values())
        return Approach(
            react_s=max(a.react_s for a in every),
            a_brake_h_m_s2=min(a.a_brake_h_m_s2 for a in every),
            a_brake_v_m_s2=min(a.a_brake_v_m_s2 for a in every),
        )

    def pace_of(self, autopilot: str) -> Paces:
        """The autopilot's own; for one that is not listed, the slowest of every entry."""
        own = self.pace.get(autopilot)
        if own is not None:
            return own
        every = tuple(self.pace.values())
        return Paces(_slowest([p.level for p in every]), _slowest([p.vertical for p in every]))

    def overshoot_of(self, autopilot: str) -> Overshoot:
        """The autopilot's own; for one that is not listed, the worst of every entry."""
        own = self.overshoot.get(autopilot)
        if own is not None:
            return own
        every = tuple(self.overshoot.values())
        return Overshoot(
            share_h=max(o.share_h for o in every),
            most_h_m=max(o.most_h_m for o in every),
            share_v=max(o.share_v for o in every),
            most_v_m=max(o.most_v_m for o in every),
        )


def _slowest(every: Sequence[Pace]) -> Pace:
    return Pace(
        most_m_s=min(p.most_m_s for p in every),
        near_m_s=min(p.near_m_s for p in every),
        gain_m_s=min(p.gain_m_s for p in every),
        end_m_s2=min(p.end_m_s2 for p in every),
        lag_s=max(p.lag_s for p in every),
        # Which autopilot follows faster: to it a position is nearer at the same speed.
        follow_per_s=max(p.follow_per_s for p in every),
        follow_m_s2=max(p.follow_m_s2 for p in every),
        past_m=0.0 if any(p.past_m == 0.0 for p in every) else max(p.past_m for p in every),
        back_m_s=min(p.back_m_s for p in every),
    )
