"""Files with signing keys: made, read, and never shown.

A file holds 64 hexadecimal digits and a line end, so that `vehicle-sim --signing-key` reads it too.
32 raw bytes are read as well, and a passphrase, whose key is its SHA-256, as in QGroundControl and
MAVProxy.
"""

from __future__ import annotations

import os
import re
import secrets
import stat
from hashlib import sha256
from pathlib import Path
from typing import Final

from gcs.wire.signing import KEY_BYTES, SecretKey

MODE: Final = 0o600
LONGEST: Final = 4096
SHORTEST_WORDS: Final = 12
"""Of a passphrase: a shorter text is rather some other file, and a key that can be guessed."""
_HEX: Final = re.compile(rb"[0-9A-Fa-f]+")


class KeyFileError(Exception):
    """A key that cannot be had or written: `str` says which file and why; `hint` what to do."""

    def __init__(self, path: str, why: str, hint: str) -> None:
        super().__init__(f"{path}: {why}")
        self.hint = hint


def new_key(path: str) -> SecretKey:
    """Make a key of 32 random bytes, in a new file that only its owner reads.

    Raises KeyFileError.
    """
    key = SecretKey(secrets.token_bytes(KEY_BYTES))
    try:
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, MODE)
        with open(handle, "wb") as file:
            file.write(key.secret.hex().encode() + b"\n")
    except FileExistsError:
        hint = "a key that is lost locks a vehicle: choose another name, or remove it yourself"
        raise KeyFileError(path, "is there already, and is not overwritten", hint) from None
    except OSError as error:
        raise KeyFileError(path, error.strerror or str(error), "can it be written?") from error
    return key


def read_key(path: str) -> SecretKey:
    """The key in a file.  Raises KeyFileError, also where others may read the file."""
    try:
        with Path(path).open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            data = file.read(LONGEST + 1)
    except OSError as error:
        hint = "`gcs key new FILE` makes a key"
        raise KeyFileError(path, error.strerror or str(error), hint) from error
    if os.name == "posix" and stat.S_ISREG(mode) and mode & 0o077:
        why = f"others may read it (its mode is {stat.S_IMODE(mode):o})"
        raise KeyFileError(path, why, f"chmod 600 {path}")
    return _key_of(path, data)


def _key_of(path: str, data: bytes) -> SecretKey:
    hint = "a key file holds 64 hexadecimal digits; `gcs key new FILE` makes one"
    if len(data) == KEY_BYTES:
        return SecretKey(data)
    line = data.rstrip(b"\r\n")
    if not line:
        raise KeyFileError(path, "is empty", hint)
    if len(line) > LONGEST or b"\n" in line:
        raise KeyFileError(path, "is no key: it has more than one line", hint)
    if not _HEX.fullmatch(line):
        if len(line) < SHORTEST_WORDS:
            why = f"is no key: {len(line)} bytes, and a passphrase has {SHORTEST_WORDS} at least"
            raise KeyFileError(path, why, hint)
        return SecretKey(sha256(line).digest())
    if len(line) != 2 * KEY_BYTES:
        # Rather a key that was cut than a passphrase.
        why = f"has {len(line)} hexadecimal digits instead of {2 * KEY_BYTES}"
        raise KeyFileError(path, why, hint)
    return SecretKey(bytes.fromhex(line.decode("ascii")))
