"""What the station asks of a vehicle that it has just met: streams, origin, home.

An ArduPilot sends next to nothing until asked, a PX4 sends most of it unasked; asking both is
harmless, and a refused request is no error: what is needed and does not come shows up as STALE
or NO_ORIGIN, with its reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gcs.session.speedup_waits import Times
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandLong

WANTED_HZ: tuple[tuple[MsgId, float], ...] = (
    (MsgId.EXTENDED_SYS_STATE, 5.0),
    (MsgId.LOCAL_POSITION_NED, 30.0),
    (MsgId.ATTITUDE, 20.0),
    (MsgId.GLOBAL_POSITION_INT, 5.0),
    (MsgId.SYS_STATUS, 2.0),
    (MsgId.MISSION_CURRENT, 2.0),
    (MsgId.GPS_RAW_INT, 2.0),
    (MsgId.ESTIMATOR_STATUS, 2.0),
    (MsgId.EKF_STATUS_REPORT, 2.0),
    (MsgId.BATTERY_STATUS, 1.0),
    (MsgId.POSITION_TARGET_LOCAL_NED, 5.0),
    (MsgId.FENCE_STATUS, 1.0),
)

FOR_THE_RECORD_HZ: dict[int, float] = {
    MsgId.ATTITUDE_TARGET: 5.0,
    MsgId.SERVO_OUTPUT_RAW: 4.0,
    MsgId.VIBRATION: 1.0,
    MsgId.RC_CHANNELS: 1.0,
    MsgId.WIND: 1.0,
}
"""What an ArduPilot is asked for once, when all that is needed has come, so that a report can tell
of motors, sticks, vibration and wind: it sends none of them unasked.  A PX4 does, and more often.
No safety stands on them, so clients of the bridge may change their rates."""

SENT_BY: dict[int, str] = {
    MsgId.ESTIMATOR_STATUS: "px4",
    MsgId.EKF_STATUS_REPORT: "ardupilot",
    MsgId.FENCE_STATUS: "ardupilot",
}
"""Which of the two knows it.  An ArduCopter that is asked for ESTIMATOR_STATUS answers to everybody
with a text, "No ap_message for mavlink id (230)" (recorded of 4.7)."""

FASTEST_HZ = 200.0
"""Of real seconds; a sped-up vehicle is asked for its positions that much more often."""


def needed_hz(times: Times) -> dict[int, float]:
    """How often the station needs which message, on the vehicle's clock."""
    return {msgid: min(hz * times.speedup, FASTEST_HZ) for msgid, hz in WANTED_HZ}


ASK_AGAIN_NS = 2_000_000_000
"""Wait between two requests for what did not come."""
LONGEST_PAUSE_NS = 30_000_000_000
"""Streams that have stopped are asked for again after a pause that doubles up to this."""


class Discovery:
    """All that is not there is asked for when a vehicle appears; then only what did not come."""

    def __init__(self, times: Times) -> None:
        self._needed_hz = needed_hz(times)
        self._ask_again_ns = times.real_ns(ASK_AGAIN_NS)
        self._asked_ns = 0
        self._longest_ns = times.real_ns(LONGEST_PAUSE_NS)
        self._pause_ns = self._ask_again_ns
        self._record_asked = False
        self._streams_asked_ns = 0
        self._silence_told = False

    def start(self) -> None:
        """A vehicle appeared: `missing` tells which commands to send."""
        self._asked_ns = 0
        self._pause_ns = self._ask_again_ns

    def silence(self, telemetry: Telemetry, now_ns: int) -> str:
        """That its positions stopped, though it is heard, where that is news: streams are asked
        for again, as a vehicle that restarted sends none.  Before `missing`."""
        if not self._silent(telemetry, now_ns):
            self._silence_told, self._pause_ns = False, self._ask_again_ns
            return ""
        told, self._silence_told = self._silence_told, True
        said = f"vehicle {telemetry.label} is heard and sends no positions any more"
        return "" if told else f"{said}: it is asked for its streams again"

    def _silent(self, telemetry: Telemetry, now_ns: int) -> bool:
        """It is heard, and has been for long enough since its last position."""
        if now_ns - telemetry.heard_ns >= self._ask_again_ns:
            return False  # nothing at all comes, which is another trouble
        came_ns = telemetry.position_came_ns
        since_ns = max(came_ns, telemetry.heard_again_ns)
        return came_ns > 0 and telemetry.heard_ns - since_ns > self._ask_again_ns

    def missing(self, telemetry: Telemetry, now_ns: int) -> Iterator[CommandLong]:
        """Commands that ask for what is not there: all at first, then what did not come."""
        first = self._asked_ns == 0
        if not first and now_ns - self._asked_ns < self._ask_again_ns:
            return
        self._asked_ns = now_ns
        if telemetry.origin is None:
            yield _request(telemetry, MsgId.GPS_GLOBAL_ORIGIN)
        if telemetry.home is None:
            yield _request(telemetry, MsgId.HOME_POSITION)
        if first:
            yield _request(telemetry, MsgId.AUTOPILOT_VERSION)
        everything = first or telemetry.pos_ned is None
        if self._silent(telemetry, now_ns) and now_ns - self._streams_asked_ns >= self._pause_ns:
            everything = True
            self._pause_ns = min(2 * self._pause_ns, self._longest_ns)
        if everything:
            self._streams_asked_ns = now_ns
        if everything:
            yield from self.again(telemetry, self._needed_hz)
        elif now_ns - telemetry.landed_ns > self._ask_again_ns:
            yield from self.again(telemetry, (MsgId.EXTENDED_SYS_STATE,))
        elif telemetry.autopilot.name == "ardupilot" and not self._record_asked:
            # Such commands wait for one another's answers, so these do not come first.
            self._record_asked = True
            for msgid, hz in FOR_THE_RECORD_HZ.items():
                yield message_interval(telemetry, msgid, hz)

    def again(self, telemetry: Telemetry, msgids: Iterable[int]) -> Iterator[CommandLong]:
        """Commands that ask for these streams, as far as its autopilot has them."""
        other = {"px4": "ardupilot", "ardupilot": "px4"}.get(telemetry.autopilot.name)
        for msgid in msgids:
            if other is None or SENT_BY.get(msgid) != other:
                yield message_interval(telemetry, msgid, self._needed_hz[msgid])


def _request(telemetry: Telemetry, msgid: MsgId) -> CommandLong:
    return _command(telemetry, Cmd.REQUEST_MESSAGE, float(msgid), 0.0)


def message_interval(telemetry: Telemetry, msgid: int, rate_hz: float) -> CommandLong:
    """SET_MESSAGE_INTERVAL: the vehicle is to send `msgid` at `rate_hz` of its own clock."""
    return _command(telemetry, Cmd.SET_MESSAGE_INTERVAL, float(msgid), round(1e6 / rate_hz))


def _command(telemetry: Telemetry, command: Cmd, param1: float, param2: float) -> CommandLong:
    return CommandLong(
        param1=param1,
        param2=param2,
        param3=0.0,
        param4=0.0,
        param5=0.0,
        param6=0.0,
        param7=0.0,
        command=command,
        target_system=telemetry.sysid,
        target_component=telemetry.compid,
        confirmation=0,
    )
