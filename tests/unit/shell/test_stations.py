"""How a running station is found, and how one that died is not."""

from __future__ import annotations

import json
import os
import stat
import sys
import tempfile
from pathlib import Path

import msgspec
import pytest

from gcs import ipc
from gcs.shell import stations
from gcs.shell.endpoints import parse_endpoint
from gcs.shell.local_socket import LocalSocket
from gcs.shell.stations import Description, Unsafe
from tests.unit.operator.fake_station import FakeStation

pytestmark = [
    pytest.mark.slow,  # sockets
    pytest.mark.skipif(sys.platform == "win32", reason="modes and Unix sockets"),
]

LINK = "udpin://127.0.0.1:14550"


def listen(folder: Path, *, unix: bool = True, keep: bool = False) -> LocalSocket:
    return LocalSocket([LINK], "logs/a.mcap", keep=keep, folder=folder, unix=unix)


def mode(path: Path) -> int:
    return stat.S_IMODE(path.lstat().st_mode)


@pytest.mark.parametrize("unix", [True, False], ids=["unix", "port"])
def test_a_station_is_found_while_it_listens_and_not_after(tmp_path: Path, unix: bool) -> None:
    folder = tmp_path / "mavgate"
    local = listen(folder, unix=unix)
    (found,) = stations.running(folder)
    assert (found.pid, found.endpoints, found.schema) == (os.getpid(), [LINK], ipc.SCHEMA)
    assert bool(found.token) is not unix
    stations.connect(found).close()
    local.close()
    assert stations.running(folder) == []
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("unix", [True, False], ids=["unix", "port"])
def test_only_its_user_can_reach_it(tmp_path: Path, unix: bool) -> None:
    folder = tmp_path / "mavgate"
    local = listen(folder, unix=unix)
    assert mode(folder) == 0o700
    assert {mode(path) for path in folder.iterdir()} == {0o600}
    assert len(list(folder.iterdir())) == 1 + unix
    if not unix:
        assert local.listener.getsockname()[0] == "127.0.0.1"
    local.close()


def test_what_a_dead_station_left_is_removed(tmp_path: Path) -> None:
    folder = tmp_path / "mavgate"
    local = listen(folder)
    local.listener.close()  # as after a SIGKILL: nobody takes connections, the files are there
    assert len(list(folder.iterdir())) == 2
    assert stations.running(folder) == []
    assert list(folder.iterdir()) == []


def test_of_a_bridge_all_vehicles_that_can_be_chosen_are_described(tmp_path: Path) -> None:
    names = ["1/1 px4 quadrotor", "2/1 ardupilot quadrotor"]
    seen = msgspec.structs.replace(FakeStation().snapshot(), vehicle=names[0], vehicles=names)
    for several in (True, False):
        local = LocalSocket([LINK], "", keep=False, several=several, folder=tmp_path / "mavgate")
        local.describe(seen)
        (found,) = stations.running(tmp_path / "mavgate")
        assert (found.vehicle, found.vehicles) == (names[0], names if several else [])
        local.close()


def test_a_new_station_takes_the_place_of_a_dead_one_with_its_number(tmp_path: Path) -> None:
    folder = tmp_path / "mavgate"
    listen(folder).listener.close()
    local = listen(folder, keep=True)
    (found,) = stations.running(folder)
    assert found.keep
    local.close()


@pytest.mark.parametrize("text", ["", "{", "[]", '{"pid":"one"}'])
def test_a_description_that_is_none_is_removed(tmp_path: Path, text: str) -> None:
    folder = stations.made_safe(tmp_path / "mavgate")
    (folder / "1.json").write_text(text)
    assert stations.running(folder) == []
    assert list(folder.iterdir()) == []


def test_a_description_never_makes_us_remove_what_lies_elsewhere(tmp_path: Path) -> None:
    folder = stations.made_safe(tmp_path / "mavgate")
    precious = tmp_path / "precious"
    precious.touch()
    stations.write(folder, Description(1, 1, [LINK], socket_path=str(precious)))
    assert stations.running(folder) == []
    assert precious.exists()


@pytest.mark.parametrize("bits", [0o755, 0o770, 0o707])
def test_a_folder_that_others_can_use_is_not_trusted(tmp_path: Path, bits: int) -> None:
    folder = tmp_path / "mavgate"
    folder.mkdir()
    folder.chmod(bits)
    with pytest.raises(Unsafe, match=f"mode {bits:o}"):
        listen(folder)
    assert stations.running(folder) == []


def test_a_link_to_a_folder_is_not_trusted(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir(mode=0o700)
    (tmp_path / "mavgate").symlink_to(tmp_path / "real")
    with pytest.raises(Unsafe, match="is no folder"):
        listen(tmp_path / "mavgate")


def test_a_folder_of_another_user_is_not_trusted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = stations.made_safe(tmp_path / "mavgate")
    someone = os.getuid() + 1
    monkeypatch.setattr(os, "getuid", lambda: someone)
    with pytest.raises(Unsafe, match="belongs to another user"):
        stations.check(folder)


def test_where_there_is_no_runtime_folder_it_is_the_user_s_own_temporary_one(
    tmp_path: Path,
) -> None:
    assert stations.folder_of({"XDG_RUNTIME_DIR": str(tmp_path)}) == tmp_path / "mavgate"
    for elsewhere in ({}, {"XDG_RUNTIME_DIR": ""}, {"XDG_RUNTIME_DIR": str(tmp_path / "none")}):
        assert stations.folder_of(elsewhere).name == f"mavgate-{os.getuid()}"


def test_where_somebody_else_has_made_that_folder_it_is_one_of_the_user_s_home(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    taken = tmp_path / f"mavgate-{os.getuid()}"
    assert stations.folder_of({}) == taken
    taken.mkdir()
    taken.chmod(0o777)
    assert stations.folder_of({}) == tmp_path / "home" / ".mavgate"


def test_a_station_is_found_whether_somebody_else_s_folder_is_there_or_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was begun while that was there, or before: both places are looked in."""
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    taken = tmp_path / f"mavgate-{os.getuid()}"
    taken.mkdir()
    taken.chmod(0o777)
    local = listen(stations.folder_of({}))
    (found,) = stations.running(*stations.folders_of({}))
    assert found.endpoints == [LINK]
    taken.rmdir()
    assert stations.folder_of({}) == taken, "where the next one goes"
    assert stations.running(*stations.folders_of({})) == [found]
    local.close()


def test_vehicle_and_log_are_written_when_they_change_and_only_then(tmp_path: Path) -> None:
    folder = tmp_path / "mavgate"
    local = listen(folder)
    (path,) = folder.glob("*.json")
    seen = ipc.Snapshot(
        0, "", "", "", [], 0.0, "logs/a_part2.mcap", True, 0.0, vehicle="1/1 px4 quadrotor"
    )
    local.describe(seen)
    told = json.loads(path.read_bytes())
    assert told["vehicle"] == "1/1 px4 quadrotor"
    assert told["log_path"] == str(Path.cwd() / "logs/a_part2.mcap"), "its reader may be elsewhere"
    path.unlink()
    local.describe(seen)
    assert not path.exists()
    local.close()


@pytest.mark.parametrize(
    ("held", "wanted", "same"),
    [
        ("udpin://127.0.0.1:14550", "udpin://127.0.0.1:14550", True),
        ("udpin://127.0.0.1:14550", "udp:127.0.0.1:14550", True),
        ("udpin://127.0.0.1:14550", "udpin://localhost:14550", True),
        ("udpin://0.0.0.0:14550", "udpin://127.0.0.1:14550", True),
        ("udpin://127.0.0.1:14550", "udpin://0.0.0.0:14550", True),
        ("udpin://127.0.0.1:14550", "udpin://127.0.0.1:14540", False),
        ("udpin://127.0.0.1:14550", "udpout://127.0.0.1:14550", False),
        ("udpin://192.168.1.2:14550", "udpin://127.0.0.1:14550", False),
        ("udpout://10.0.0.1:14550", "udpout://10.0.0.2:14550", False),
        ("tcpout://127.0.0.1:5760", "tcp:127.0.0.1:5760", True),
        ("serial:///dev/ttyUSB0:57600", "/dev/ttyUSB0,115200", True),
        ("serial:///dev/ttyUSB0:57600", "/dev/ttyUSB1,57600", False),
        ("nonsense", "udpin://127.0.0.1:14550", False),
    ],
)
def test_a_station_is_found_by_the_link_that_it_has_open(
    held: str, wanted: str, same: bool
) -> None:
    assert stations.holds(Description(1, 1, [held]), parse_endpoint(wanted)) is same
