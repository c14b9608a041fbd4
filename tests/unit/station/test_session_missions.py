"""A mission through the whole session: on board, and not known to be after a restart."""

from __future__ import annotations

import pytest

from gcs.session.effects import Effect, Transmit
from gcs.session.inputs import Datagram, FileRead
from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame, split
from tests.unit.station import told, wire
from tests.unit.station.station import Script
from tests.unit.station.wire import MS_NS
from tests.unit.vehicle.jobs.script import Board
from tests.unit.vehicle.plans import BOX


class Mission:
    """A session whose vehicle keeps missions."""

    def __init__(self) -> None:
        self.script = Script().met()
        self.script.hear(wire.float_param("RTL_RETURN_ALT", 30.0))
        self.board = Board()
        self._writer = FrameWriter(1, 1)

    def ask(self, word: str) -> int:
        before = len(self.script.told)
        asked = self.script.ask(word, path="a.plan")
        self._exchange(self.script.told[before:])
        return asked

    def upload(self) -> None:
        asked = self.ask("mission_upload")
        (wanted,) = told.files(self.script.told)
        self._exchange(self.script.feed(FileRead(wanted.token, "a.plan", BOX)))
        assert told.outcomes(self.script.told) == [(asked, "complete", "")]

    def _exchange(self, effects: list[Effect]) -> None:
        """The vehicle answers whatever of the mission protocol reaches it."""
        agenda = list(effects)
        while agenda:
            effect = agenda.pop(0)
            if isinstance(effect, Transmit):
                for reply in self._replies(effect.data):
                    agenda += self.script.feed(Datagram(0, reply))

    def _replies(self, raw: bytes) -> list[bytes]:
        (frame,) = split(raw)
        assert isinstance(frame, Frame)
        message = decode(frame)
        replies = [] if message is None else self.board.hear(message)
        frames = []
        for reply in replies:
            self._writer.seq = self.script.sender.seq
            frames.append(self._writer.write(reply))
            self.script.sender.seq = self._writer.seq
        return frames


@pytest.fixture
def mission() -> Mission:
    made = Mission()
    made.upload()
    made.script.armed = True
    made.script.run(0.4)
    return made


KNOWN, UNKNOWN = "PARAM_REQUEST_READ", "MISSION_REQUEST_LIST"
"""What a start begins with: one that we brought is compared, any other one is read first."""


def start(mission: Mission) -> tuple[str, str]:
    """What is asked for first, and the code of a refusal."""
    mission.script.forget()
    mission.ask("mission_start")
    first = mission.script.sent()[0].get_type()
    return first, "".join(code for _, _, code in told.verdicts(mission.script.told))


def test_an_uploaded_mission_is_shown_and_read_back_before_it_is_started(mission: Mission) -> None:
    assert told.snapshots(mission.script.told)[-1].mission_total == 4
    assert start(mission) == (KNOWN, "")
    assert [ruling for _, ruling, _ in told.verdicts(mission.script.told)] == ["accepted"]


def test_after_the_vehicle_s_clock_went_back_no_mission_is_known_to_be_on_board(
    mission: Mission,
) -> None:
    """Two positions in a row of a clock that began anew: it restarted."""
    script = mission.script
    script.reporting = False
    script.hear(wire.position(200, (0.0, 0.0, 0.0)))
    script.now_ns += 30 * MS_NS
    script.hear(wire.position(230, (0.0, 0.0, 0.0)))
    script.hear(wire.landed(wire.ON_GROUND))
    assert start(mission)[0] == UNKNOWN


def test_after_the_vehicle_was_away_no_mission_is_known_to_be_on_board(mission: Mission) -> None:
    script = mission.script
    script.reporting = False
    script.run(5.0)
    script.reporting = True
    script.run(1.0)
    assert start(mission) == (UNKNOWN, "NO_ORIGIN")
