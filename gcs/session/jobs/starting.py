"""A job that ends with the start of a mission: verified, brought to the item where it is to begin,
then the gate decides."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Final

from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import StartMission
from gcs.plan.item_messages import item_of
from gcs.plan.wire import WireItem
from gcs.protocol.effects import Address
from gcs.protocol.mission_rewind import MissionRewind
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.jobs.job import Asked, JobWork, VehicleView, code_of
from gcs.session.jobs.verified import VerifiedJob
from gcs.session.paths import autopilot_name
from gcs.session.telemetry import Telemetry
from gcs.session.work import AskGate
from gcs.wire.ids import Cmd
from gcs.wire.messages import MissionItemInt

NAV_LAST: Final = 95
"""MAV_CMD_NAV_LAST: items up to it are flown, or waited for; those after it are done on the way."""
LEFT: Final = "its operator left before it began"
STOPPED: Final = "an operator stopped the vehicle before it began"


class StartingJob(VerifiedJob):
    """What is on board is read: `read_back`; once it is verified, `begin_at`."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self._rewinding = False
        """The vehicle is to go to the item that it begins at."""
        self._begin_seq: int | None = None
        """That item; None: the first."""

    @abstractmethod
    def read_back(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """The items that are on board."""

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if self._rewinding:
            return self.ask_gate()
        return self.read_back(tuple(item_of(message) for message in items), view, now_ns)

    def begin_at(
        self, seq: int | None, items: Sequence[WireItem], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Ask the gate for the start, once the vehicle is at item `seq`; None: the first.

        From there the mission was verified; the vehicle itself would go on where it was left.
        """
        self._begin_seq = seq
        begin = first_item(view.telemetry) if seq is None else seq
        shown = shown_for(begin, items, view.telemetry)
        current = view.telemetry.mission_seq
        if current in shown or (current is None and seq is None):
            return self.ask_gate()
        self._rewinding = True
        target = Address(view.telemetry.sysid, view.telemetry.compid)
        rewind = MissionRewind(self.asked.own, target, begin, shown, self.asked.timing)
        return self.begin(rewind, 0, view, now_ns)

    def ask_gate(self) -> list[JobWork]:
        """All that is known of the mission is: the start is the gate's to decide."""
        self.over = True
        return [AskGate(self.asked.request_id, StartMission(self._begin_seq))]

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        sentence = text if self._rewinding else f"what is on board could not be read: {text}"
        return self.refuse(Refusal(code_of(result), sentence))

    def leave(self) -> list[JobWork]:
        """Its operator, or the station, goes before the verdict."""
        return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))

    def stop(self) -> list[JobWork]:
        """It has no verdict yet, so it is refused."""
        return self.refuse(Refusal(Code.OPERATOR, STOPPED))


def first_item(telemetry: Telemetry) -> int:
    """The first item that is flown; ardupilot keeps home as item 0."""
    return 1 if autopilot_name(telemetry) == "ardupilot" else 0


def shown_for(begin: int, items: Sequence[WireItem], telemetry: Telemetry) -> range:
    """What MISSION_CURRENT may show of a vehicle that is to begin at item `begin`: that one, up to
    the next one that is flown to.  Before the first it is at the start as well."""
    flown = (
        seq
        for seq, item in enumerate(items)
        if seq >= begin and item.command <= NAV_LAST and item.command != Cmd.NAV_ROI
    )
    least = 0 if begin <= first_item(telemetry) else begin
    return range(least, next(flown, begin) + 1)
