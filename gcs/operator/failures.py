"""What the Python library raises: all of it is a `GcsError`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.operator.differences import Difference

_NONE: Mapping[str, float | None] = {}


class GcsError(Exception):
    """What this library raises.

    `code` is a word for programs, `sentence` what happened, `hint` what to do where that is known,
    `numbers` what it was decided on, with the unit at the end of each name; empty where no number
    counted, such as for a vehicle that is held, or not armed.
    """

    def __init__(
        self,
        code: str,
        sentence: str,
        numbers: Mapping[str, float | None] = _NONE,
        hint: str = "",
        text: str = "",
    ) -> None:
        """`text` is the whole, where it is more than the sentence."""
        super().__init__(text or sentence)
        self.code = code
        self.sentence = sentence
        self.numbers = dict(numbers)
        self.hint = hint


class CannotConnect(GcsError):  # noqa: N818 - the names read as what happened
    """No station could be started or joined, or it heard no vehicle.

    `exit_code` is what the command line would exit with, and `code` its name (`gcs.exit_codes`).
    """

    def __init__(self, sentence: str, hint: str = "", exit_code: int = ExitCode.NO_VEHICLE) -> None:
        text = f"{sentence}; {hint}" if hint else sentence
        super().__init__(ExitCode(exit_code).name, sentence, hint=hint, text=text)
        self.exit_code = exit_code


class StationDiffers(CannotConnect):
    """The running station that has the link open is not as was asked for, in each of
    `differences`: it was not joined."""

    def __init__(self, sentence: str, hint: str, differences: Sequence[Difference]) -> None:
        super().__init__(sentence, hint, ExitCode.USAGE)
        self.code = "STATION_DIFFERS"
        self.differences = tuple(differences)


class Refused(GcsError):  # noqa: N818
    """The gate, or the vehicle's station, refused the request: nothing of it was sent.

    `code` is one of `gcs.gate.refusal.Code`.
    """

    def __init__(self, code: str, sentence: str, numbers: Mapping[str, float | None]) -> None:
        super().__init__(code, sentence, numbers, text=f"{code}: {sentence}")


class NotCompleted(GcsError):  # noqa: N818
    """The request was accepted and ended otherwise than complete, or is not over in time.

    `state` is aborted, superseded, timed out, taken over, or running where the time to wait was
    over: then it goes on.
    """

    def __init__(
        self, state: str, code: str, sentence: str, numbers: Mapping[str, float | None] = _NONE
    ) -> None:
        text = f"{state} {code}: {sentence}" if code else f"{state}: {sentence}"
        super().__init__(code, sentence, numbers, text=text)
        self.state = state


class Disconnected(GcsError):  # noqa: N818
    """The station has ended, or the connection to it."""

    def __init__(self, sentence: str) -> None:
        super().__init__("DISCONNECTED", sentence)


class NotHeard(GcsError, TimeoutError):  # noqa: N818
    """What was waited for was not heard in time: a message, or an answer of the station."""

    def __init__(self, sentence: str, timeout_s: float | None) -> None:
        super().__init__("NOT_HEARD", sentence, {"timeout_s": timeout_s})


class BadArgument(GcsError, ValueError, TypeError):  # noqa: N818
    """An argument is missing, unknown or not what the method takes: nothing was asked for.

    `numbers` has the argument where it is a number.
    """

    def __init__(self, sentence: str, numbers: Mapping[str, float | None] = _NONE) -> None:
        super().__init__("BAD_ARGUMENT", sentence, numbers)
