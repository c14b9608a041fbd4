"""FILE_TRANSFER_PROTOCOL: lists are free, reading and writing are by policy.

The payload is that of https://mavlink.io/en/services/ftp.html: seq (2 bytes), session, opcode,
size, req_opcode, burst_complete, padding, offset (4 bytes), data.
"""

from __future__ import annotations

import re
from typing import Final

from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Judgement, Refused, by_choice
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import FtpError, FtpOpcode
from gcs.wire.messages import FileTransferProtocol
from gcs.wire.text import clean

KEY: Final = "policy: bridge.ftp_writes"
PAYLOAD: Final = 251
HEADER: Final = 12
_OPCODE, _SIZE = 3, 4

LIST_WITH_TIME: Final = 16
"""ListDirectoryWithTime, which pymavlink has and the dialect not yet.  MAVProxy 1.8.75 tries it
first: a vehicle that does not know it says so (NAK, UnknownCommand), and it lists without times."""
READS: Final = frozenset(
    {
        FtpOpcode.NONE,
        FtpOpcode.TERMINATESESSION,
        FtpOpcode.RESETSESSION,
        FtpOpcode.LISTDIRECTORY,
        FtpOpcode.OPENFILERO,
        FtpOpcode.READFILE,
        FtpOpcode.CALCFILECRC,
        FtpOpcode.BURSTREADFILE,
        LIST_WITH_TIME,
    }
)
CONTENT: Final = frozenset(
    {FtpOpcode.OPENFILERO, FtpOpcode.READFILE, FtpOpcode.BURSTREADFILE, FtpOpcode.CALCFILECRC}
)
"""Reads that fill the link, or keep the vehicle busy with its card."""
WRITES: Final = {
    FtpOpcode.CREATEFILE: "creating a file",
    FtpOpcode.WRITEFILE: "writing into a file",
    FtpOpcode.REMOVEFILE: "removing a file",
    FtpOpcode.CREATEDIRECTORY: "creating a folder",
    FtpOpcode.REMOVEDIRECTORY: "removing a folder",
    FtpOpcode.OPENFILEWO: "opening a file to write into it",
    FtpOpcode.TRUNCATEFILE: "cutting a file",
    FtpOpcode.RENAME: "renaming a file",
}
ANSWERS: Final = frozenset({FtpOpcode.ACK, FtpOpcode.NAK})

_SYSTEM_FILE: Final = re.compile(rb"(?:^|[/\0])(@[^/\0]*)")
"""ArduPilot's @PARAM, @MISSION, @SYS: a file that is written there is a set of parameters, a
mission, a fence, taken over past every check."""


def is_read(payload: tuple[int, ...]) -> bool:
    """Whether it changes nothing on board."""
    return payload[_OPCODE] in READS


def judge_file(message: FileTransferProtocol, rules: BridgeRules, seen: GuardSeen) -> Judgement:
    payload = message.payload
    opcode = payload[_OPCODE]
    if is_read(payload):
        judged = by_choice(rules.downloads, "downloads", "reading a file", seen)
        if opcode not in CONTENT or isinstance(judged, Allowed):
            return Allowed()
        code, sentence = judged.refusal.code, judged.refusal.sentence
        return _refused(message, seen, FtpError.FILEPROTECTED, code, sentence)
    if opcode in ANSWERS:
        sentence = "an answer of the file transfer, which nobody has asked a client for"
        return Refused(Refusal(Code.UNSUPPORTED, sentence))
    if opcode not in WRITES:
        sentence = f"opcode {opcode} of the file transfer is not known here"
        return _refused(message, seen, FtpError.UNKNOWNCOMMAND, Code.UNSUPPORTED, sentence)
    what = WRITES[FtpOpcode(opcode)]
    if payload[_SIZE] > PAYLOAD - HEADER:
        sentence = f"{what}: {payload[_SIZE]} bytes of data do not fit"
        return _refused(message, seen, FtpError.INVALIDDATASIZE, Code.POLICY, sentence)
    writes_data = opcode == FtpOpcode.WRITEFILE
    path = "" if writes_data else _path(payload)
    named = f"{what}, {path!r}," if path else what
    if rules.ftp_writes == "refuse":
        sentence = f"{named} is not allowed ({KEY})"
        return _refused(message, seen, FtpError.FILEPROTECTED, Code.POLICY, sentence)
    # All of the data, whatever its size is said to be: the vehicle may read a path to its NUL.
    system = None if writes_data else _SYSTEM_FILE.search(bytes(payload[HEADER:]))
    if system is not None:
        files = clean(system[1].decode("utf-8", "replace"))
        sentence = f"{named} is never allowed: what is written to {files} is the vehicle's set-up"
        return _refused(message, seen, FtpError.FILEPROTECTED, Code.POLICY, sentence)
    return Allowed("" if writes_data else f"{named} is forwarded")


def _path(payload: tuple[int, ...]) -> str:
    """The path that an opcode is about; of a renaming both, with a blank between."""
    data = bytes(payload[HEADER : HEADER + payload[_SIZE]])
    paths = [part.decode("utf-8", "replace") for part in data.split(b"\0") if part]
    return " ".join(paths)


def _refused(
    message: FileTransferProtocol, seen: GuardSeen, error: FtpError, code: Code, sentence: str
) -> Refused:
    """With the negative answer that the client waits for."""
    asked = message.payload
    seq = (asked[0] | asked[1] << 8) + 1 & 0xFFFF
    head = (seq & 0xFF, seq >> 8, asked[2], int(FtpOpcode.NAK), 1, asked[_OPCODE])
    payload = (*head, 0, 0, *asked[8:HEADER], int(error))
    answer = FileTransferProtocol(
        target_network=0,
        target_system=seen.client.sysid,
        target_component=seen.client.compid,
        payload=payload + (0,) * (PAYLOAD - len(payload)),
    )
    return Refused(Refusal(code, sentence), (answer,))
