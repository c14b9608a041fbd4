"""Check: the mission on board is read back and verified as its start verifies it; nothing moves.

It is asked for before an arming that is to start the mission, so that a mission that does not clear
is found before the vehicle is armed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code, Refusal
from gcs.plan.wire import WireItem
from gcs.vehicle.missions.jobs.job import Asked, JobWork, VehicleView
from gcs.vehicle.missions.jobs.start import Start
from gcs.vehicle.missions.jobs.starting import StartingJob
from gcs.vehicle.missions.jobs.verify_on_board import Adopt
from gcs.vehicle.missions.plans import OnBoard

MODE_NS: Final = 3_000_000_000
"""How long a mode may take to be shown: three heartbeats."""
POLL_NS: Final = 50_000_000
NO_MISSION: Final = Refusal(
    Code.NO_MISSION, "no verified mission is on board: upload one, and it is verified"
)


class _Checking(StartingJob):
    """It ends where a start would ask the gate: the mission clears.

    `mode_name`: it ends when the heartbeat shows this mode; empty: whatever is shown.
    """

    mode_name: str = ""
    _look_ns: int | None = None
    _until_ns: int = 0

    @property
    def deadline_ns(self) -> int | None:
        return super().deadline_ns if self._look_ns is None else self._look_ns

    def begin_at(
        self, seq: int | None, items: Sequence[WireItem], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Every item clears."""
        self.stop_transfer()
        self._until_ns = now_ns + self.asked.times.real_ns(MODE_NS)
        return self._look_at_mode(view, now_ns)

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._look_ns is None:
            return super().wake(view, now_ns)
        return self._look_at_mode(view, now_ns) if now_ns >= self._look_ns else []

    def _look_at_mode(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self.mode_name in ("", view.telemetry.mode_name):
            self.over = True
            return [self.accept(), *self.end(OutcomeKind.COMPLETE, None, "the mission clears")]
        if now_ns >= self._until_ns:
            text = f"the vehicle does not show {self.mode_name}, but {view.telemetry.mode_name}"
            return self.refuse(Refusal(Code.NO_ANSWER, text))
        self._look_ns = now_ns + self.asked.times.real_ns(POLL_NS)
        return []

    def ask_gate(self) -> list[JobWork]:
        """Nothing is on board."""
        return self.refuse(NO_MISSION)


class Check(_Checking, Start):
    """The mission that was verified before, read back and verified once more."""

    def __init__(self, asked: Asked, on_board: OnBoard, mode_name: str = "") -> None:
        super().__init__(asked, on_board)
        self.mode_name = mode_name


class CheckUnknown(_Checking, Adopt):
    """A mission that this station did not bring on board: from now on it is known."""

    def __init__(self, asked: Asked, mode_name: str = "") -> None:
        super().__init__(asked)
        self.mode_name = mode_name
