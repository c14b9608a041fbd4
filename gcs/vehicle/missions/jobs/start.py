"""Start: the mission on board is read back, compared and verified anew, then the gate decides.

Another station may have put another mission in its place, and the path begins where the vehicle
is now.
"""

from __future__ import annotations

from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code, Refusal
from gcs.plan import compare
from gcs.plan.verify import Verification
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload
from gcs.session.work import GateInput
from gcs.vehicle.missions.jobs.job import Asked, JobWork, OnBoardChanged, VehicleView
from gcs.vehicle.missions.jobs.starting import StartingJob
from gcs.vehicle.missions.paths import autopilot_name, cleared
from gcs.vehicle.missions.plans import OnBoard

AGAIN = "ask once more and that one is verified"


class Start(StartingJob):
    """The mission on board, read back and verified once more; then the gate decides.

    `begin_seq` is the item to begin at, in the air; None: the first.
    """

    def __init__(self, asked: Asked, on_board: OnBoard, begin_seq: int | None = None) -> None:
        super().__init__(asked)
        self._on_board = on_board
        self._wanted_seq = begin_seq
        self._to_verify: tuple[int, ...] = ()
        """The items that it may begin at, counting into the plan."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return self.learn(view, now_ns)

    def learnt(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        download = MissionDownload(*self.parties(view), self.asked.timing)
        return self.begin(download, view, now_ns)

    def progress_of(self) -> str:
        return "reading back"

    def read_back(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Is it still the mission that was verified?"""
        sent, name = self._on_board.sent, autopilot_name(view.telemetry)
        differences = compare.same_meaning(sent, received, name)
        if differences:
            text = f"another mission is on board than was verified: {differences[0]}; {AGAIN}"
            forget: list[JobWork] = [OnBoardChanged(None), GateInput(MissionLoaded("", 0))]
            return forget + self.refuse(Refusal(Code.BAD_MISSION, text))
        return self.verify_anew(view, now_ns)

    def verify_anew(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        self._to_verify = _begin_items(self._on_board, self._wanted_seq)
        if autopilot_name(view.telemetry) == "px4":
            self._to_verify = self._to_verify[:1]
        return self.verify(self._on_board.plan, view, now_ns, self._to_verify[0])

    def verified(self, found: Verification, view: VehicleView, now_ns: int) -> list[JobWork]:
        """Where its path still clears, it is the gate's turn."""
        answer = cleared(found)
        if isinstance(answer, Refusal):
            return self.refuse(answer)
        self.note_path(found.path)
        self._to_verify = self._to_verify[1:]
        if self._to_verify:
            return self.verify(self._on_board.plan, view, now_ns, self._to_verify[0])
        return self.begin_at(self._wanted_seq, self._on_board.sent, view, now_ns)


def _begin_items(on_board: OnBoard, begin_seq: int | None) -> tuple[int, ...]:
    """The item asked for, and the first one: an ArduCopter whose MIS_RESTART is 1 begins there
    whatever it was set to (from memory of AP_Mission::start_or_resume; vehicle-sim does so)."""
    home_items = len(on_board.sent) - len(on_board.plan.items)
    wanted = 0 if begin_seq is None else max(0, begin_seq - home_items)
    return (wanted, 0) if wanted else (0,)
