"""Files with signing keys."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from gcs.shell.key_files import KeyFileError, new_key, read_key
from vehicle_sim.wire.signing import parse_key

posix = pytest.mark.skipif(os.name != "posix", reason="file modes are POSIX's")


def written(path: Path, data: bytes, mode: int = 0o600) -> str:
    path.write_bytes(data)
    path.chmod(mode)
    return str(path)


def test_a_new_key_is_read_back_and_vehicle_sim_reads_the_same(tmp_path: Path) -> None:
    path = tmp_path / "a.key"
    made = new_key(str(path))
    assert read_key(str(path)) == made
    assert parse_key(path.read_bytes()).secret == made.secret
    assert new_key(str(tmp_path / "b.key")) != made


@posix
@pytest.mark.parametrize("umask", [0o000, 0o022, 0o077])
def test_only_its_owner_may_read_it_whatever_the_umask(tmp_path: Path, umask: int) -> None:
    before = os.umask(umask)
    try:
        new_key(str(tmp_path / "a.key"))
    finally:
        os.umask(before)
    assert (tmp_path / "a.key").stat().st_mode & 0o777 == 0o600


def test_a_file_that_is_there_is_not_overwritten(tmp_path: Path) -> None:
    path = written(tmp_path / "a.key", b"mine")
    with pytest.raises(KeyFileError, match="is there already") as raised:
        new_key(path)
    assert raised.value.hint
    assert (tmp_path / "a.key").read_bytes() == b"mine"


@posix
@pytest.mark.parametrize("mode", [0o644, 0o640, 0o604])
def test_a_key_that_others_may_read_is_none(tmp_path: Path, mode: int) -> None:
    path = written(tmp_path / "a.key", b"ab" * 32, mode)
    with pytest.raises(KeyFileError, match="others may read it") as raised:
        read_key(path)
    assert raised.value.hint == f"chmod 600 {path}"


@pytest.mark.parametrize("end", [b"", b"\n", b"\r\n"])
def test_what_a_file_may_hold(tmp_path: Path, end: bytes) -> None:
    raw = bytes(range(100, 132))
    assert read_key(written(tmp_path / "raw", raw)).secret == raw
    assert read_key(written(tmp_path / "hex", raw.hex().upper().encode() + end)).secret == raw
    words = read_key(written(tmp_path / "words", b"correct horse battery staple" + end))
    assert words.secret == hashlib.sha256(b"correct horse battery staple").digest()


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "is empty"),
        (b"\n", "is empty"),
        (b"ab" * 31 + b"a\n", "63 hexadecimal digits instead of 64"),
        (b"ab" * 33, "66 hexadecimal digits"),
        (b"one\ntwo\n", "more than one line"),
        (b"hello\n", "5 bytes, and a passphrase has 12 at least"),
        (b"password123", "11 bytes, and a passphrase has 12 at least"),
    ],
)
def test_what_is_no_key(tmp_path: Path, data: bytes, why: str) -> None:
    with pytest.raises(KeyFileError, match=why):
        read_key(written(tmp_path / "a.key", data))


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(KeyFileError, match="No such file"):
        read_key(str(tmp_path / "none"))
    with pytest.raises(KeyFileError):
        new_key(str(tmp_path / "no folder" / "a.key"))


def test_errors_do_not_show_the_key(tmp_path: Path) -> None:
    path = written(tmp_path / "a.key", b"cafe" * 15)
    with pytest.raises(KeyFileError) as raised:
        read_key(path)
    assert "cafe" not in f"{raised.value}{raised.value.hint}"
