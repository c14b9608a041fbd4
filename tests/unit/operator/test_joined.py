"""The way into a running station: lines over a socket, and which station a link belongs to."""

from __future__ import annotations

import os
import re
import select
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from queue import Queue

import pytest

from gcs import ipc
from gcs.cli.running import others_running, station_for, the_station
from gcs.exit_codes import ExitCode
from gcs.operator.client import StationEnded, StationEvent
from gcs.operator.errors import ExitError
from gcs.operator.joined import JoinedStation, station_on
from gcs.operator.operations import OperationsView
from gcs.shell import stations
from gcs.shell.local_socket import LocalSocket
from gcs.shell.stations import Description

pytestmark = [
    pytest.mark.slow,  # sockets
    pytest.mark.skipif(sys.platform == "win32", reason="the runtime folder"),
]

DEFAULT = "udpin://127.0.0.1:14550"
BYE = ipc.Bye(0, "logs/a.mcap", "the station goes on", goes_on=True)


class FarEnd:
    """The station's end of the connection."""

    def __init__(self) -> None:
        near, self.sock = socket.socketpair()
        self.joined = JoinedStation(near, Description(7, ipc.SCHEMA, [DEFAULT]))

    def tell(self, *events: ipc.Event) -> None:
        self.sock.sendall(b"".join(map(ipc.encode, events)))

    def heard(self) -> list[ipc.Command]:
        if not select.select([self.sock], [], [], 1.0)[0]:
            return []
        return [ipc.decode_command(line) for line in self.sock.recv(1 << 20).splitlines()]


@pytest.fixture
def far() -> Iterator[FarEnd]:
    made = FarEnd()
    yield made
    made.sock.close()
    made.joined.close()


class TestTheConnection:
    def test_lines_go_both_ways(self, far: FarEnd) -> None:
        assert far.joined.send(ipc.Ask(1, "land"))
        assert far.heard() == [ipc.Ask(1, "land")]
        far.tell(ipc.Trouble("one"), ipc.Trouble("two"))
        assert far.joined.poll(1.0).events == [ipc.Trouble("one"), ipc.Trouble("two")]

    def test_a_line_in_pieces_is_one_event(self, far: FarEnd) -> None:
        line = ipc.encode(ipc.Trouble("one"))
        far.sock.sendall(line[:10])
        assert far.joined.poll(1.0).events == []
        far.sock.sendall(line[10:])
        assert far.joined.poll(1.0).events == [ipc.Trouble("one")]

    def test_what_is_no_event_is_a_trouble(self, far: FarEnd) -> None:
        far.sock.sendall(b"{}\n")
        (trouble,) = far.joined.poll(1.0).events
        assert isinstance(trouble, ipc.Trouble)

    def test_the_good_bye_and_the_end_are_told_and_stay_told(self, far: FarEnd) -> None:
        far.tell(BYE)
        far.sock.close()
        events: list[StationEvent] = []
        while not any(isinstance(event, StationEnded) for event in events):
            events += far.joined.poll(1.0).events
        assert events == [BYE, StationEnded(BYE, None, "")]
        assert far.joined.poll(0.0).events == [StationEnded(BYE, None, "")]
        assert not far.joined.send(ipc.Ask(1, "land"))

    def test_closing_reads_the_good_bye_that_is_on_its_way(self, far: FarEnd) -> None:
        far.tell(BYE)
        assert far.joined.close().bye == BYE

    def test_a_listener_hears_everything_to_the_end(self, far: FarEnd) -> None:
        heard: Queue[StationEvent] = Queue()
        far.joined.listen(heard.put)
        far.tell(ipc.Trouble("one"))
        assert heard.get(timeout=60) == ipc.Trouble("one")
        far.sock.close()
        assert isinstance(heard.get(timeout=60), StationEnded)

    def test_a_file_of_this_folder_is_named_so_that_the_station_finds_it(
        self, far: FarEnd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.chdir(tmp_path)
        (tmp_path / "a.plan").touch()
        for word, path in (
            ("mission_upload", "a.plan"),
            ("mission_upload", "demo"),
            ("mission_download", "new.plan"),
        ):
            far.joined.send(ipc.Ask(1, word, path=path))
        paths = [command.path for command in far.heard() if isinstance(command, ipc.Ask)]
        assert paths == [str(tmp_path / "a.plan"), "demo", str(tmp_path / "new.plan")]


class TestOperations:
    RUNNING = ipc.Operation(7, ipc.Ask(3, "land"), 1, "a test", 0)
    DONE = ipc.Operation(7, ipc.Ask(3, "land"), 1, "a test", 0, "complete", ended_ns=5)

    def test_what_ends_while_it_is_waited_for_is_seen(self, far: FarEnd) -> None:
        far.tell(ipc.OperationList(1, [self.RUNNING]), self.DONE, BYE)
        with OperationsView(far.joined) as view:
            assert view.ended(7, 5.0) == self.DONE
        assert far.heard() == [ipc.ListOperations(1), ipc.Leave("done")]

    def test_what_has_ended_is_not_waited_for(self, far: FarEnd) -> None:
        far.tell(ipc.OperationList(1, [self.DONE]), BYE)
        with OperationsView(far.joined) as view:
            assert view.ended(7, 5.0) == self.DONE

    def test_a_number_that_the_station_does_not_know_is_a_usage_error(self, far: FarEnd) -> None:
        far.tell(ipc.OperationList(1, [self.DONE]), BYE)
        with pytest.raises(ExitError) as wrong, OperationsView(far.joined) as view:
            view.ended(8, 5.0)
        assert wrong.value.exit_code == ExitCode.USAGE

    def test_what_takes_too_long_is_not_completed(self, far: FarEnd) -> None:
        far.tell(ipc.OperationList(1, [self.RUNNING]), BYE)
        with pytest.raises(ExitError) as late, OperationsView(far.joined) as view:
            view.ended(7, 0.01)
        assert late.value.exit_code == ExitCode.NOT_COMPLETED


@pytest.fixture
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    return tmp_path / "mavgate"


@pytest.fixture
def listening(runtime: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[LocalSocket]]:
    """Stations of other processes, as far as the folder shows."""
    made: list[LocalSocket] = []

    def start(link: str) -> None:
        number = os.getpid() + 1 + len(made)
        monkeypatch.setattr(os, "getpid", lambda: number)
        made.append(LocalSocket([link], "", keep=False, folder=runtime))

    start("udpin://127.0.0.1:47001")
    yield made
    for each in made:
        each.close()


class TestWhichStation:
    def test_without_one_there_is_none(self, runtime: Path) -> None:
        assert station_for([DEFAULT]) is None
        with pytest.raises(ExitError) as none:
            the_station(("udpin://127.0.0.1:47001",))
        assert none.value.exit_code == ExitCode.NO_VEHICLE

    def test_a_folder_of_somebody_else_is_told_and_hinders_no_stop(
        self, runtime: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        runtime.mkdir()
        runtime.chmod(0o777)
        home = runtime.parent / "home"
        monkeypatch.setattr(stations, "folders_of", lambda: [runtime, home])
        assert station_for([DEFAULT], anywhere=True) is None, "a stop goes on, by the link"
        [told] = others_running([DEFAULT])
        assert re.search("may not be found: .* can be used by other", told)
        local = LocalSocket([DEFAULT], "", keep=False, folder=home)
        assert station_for([DEFAULT], anywhere=True) == local.description
        local.close()

    def test_it_is_found_by_its_link(self, listening: list[LocalSocket]) -> None:
        found = station_on(["udpin://127.0.0.1:47001"])
        assert found is not None
        assert found.endpoints == ["udpin://127.0.0.1:47001"]
        assert station_on(["udpin://127.0.0.1:47002"]) is None
        assert station_on(["nonsense"]) is None

    def test_without_a_link_the_only_one_will_do_where_that_is_safe(
        self, listening: list[LocalSocket]
    ) -> None:
        assert station_for([DEFAULT], anywhere=True) == listening[0].description
        assert station_for([DEFAULT]) is None
        assert the_station(()) == listening[0].description
        with pytest.raises(ExitError):
            the_station(("udpin://127.0.0.1:47002",))

    def test_of_several_one_must_be_named(
        self, listening: list[LocalSocket], runtime: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        number = os.getpid() + 1
        monkeypatch.setattr(os, "getpid", lambda: number)
        listening.append(LocalSocket(["udpin://127.0.0.1:47002"], "", keep=False, folder=runtime))
        with pytest.raises(ExitError, match="2 stations are running") as several:
            station_for([DEFAULT], anywhere=True)
        assert several.value.exit_code == ExitCode.USAGE

    def test_the_one_on_the_default_link_comes_before_any_other(
        self, listening: list[LocalSocket], runtime: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        number = os.getpid() + 1
        monkeypatch.setattr(os, "getpid", lambda: number)
        listening.append(LocalSocket([DEFAULT], "", keep=False, folder=runtime))
        assert the_station(()) == listening[1].description
