"""The signature of a record, in a file beside it: whoever alters the record cannot make it anew.

The seals inside a record (`parts.py`) are checksums without a key, which find accidents.  This is
an HMAC-SHA256 (RFC 2104) over all bytes of the file, with a key as `gcs key new` makes it.
"""

from __future__ import annotations

import hmac
from hashlib import sha256
from pathlib import Path
from typing import Final

from gcs.wire.signing import SecretKey

TITLE: Final = "mavgate record signature 1"
_PIECE_BYTES: Final = 1 << 20


def signature_path(record: Path) -> Path:
    """`flight.mcap.sig` beside `flight.mcap`."""
    return record.with_name(f"{record.name}.sig")


def sign(record: Path, key: SecretKey) -> Path:
    """Write the signature, in place of an earlier one; where it is.  Raises OSError."""
    path = signature_path(record)
    path.write_text(_text(record, key), encoding="ascii")
    return path


def why_not_signed(record: Path, key: SecretKey) -> str:
    """Why the record is not as it was signed; empty where it is.  Raises OSError."""
    try:
        found = signature_path(record).read_bytes()
    except FileNotFoundError:
        return f"it has no signature ({signature_path(record).name} is not there)"
    if hmac.compare_digest(found, _text(record, key).encode()):
        return ""
    if key.fingerprint.encode() not in found:
        return f"it was signed with another key than {key.fingerprint}"
    return "its signature is not right: it was altered after it was signed"


def _text(record: Path, key: SecretKey) -> str:
    # The title keeps what is signed here apart from MAVLink frames that are signed with the key.
    made = hmac.new(key.secret, TITLE.encode(), sha256)
    with record.open("rb") as file:
        while piece := file.read(_PIECE_BYTES):
            made.update(piece)
    return f"{TITLE}\n{key.fingerprint} {made.hexdigest()}\n"
