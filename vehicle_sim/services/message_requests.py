"""REQUEST_MESSAGE: which messages each autopilot does not give, and what it answers then."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.wire import messages as m

VIDEO_STREAM_INFORMATION: Final = 269
GIMBAL_INFORMATION: Final = 280  # GIMBAL_MANAGER_INFORMATION


@dataclass(frozen=True, slots=True)
class Requests:
    """REQUEST_MESSAGE: the results for what cannot be had, and for which messages they are.

    `never`: built here for other ends, and not to be had from the real one.  `accepted`: the real
    one takes the request for these and sends nothing.
    """

    unknown: Result
    nothing_yet: Result
    never: frozenset[int]
    accepted: frozenset[int]


PX4_REQUESTS: Final = Requests(
    Result.DENIED,
    Result.DENIED,
    never=frozenset(
        m.IDS[kind]
        for kind in (
            m.MissionCurrent,
            m.NavControllerOutput,
            m.MessageInterval,
            m.AvailableModes,
            m.CurrentMode,
            m.AvailableModesMonitor,
            m.EkfStatusReport,
            m.Hwstatus,
            m.Meminfo,
            m.PowerStatus,
            m.AttitudeTarget,
            m.PositionTargetLocalNed,
            m.CurrentEventSequence,
            m.EscInfo,
            m.EscStatus,
        )
    ),
    accepted=frozenset(),
)
ARDUPILOT_REQUESTS: Final = Requests(
    Result.FAILED,
    Result.ACCEPTED,
    never=frozenset(
        m.IDS[kind]
        for kind in (
            m.Altitude,
            m.EstimatorStatus,
            m.WindCov,
            m.ProtocolVersion,
            m.OrbitExecutionStatus,
            m.CurrentMode,
            m.Hwstatus,
            m.Timesync,
            m.Ping,
            m.Odometry,
            m.UtmGlobalPosition,
            m.ActuatorOutputStatus,
            m.EscInfo,
            m.EscStatus,
            m.OpenDroneIdLocation,
            m.OpenDroneIdSystem,
        )
    ),
    accepted=frozenset({m.IDS[m.ParamValue], VIDEO_STREAM_INFORMATION, GIMBAL_INFORMATION}),
)
