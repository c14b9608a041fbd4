"""The line that shows progress: late, on a terminal only, and gone without a trace."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.cli.progress import ProgressDisplay
from tests.unit.operator.fake_station import FakeStation


def test_the_progress_line_makes_room_for_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    with ProgressDisplay("goto", 0.0, shown=True) as display:
        display.update(FakeStation().snapshot(), 1.5)
        display.clear()
        drawn = capsys.readouterr().err
        # It ends with the cursor at the start of an empty line.
        assert drawn.endswith("\x1b[1A\x1b[2K")
        display.update(FakeStation().snapshot(), 2.5)
    assert "2 s" in capsys.readouterr().err


def test_progress_is_silent_for_a_second_and_on_a_pipe(capsys: pytest.CaptureFixture[str]) -> None:
    event = ipc.ProgressEvent(1, "upload", 3, 7, "items")
    for shown, now_s in ((False, 5.0), (True, 0.5)):
        with ProgressDisplay("upload", 0.0, shown=shown) as display:
            display.update(event, now_s)
    assert capsys.readouterr().err == ""
    with ProgressDisplay("upload", 0.0, shown=True) as display:
        display.update(event, 1.5)
    assert "3 of 7 items" in capsys.readouterr().err
