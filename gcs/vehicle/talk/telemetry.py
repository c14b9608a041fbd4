"""The vehicle as it reports itself: the latest of everything, and when it came.

Reported, never assumed: nothing here is filled in from what was commanded.  Unknown is None.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin
from gcs.gate.inputs import AccuracySeen
from gcs.gate.states import LandedState
from gcs.protocol.autopilot import Autopilot, type_name
from gcs.report import Quat
from gcs.vehicle.health.battery import Charge
from gcs.vehicle.health.position_health import Estimator, Gps, PositionHealth
from gcs.vehicle.health.position_latency import Delay
from gcs.vehicle.talk.restarts import Clock
from gcs.wire.ids import MavAutopilot, MavType

POSITION_RATE_WINDOW_NS = 2_000_000_000


@dataclass(slots=True)
class Telemetry:
    """One vehicle's latest values; NED, metres, radians, integer ns of arrival."""

    sysid: int
    compid: int
    autopilot: Autopilot
    link: int
    mav_autopilot: int = MavAutopilot.GENERIC
    mav_type: int = MavType.QUADROTOR
    link_ns: int = 0

    heartbeat_ns: int = 0
    heard_ns: int = 0
    heard_again_ns: int = 0
    """Since then it is heard without a silence in which heartbeats are missing."""
    """When any message of its autopilot came."""
    was_gone: bool = False
    """Something came after a silence in which it was lost, and no heartbeat yet."""
    alive_told_ns: int = 0
    """When the gate was told of that for the last time."""
    others: int = 0
    """Heartbeats of another kind of vehicle, in its name, since its own last one."""
    armed: bool | None = None
    mode_name: str = ""
    custom_mode: int = 0
    landed: LandedState = LandedState.UNDEFINED
    landed_ns: int = 0

    pos_ned: Vec3 | None = None
    v_ned: Vec3 = (0.0, 0.0, 0.0)
    position_ns: int = 0
    time_boot_ms: int = 0
    position_age_ns: int = 1_000_000_000
    stamps: Clock = field(default_factory=Clock)
    position_came_ns: int = 0
    """When a position came, whether it was taken or not."""
    restart_known: bool = False
    """It has restarted, as other messages showed, and no position was taken since."""
    delay: Delay = field(default_factory=Delay)

    q_ned_from_frd: Quat = (1.0, 0.0, 0.0, 0.0)
    yaw_rad: float | None = None
    yaw_ns: int = 0

    global_ns: int = 0
    lat_deg: float | None = None
    lon_deg: float | None = None
    alt_amsl_m: float | None = None
    alt_rel_m: float | None = None

    origin: Origin | None = None
    home: tuple[float, float, float] | None = None
    home_ned: Vec3 | None = None
    return_up_m: float | None = None
    return_told: bool = False  # its return height is known, or it says that it has none
    return_void: bool = False  # it was known, and may be another one since a restart
    failsafes: tuple[str, ...] = ()
    """What it does by itself in each case, in words, once its settings were read."""
    mends: tuple[str, ...] = ()
    """The commands that set right which of these are off or weak."""
    accuracy_told: AccuracySeen | None = None
    acceptance_m: float | None = None  # how near a waypoint it takes it as reached itself

    health: PositionHealth = field(default_factory=lambda: PositionHealth(Gps(), Estimator()))
    prearm_ok: bool | None = None
    prearm_healthy: bool = False
    """The same bit of a PX4 1.14, which does not say that it has it: not set, it says nothing."""
    battery_pct: float | None = None
    battery_v: float | None = None
    charge: Charge = field(default_factory=Charge)

    mission_seq: int | None = None
    mission_reached: int = -1

    rx_count: int = 0
    rx_window_start_ns: int = 0
    rx_hz: float = 0.0
    setpoints_sent: list[int] = field(default_factory=list)

    @property
    def label(self) -> str:
        """Short name for a screen: ids, autopilot and type."""
        return f"{self.sysid}/{self.compid} {self.autopilot.name} {type_name(self.mav_type)}"

    def forget(self) -> None:
        """The vehicle restarted or was away: what it told of itself may be otherwise now."""
        self.forget_place()
        self.charge = Charge()
        self.return_void |= self.return_up_m is not None
        self.return_up_m, self.return_told = None, False
        self.failsafes, self.acceptance_m, self.prearm_ok = (), None, None
        self.prearm_healthy = False
        self.mission_seq, self.mission_reached = None, -1

    def forget_place(self) -> None:
        """The vehicle restarted or was away: where its local frame lies is not known any more."""
        self.origin = self.home = self.home_ned = None
        self.delay = Delay(self.delay.times)
        self.landed = LandedState.UNDEFINED
        self.health = PositionHealth(Gps(), Estimator())

    def count_frames(self, many: int, now_ns: int) -> None:
        """So many more frames; the rate is renewed every two seconds."""
        self.rx_count += many
        span_ns = now_ns - self.rx_window_start_ns
        if span_ns >= POSITION_RATE_WINDOW_NS:
            self.rx_hz = self.rx_count * 1e9 / span_ns
            self.rx_count = 0
            self.rx_window_start_ns = now_ns

    def count_setpoint(self, now_ns: int) -> None:
        """Times of the setpoints of the last two seconds, for the rate on the screen."""
        self.setpoints_sent.append(now_ns)
        while self.setpoints_sent[0] < now_ns - 2_000_000_000:
            del self.setpoints_sent[0]

    def setpoint_hz(self, now_ns: int) -> float:
        """Rate over the intervals of the last two seconds, 0 once the stream has stopped."""
        recent = [t for t in self.setpoints_sent if t > now_ns - 2_000_000_000]
        if len(recent) < 2 or now_ns - recent[-1] > 250_000_000:
            return 0.0
        return (len(recent) - 1) * 1e9 / (recent[-1] - recent[0])
