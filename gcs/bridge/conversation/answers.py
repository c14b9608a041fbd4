"""What a client is told in MAVLink: acknowledgements and texts.

COMMAND_ACK.result_param2 has the number of the reason code: its place in `gcs.gate.refusal.Code`,
from 1 up (docs/bridge.md lists them).
"""

from __future__ import annotations

from typing import Final

from gcs import ipc
from gcs.gate.effects import Level
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.ids import MavFrame, MissionResult, Result, Severity
from gcs.wire.messages import CommandAck, MissionAck, OrbitExecutionStatus, Statustext

NUMBER_OF: Final = {code: number for number, code in enumerate(Code, start=1)}
"""Reason code -> its number on the wire."""

MAY_HELP_LATER: Final = frozenset(
    {
        Code.BUSY,
        Code.STALE,
        Code.NO_POSITION,
        Code.CONTROL_PENDING,
        Code.HOLDING,
        Code.OTHER_OPERATOR,
        Code.OTHER_VEHICLE,
        Code.SEVERITY,
        Code.RECORDER_DOWN,
        Code.PREFLIGHT,
        Code.SUPERSEDED,
        Code.NO_VEHICLE,
        Code.NO_ORIGIN,
        Code.NOT_ARMED,
        Code.NOT_FLYING,
        Code.IN_AIR,
    }
)
"""Reasons that pass: the same command may be accepted a little later, or after another one (an
arming, a take-off, a landing).  Recorded of PX4 1.14: a disarming in the air is answered so."""

UNSUPPORTED: Final = frozenset({Code.UNSUPPORTED, Code.UNSUPPORTED_VEHICLE})

FAILED: Final = frozenset({Code.NO_ANSWER, Code.DEADLINE, Code.LINK_LOST})
"""It was begun, and did not work."""

TEXT_LETTERS: Final = 50
"""STATUSTEXT.text; a longer text is sent in pieces with the same id (MAVLink 2)."""

SEVERITIES: Final = {
    Level.DEBUG: Severity.DEBUG,
    Level.INFO: Severity.INFO,
    Level.WARNING: Severity.WARNING,
    Level.ERROR: Severity.ERROR,
    Level.FATAL: Severity.CRITICAL,
}


def result_of(code: Code) -> Result:
    """MAV_RESULT of a refusal."""
    if code in MAY_HELP_LATER:
        return Result.TEMPORARILY_REJECTED
    if code in UNSUPPORTED:
        return Result.UNSUPPORTED
    return Result.FAILED if code in FAILED else Result.DENIED


def acknowledgement(
    command: int, result: int, to: Address, code: Code | None = None, progress: int = 0
) -> CommandAck:
    """COMMAND_ACK for whoever sent the command; `code` says why where it is refused."""
    return CommandAck(
        command=command,
        result=result,
        progress=progress,
        result_param2=NUMBER_OF[code] if code else 0,
        target_system=to.sysid,
        target_component=to.compid,
    )


def item_acknowledgement(result: int, to: Address) -> MissionAck:
    """MISSION_ACK for whoever sent a mission item that is to be flown to at once."""
    accepted = result == Result.ACCEPTED
    return MissionAck(
        target_system=to.sysid,
        target_component=to.compid,
        type=MissionResult.ACCEPTED if accepted else MissionResult.DENIED,
    )


def texts(level: Level, text: str, text_id: int) -> list[Statustext]:
    """STATUSTEXT, in pieces where it is long; `text_id` 1 to 65535 joins them.

    Letters outside ASCII are replaced: a piece is cut at a byte.  Pieces that would all be full are
    followed by one that holds a blank.
    """
    plain = text.encode("ascii", "replace").decode("ascii")
    severity = int(SEVERITIES[level])
    if len(plain) <= TEXT_LETTERS:
        return [Statustext(severity=severity, text=plain)]
    pieces = [plain[at : at + TEXT_LETTERS] for at in range(0, len(plain), TEXT_LETTERS)]
    if len(pieces[-1]) == TEXT_LETTERS:
        # "Any null character in the text field is taken to mean this was the last chunk"
        # (common.xml, STATUSTEXT.chunk_seq): a full piece has none, so another one must follow it.
        # ArduPilot sends an empty one, which QGroundControl shows as a missing one, " ... "
        # (StatusTextHandler.cc); a blank ends the text as well and is not seen.
        pieces.append(" ")
    return [
        Statustext(severity=severity, text=piece, id=text_id, chunk_seq=number)
        for number, piece in enumerate(pieces)
    ]


def orbit_status(told: ipc.OrbitEvent) -> OrbitExecutionStatus | None:
    """An orbit as a PX4 tells of its own; None where its place on the map is not known."""
    if told.centre_lat_lon_amsl is None:
        return None
    lat_deg, lon_deg, alt_amsl_m = told.centre_lat_lon_amsl
    return OrbitExecutionStatus(
        time_usec=told.time_ns // 1000,
        radius=told.radius_m,
        frame=MavFrame.GLOBAL,
        x=round(lat_deg * 1e7),
        y=round(lon_deg * 1e7),
        z=alt_amsl_m,
    )
