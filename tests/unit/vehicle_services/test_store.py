"""Both stores keep the same promises, and neither lets a path out of its root."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_sim.shell.files import DiskStore
from vehicle_sim.storage.store import (
    DirectoryEntry,
    MemoryStore,
    Store,
    StoreError,
    StoreFault,
    crc32,
    parts_of,
    put,
)


@pytest.fixture(params=["memory", "disk"])
def store(request: pytest.FixtureRequest, tmp_path: Path) -> Store:
    """Room for 1000 bytes."""
    root = tmp_path / "root"
    root.mkdir()
    (tmp_path / "secret").write_bytes(b"secret")
    return MemoryStore(bytes_max=1000) if request.param == "memory" else DiskStore(root, 1000)


def fault(request: Callable[[], object]) -> StoreFault:
    with pytest.raises(StoreError) as refusal:
        request()
    return refusal.value.fault


def test_what_is_put_is_read_back_in_parts(store: Store) -> None:
    put(store, "log/2026/one.bin", b"0123456789")
    assert store.size("/log/2026/one.bin") == 10
    assert store.read("log/2026/one.bin", 3, 4) == b"3456"
    assert store.read("log/2026/one.bin", 8, 4) == b"89"
    assert store.read("log/2026/one.bin", 10, 4) == b""


def test_a_directory_is_listed_by_name(store: Store) -> None:
    put(store, "b.txt", b"two")
    put(store, "a/x.txt", b"")
    store.make_directory("c")
    assert store.entries("") == [
        DirectoryEntry("a", 0, True),
        DirectoryEntry("b.txt", 3, False),
        DirectoryEntry("c", 0, True),
    ]
    assert store.entries("/a/") == [DirectoryEntry("x.txt", 0, False)]


def test_writing_past_the_end_fills_with_zeros_and_truncating_cuts(store: Store) -> None:
    store.create("f")
    store.write("f", 4, b"end")
    assert store.read("f", 0, 99) == b"\0\0\0\0end"
    store.write("f", 0, b"x")
    store.truncate("f", 5)
    assert store.read("f", 0, 99) == b"x\0\0\0e"
    store.truncate("f", 7)
    assert store.read("f", 0, 99) == b"x\0\0\0e\0\0"


def test_creating_again_empties(store: Store) -> None:
    put(store, "f", b"old")
    store.create("f")
    assert store.size("f") == 0


def test_a_directory_moves_with_all_that_is_in_it(store: Store) -> None:
    put(store, "a/b/f", b"here")
    store.make_directory("t")
    store.rename("a", "t/z")
    assert store.read("t/z/b/f", 0, 9) == b"here"
    assert fault(lambda: store.entries("a")) is StoreFault.NOT_FOUND


def test_what_cannot_be_is_refused_by_its_name(store: Store) -> None:
    put(store, "d/f", b"data")
    put(store, "g", b"other")
    assert fault(lambda: store.size("none")) is StoreFault.NOT_FOUND
    assert fault(lambda: store.create("none/f")) is StoreFault.NOT_FOUND
    assert fault(lambda: store.write("none", 0, b"x")) is StoreFault.NOT_FOUND
    assert fault(lambda: store.remove("none")) is StoreFault.NOT_FOUND
    assert fault(lambda: store.size("d")) is StoreFault.WRONG_KIND
    assert fault(lambda: store.remove("d")) is StoreFault.WRONG_KIND
    assert fault(lambda: store.create("d")) is StoreFault.WRONG_KIND
    assert fault(lambda: store.entries("g")) is StoreFault.WRONG_KIND
    assert fault(lambda: store.make_directory("d")) is StoreFault.EXISTS
    assert fault(lambda: store.rename("g", "d/f")) is StoreFault.EXISTS
    assert fault(lambda: store.rename("d", "d/e")) is StoreFault.BAD_PATH
    assert fault(lambda: store.remove_directory("d")) is StoreFault.NOT_EMPTY
    assert fault(lambda: store.remove_directory("/")) is StoreFault.PROTECTED
    assert fault(lambda: store.rename("", "e")) is StoreFault.PROTECTED
    assert store.read("d/f", 0, 9) == b"data"
    assert store.read("g", 0, 9) == b"other"


def test_a_full_store_takes_no_more_until_something_goes(store: Store) -> None:
    put(store, "f", bytes(900))
    store.create("g")
    assert fault(lambda: store.write("g", 0, bytes(101))) is StoreFault.NO_SPACE
    assert fault(lambda: store.truncate("g", 4_000_000_000)) is StoreFault.NO_SPACE
    assert store.size("g") == 0
    store.truncate("f", 100)
    store.write("g", 0, bytes(101))
    store.remove("f")
    store.write("g", 101, bytes(899))
    assert fault(lambda: store.write("g", 999, b"xy")) is StoreFault.NO_SPACE


def test_a_store_in_memory_bounds_the_number_of_entries() -> None:
    store = MemoryStore(entries_max=3)
    for name in ("a", "b"):
        store.create(name)
    store.make_directory("c")
    assert fault(lambda: store.create("d")) is StoreFault.NO_SPACE
    assert fault(lambda: store.make_directory("e")) is StoreFault.NO_SPACE


OUTSIDE = [
    "../secret",
    "a/../../secret",
    "/..",
    "..\\secret",
    "C:secret",
    "a\0b",
    "a\nb",
    "a\tb",
    ". /x",
    "... ",
    "x" * 129,
    "/".join("y" * 17),
    "é" * 120,
    "\udcff",
]


@pytest.mark.parametrize("path", OUTSIDE)
def test_a_path_that_leads_elsewhere_is_none(store: Store, path: str) -> None:
    assert fault(lambda: store.size(path)) is StoreFault.BAD_PATH
    assert fault(lambda: store.create(path)) is StoreFault.BAD_PATH
    assert fault(lambda: store.entries(path)) is StoreFault.BAD_PATH
    assert fault(lambda: store.make_directory(path)) is StoreFault.BAD_PATH
    put(store, "f", b"x")
    assert fault(lambda: store.rename("f", path)) is StoreFault.BAD_PATH


@given(st.text(max_size=40))
def test_a_path_is_refused_or_stays_inside(path: str) -> None:
    try:
        parts = parts_of(path)
    except StoreError:
        return
    root = Path("/root/of/all")
    assert root in [*(inside := Path(os.path.normpath(root.joinpath(*parts)))).parents, inside]


def test_the_disk_store_follows_no_link(tmp_path: Path) -> None:
    root = tmp_path / "root"
    (root / "d").mkdir(parents=True)
    secret = tmp_path / "secret"
    secret.write_bytes(b"secret")
    (root / "file").symlink_to(secret)
    (root / "up").symlink_to(tmp_path)
    (root / "inside").symlink_to(root / "d")
    store = DiskStore(root)
    assert store.entries("") == [DirectoryEntry("d", 0, True)]
    for path in ("file", "up/secret", "inside", "up"):
        for request in (
            lambda path=path: store.size(path),
            lambda path=path: store.read(path, 0, 9),
            lambda path=path: store.create(path),
            lambda path=path: store.write(path, 0, b"x"),
            lambda path=path: store.truncate(path, 0),
            lambda path=path: store.remove(path),
            lambda path=path: store.rename(path, "d/moved"),
        ):
            assert fault(request) is StoreFault.PROTECTED
    assert secret.read_bytes() == b"secret"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_the_disk_store_opens_nothing_but_files(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    store = DiskStore(tmp_path)
    assert store.entries("") == []
    assert fault(lambda: store.read("pipe", 0, 1)) is StoreFault.PROTECTED
    assert fault(lambda: store.write("pipe", 0, b"x")) is StoreFault.PROTECTED


def reference_crc32(data: bytes) -> int:
    """Bit by bit: the reflected polynomial, from 0, not inverted."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc


@given(st.binary(max_size=200))
def test_the_checksum_is_that_of_mavlink_ftp(data: bytes) -> None:
    store = MemoryStore()
    put(store, "f", data)
    assert crc32(store, "f") == reference_crc32(data)
