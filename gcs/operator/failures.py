"""What the Python library raises: a request that was refused or not completed, a station lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.operator.differences import Difference


class GcsError(Exception):
    """What this library raises."""


class CannotConnect(GcsError):  # noqa: N818 - the names read as what happened
    """No station could be started or joined, or it heard no vehicle.

    `exit_code` is what the command line would exit with (`gcs.exit_codes`).
    """

    def __init__(self, sentence: str, hint: str = "", exit_code: int = ExitCode.NO_VEHICLE) -> None:
        super().__init__(f"{sentence}; {hint}" if hint else sentence)
        self.sentence = sentence
        self.hint = hint
        self.exit_code = exit_code


class StationDiffers(CannotConnect):
    """The running station that has the link open is not as was asked for, in each of
    `differences`: it was not joined."""

    def __init__(self, sentence: str, hint: str, differences: Sequence[Difference]) -> None:
        super().__init__(sentence, hint, ExitCode.USAGE)
        self.differences = tuple(differences)


class Refused(GcsError):  # noqa: N818
    """The gate, or the vehicle's station, refused the request: nothing of it was sent.

    `code` is a word for programs (`gcs.gate.refusal.Code`), `numbers` what it was decided on, with
    the unit at the end of each name.
    """

    def __init__(self, code: str, sentence: str, numbers: Mapping[str, float | None]) -> None:
        super().__init__(f"{code}: {sentence}")
        self.code = code
        self.sentence = sentence
        self.numbers = dict(numbers)


class NotCompleted(GcsError):  # noqa: N818
    """The request was accepted and ended otherwise than complete, or is not over in time.

    `state` is aborted, superseded, timed out, taken over, or running where the time to wait was
    over: then it goes on.
    """

    def __init__(self, state: str, code: str, sentence: str) -> None:
        super().__init__(f"{state} {code}: {sentence}" if code else f"{state}: {sentence}")
        self.state = state
        self.code = code
        self.sentence = sentence


class Disconnected(GcsError):  # noqa: N818
    """The station has ended, or the connection to it."""
