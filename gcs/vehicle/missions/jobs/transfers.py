"""Plans brought on board one after the other, each read back and compared in meaning."""

from __future__ import annotations

from abc import abstractmethod

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.refusal import Code
from gcs.plan import compare
from gcs.plan.item_messages import item_of, message_of
from gcs.plan.wire import WireItem
from gcs.protocol.mission import MissionDownload, MissionUpload
from gcs.session.work import Log
from gcs.vehicle.missions.jobs.job import NODE, Asked, Job, JobWork, VehicleView
from gcs.vehicle.missions.paths import autopilot_name
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

NAMES = {MissionType.MISSION: "mission", MissionType.FENCE: "fence", MissionType.RALLY: "rally"}


class BringingJob(Job):
    """`bring`, then `on_board` once the vehicle holds all of it; or the outcome says why not."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._left: list[tuple[MissionType, tuple[WireItem, ...]]] = []
        """What is to be brought on board yet; the first is under way."""
        self._refused = ""
        """What the vehicle answered to the last item, where it was no ACCEPTED."""

    @abstractmethod
    def on_board(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """All of it was read back equal: the end, or what comes next."""

    def bring(
        self,
        plans: list[tuple[MissionType, tuple[WireItem, ...]]],
        view: VehicleView,
        now_ns: int,
    ) -> list[JobWork]:
        """Begin with the first of `plans`, of which none is empty."""
        self._left = plans
        return self._bring(view, now_ns)

    def _bring(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        kind, items = self._left[0]
        messages = tuple(message_of(item) for item in items)
        upload = MissionUpload(*self.parties(view, kind), messages, self.asked.timing)
        return self.begin(upload, view, now_ns)

    def progress_of(self) -> str:
        reads_back = isinstance(self._transfer, MissionDownload)
        return "reading back" if reads_back else self.asked.word

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if isinstance(self._transfer, MissionUpload):
            return self._read_back(view, now_ns)
        return self._compare(tuple(item_of(message) for message in items), view, now_ns)

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Where only the last ack went missing, what is on board settles it.

        PX4 answers an item that comes after its ack with an ERROR.
        """
        kind, _ = self._left[0]
        if isinstance(self._transfer, MissionUpload) and self._transfer.all_given:
            self._refused = "" if result is None else text
            log = Log(Level.WARNING, NODE, f"upload: {text}: reading back")
            return [log, *self._read_back(view, now_ns)]
        if kind is not MissionType.MISSION:
            text = f"the plan's {NAMES[kind]} was not brought on board: {text}"
        return super().failed(result, text, view, now_ns)

    def _read_back(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        kind, _ = self._left[0]
        download = MissionDownload(*self.parties(view, kind), self.asked.timing, after_upload=True)
        return self.begin(download, view, now_ns)

    def _compare(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Believe what the vehicle holds, not what was sent."""
        kind, sent = self._left[0]
        differences = compare.same_meaning(sent, received, autopilot_name(view.telemetry))
        if differences:
            text = f"read back, it is another {NAMES[kind]}: {differences[0]}"
            if self._refused:
                text = f"{text}; {self._refused}"
            return self.end(OutcomeKind.ABORTED, Code.VEHICLE_REFUSED, text)
        self._refused = ""
        del self._left[0]
        return self._bring(view, now_ns) if self._left else self.on_board(view, now_ns)
