"""What was recorded of an input, and the input that it was."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, TypeAlias, cast, get_args

import msgspec
from msgspec.structs import replace

from gcs.audit.messages import Attachments, Stored
from gcs.gate.policy.parse import DEFAULT
from gcs.record.parts import PartBegan, Seal
from gcs.session.as_recorded import AsRecorded
from gcs.session.inputs import TAGS, Datagram, FileRead, Input, OtherInput
from gcs.vehicle.record_items import FaultKept, FileKept, Pieces, Start, attachment_name
from gcs.wire.blanking import may_hold_key
from gcs.wire.frame import Frame, Reason, split


class CannotReadError(Exception):
    """A recorded input that this version does not understand: why."""


Kept: TypeAlias = OtherInput | Start | Pieces | FaultKept | Seal | PartBegan
"""What a message of `/session/input` holds; a Seal is a tick or the end, by its kind."""

NO_FRAME: Final = frozenset(reason.value for reason in Reason)
"""Why bytes are garbage; frames that are refused are recorded as such for other reasons."""

_KINDS: dict[str, type[Any]] = {TAGS[kind]: kind for kind in get_args(OtherInput)}
_KINDS |= {
    "Datagram": Pieces,
    "FileRead": FileKept,
    "Fault": FaultKept,
    "RecordTick": Seal,
    "RecordEnd": Seal,
    "RecordPart": PartBegan,
}
_decoders = {name: msgspec.json.Decoder(kind) for name, kind in _KINDS.items()}
_inputs: dict[str, type[Any]] = {TAGS[kind]: kind for kind in get_args(Input)}


def kept_of(kind: str, data: bytes, attachments: Attachments) -> Kept:
    """Raises CannotReadError."""
    try:
        if kind == "Setup":
            return start_of(data)
        decoder = _decoders.get(kind)
        if decoder is None:
            raise CannotReadError(f"there is no input {kind!r}")
        kept = decoder.decode(data)
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise CannotReadError(f"{kind}: {error}") from error
    return _file_read(kept, attachments) if isinstance(kept, FileKept) else cast("Kept", kept)


_UNTOLD: Final = replace(DEFAULT, arrival=replace(DEFAULT.arrival, yaw_deg=None))
"""The default, but that no heading is waited for: no version without that key did so."""


def start_of(data: bytes) -> Start:
    """The set-up, with what another version did for what it did not have in its policy.

    Raises msgspec.MsgspecError where it cannot be read.
    """
    tree = msgspec.json.decode(data)
    if not isinstance(tree, dict) or "setup" not in tree:
        raise msgspec.ValidationError("it does not hold what a session is made with")
    try:
        return msgspec.convert(tree, Start)
    except msgspec.ValidationError:
        setup = tree["setup"]
        if not isinstance(setup, dict):
            raise
        setup["policy"] = _overlaid(msgspec.to_builtins(_UNTOLD), setup.get("policy"))
        return msgspec.convert(tree, Start)


def _overlaid(default: Any, own: Any) -> Any:  # two trees of JSON
    if not (isinstance(default, dict) and isinstance(own, dict)):
        return own
    return {key: _overlaid(value, own.get(key, value)) for key, value in default.items()}


def input_of_fault(kept: FaultKept) -> Input:
    """The input at which there was an exception.  Raises CannotReadError."""
    kind = _inputs.get(kept.kind)
    if kind is None or bytes(kept.input) == b"null":
        raise CannotReadError(f"the {kept.kind} that raised was not recorded")
    try:
        return cast("Input", msgspec.json.decode(kept.input, type=kind))
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise CannotReadError(f"{kept.kind}: {error}") from error


def _file_read(kept: FileKept, attachments: Attachments) -> FileRead:
    if kept.size < 0:
        return FileRead(kept.token, kept.path, None, kept.error)
    for data in attachments.get(kept.attachment, ()):
        if len(data) == kept.size and attachment_name(kept.path, data) == kept.attachment:
            return FileRead(kept.token, kept.path, data, kept.error)
    raise CannotReadError(f"what was read of {kept.path} is not attached, or was altered")


def datagram_of(pieces: Pieces, parts: Sequence[Stored], rest_before: bytes) -> Datagram:
    """The bytes as they came: without what an earlier read of the stream had brought.

    Where a key was kept out of the record, its bytes are others than came, and are not split anew.
    Each frame must be one all the same.  Raises CannotReadError.
    """
    raws = [part.raw for part in parts]
    whole = b"".join(raws) + pieces.rest
    data = whole[len(rest_before) :]
    if not (may_hold_key(whole) or may_hold_key(rest_before)):
        return Datagram(pieces.link, data)
    words = [part.why if part.is_garbage and part.why in NO_FRAME else "" for part in parts]
    for part, raw, why in zip(parts, raws, words, strict=True):
        if not why and [*map(type, split(raw))] != [Frame]:
            raise CannotReadError(f"a message of {part.topic} holds no frame")
    split_so = AsRecorded(tuple(zip(raws, words, strict=True)), pieces.rest)
    return Datagram(pieces.link, data, as_recorded=split_so)
