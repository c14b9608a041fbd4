"""The mission protocol, ground station's side, for missions, fences and rally points alike.

    upload:    COUNTING --request--> SENDING --accepted, all were asked for--> done
    download:  LISTING  --count----> FETCHING --last item--> done (and acknowledged)
    clear:     CLEARING --accepted-> done

In an upload the vehicle asks and we answer, as often and in whatever order it asks; so a lost
item is asked for again, and a duplicate does no harm.  An ACCEPTED before every item was asked for
belongs to an earlier transfer and is not believed.  INVALID_SEQUENCE is about a duplicate.  Any
other result ends the transfer.  While only the last answer is missing, the item that was given last
is sent again and again, and whatever item is asked for again shows that the vehicle is at work.
"""

from __future__ import annotations

from enum import Enum, auto
from typing import assert_never

import msgspec

from gcs.protocol.effects import (
    Address,
    Cancel,
    Heard,
    Send,
    TransferEffect,
    TransferProgress,
    Wake,
)
from gcs.protocol.transfers.transfer import (
    SPEC_TIMING,
    Input,
    Parties,
    PlanMessage,
    Timing,
    Transfer,
)
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import (
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
)


class MissionUpload(Transfer):
    """Bring `items` on board.  Their seq, target and mission_type are set here.

    `start`, then `handle` until `ended`; the last effect is TransferDone or TransferFailed.
    """

    def __init__(
        self,
        own: Address,
        target: Address,
        mission_type: MissionType,
        items: tuple[MissionItemInt, ...],
        timing: Timing = SPEC_TIMING,
    ) -> None:
        super().__init__(Parties(own, target, mission_type), timing)
        self._timing = timing
        self._items = tuple(
            msgspec.structs.replace(
                item,
                seq=seq,
                target_system=target.sysid,
                target_component=target.compid,
                mission_type=mission_type,
            )
            for seq, item in enumerate(items)
        )
        self._asked = 0
        """Items 0 up to this one were asked for."""
        self._given = 0
        """The item that was given last."""
        self._confirm_until_ns: int | None = None
        """Until then a question for an item that was given is progress, once all were given."""

    @property
    def all_given(self) -> bool:
        """Every item was asked for: what failed after that may be on board all the same."""
        return self._asked == len(self._items)

    def start(self, now_ns: int) -> list[TransferEffect]:
        to = self._parties.target
        count = MissionCount(
            count=len(self._items),
            target_system=to.sysid,
            target_component=to.compid,
            mission_type=self._parties.mission_type,
        )
        return self._pending.put(Send(count), now_ns)

    def handle(self, event: Input, now_ns: int) -> list[TransferEffect]:
        if self.ended:
            return []
        match event:
            case Heard():
                return self._heard(self._parties.concerns(event), now_ns)
            case Wake():
                repeated = self._pending.wake(now_ns)
                return self._failed(None, self._silence()) if repeated is None else repeated
            case Cancel(why):
                return self._cancelled(why)
            case _:
                assert_never(event)

    def _heard(self, message: PlanMessage | None, now_ns: int) -> list[TransferEffect]:
        match message:
            case MissionRequest() | MissionRequestInt() if message.seq < len(self._items):
                if message.seq >= self._asked:
                    self._pending.answered(now_ns)
                return self._give(message.seq, now_ns)
            case MissionAck(type=MissionResult.INVALID_SEQUENCE):
                return self._not_that_one(now_ns)
            case MissionAck() if message.type != MissionResult.ACCEPTED:
                return self._refused(message.type)
            case MissionAck() if self.all_given:
                return self._done(self._items)
            case _:
                return []

    def _give(self, seq: int, now_ns: int) -> list[TransferEffect]:
        """Answer a request.  A first request also tells that all before it arrived."""
        sent = self._pending.put_item(Send(self._items[seq]), now_ns)
        self._given = seq
        if seq < self._asked:
            return [*sent, *self._at_work(now_ns)]
        self._asked = seq + 1
        if self.all_given:
            self._confirm_until_ns = now_ns + self._timing.confirm_ns
        return [*sent, TransferProgress(self._asked, len(self._items))]

    def _at_work(self, now_ns: int) -> list[TransferEffect]:
        """An item was asked for again.  One that never comes through is no progress."""
        if self._confirm_until_ns is None or now_ns >= self._confirm_until_ns:
            return []
        return [TransferProgress(self._asked, len(self._items))]

    def _not_that_one(self, now_ns: int) -> list[TransferEffect]:
        """ArduPilot answers an item that it has already with INVALID_SEQUENCE, and asks once a
        second only (GCS_MAVLink, MissionItemProtocol::handle_mission_item).

        Where we had repeated the item, its request for the next one was lost: give it that.
        """
        first_or_last = self._asked == 0 or self._given + 1 >= len(self._items)
        if self._pending.repeats == 0 or first_or_last:
            return []
        return self._give(self._given + 1, now_ns)

    def _silence(self) -> str:
        if self._asked == 0:
            return "the vehicle did not answer"
        if self._asked < len(self._items):
            return f"the vehicle stopped asking after item {self._asked - 1}"
        return "the vehicle did not confirm the last item; it may have the plan or not"


class _Fetch(Enum):
    LISTING = auto()
    FETCHING = auto()


class MissionDownload(Transfer):
    """Read the plan that is on board; TransferDone holds its items in order.

    `after_upload`: answers to duplicates of the upload before may come yet (ArduPilot and PX4
    answer an item after the last with ERROR), so a result other than ACCEPTED is believed only
    where nothing else comes.
    """

    def __init__(
        self,
        own: Address,
        target: Address,
        mission_type: MissionType,
        timing: Timing = SPEC_TIMING,
        *,
        after_upload: bool = False,
    ) -> None:
        super().__init__(Parties(own, target, mission_type), timing)
        self._after_upload = after_upload
        self._answered: int | None = None
        self._phase = _Fetch.LISTING
        self._total = 0
        self._items: list[MissionItemInt] = []

    @property
    def listed(self) -> bool:
        """The vehicle has told how many items there are."""
        return self._phase is _Fetch.FETCHING

    def start(self, now_ns: int) -> list[TransferEffect]:
        to = self._parties.target
        ask = MissionRequestList(
            target_system=to.sysid,
            target_component=to.compid,
            mission_type=self._parties.mission_type,
        )
        return self._pending.put(Send(ask), now_ns)

    def handle(self, event: Input, now_ns: int) -> list[TransferEffect]:
        if self.ended:
            return []
        match event:
            case Heard():
                return self._heard(self._parties.concerns(event), now_ns)
            case Wake():
                repeated = self._pending.wake(now_ns)
                return self._given_up() if repeated is None else repeated
            case Cancel(why):
                return self._cancelled(why)
            case _:
                assert_never(event)

    def _heard(self, message: PlanMessage | None, now_ns: int) -> list[TransferEffect]:
        match self._phase, message:
            case _Fetch.LISTING, MissionCount(count=count):
                self._pending.answered(now_ns)
                self._total = count
                self._phase = _Fetch.FETCHING
                return self._ask_or_end(now_ns)
            case _Fetch.FETCHING, MissionItemInt(seq=seq) as item if seq == len(self._items):
                self._pending.answered(now_ns)
                self._items.append(item)
                progress = TransferProgress(len(self._items), self._total)
                return [progress, *self._ask_or_end(now_ns)]
            case _, MissionAck(type=result) if result != MissionResult.ACCEPTED:
                self._answered = result
                return [] if self._after_upload else self._refused(result)
            case _:
                return []

    def _ask_or_end(self, now_ns: int) -> list[TransferEffect]:
        if len(self._items) == self._total:
            accepted = self._acknowledge(MissionResult.ACCEPTED)
            return [accepted, *self._done(tuple(self._items))]
        to = self._parties.target
        ask = MissionRequestInt(
            seq=len(self._items),
            target_system=to.sysid,
            target_component=to.compid,
            mission_type=self._parties.mission_type,
        )
        return self._pending.put_item(Send(ask), now_ns)

    def _given_up(self) -> list[TransferEffect]:
        if self._answered is not None:
            return self._refused(self._answered)
        return self._failed(None, self._silence())

    def _silence(self) -> str:
        if self._phase is _Fetch.LISTING:
            return "the vehicle did not answer"
        return f"the vehicle did not send item {len(self._items)} of {self._total}"


class MissionClear(Transfer):
    """Take the plan off the vehicle.  MissionType.ALL takes every plan."""

    def __init__(
        self,
        own: Address,
        target: Address,
        mission_type: MissionType,
        timing: Timing = SPEC_TIMING,
    ) -> None:
        super().__init__(Parties(own, target, mission_type), timing)

    def start(self, now_ns: int) -> list[TransferEffect]:
        to = self._parties.target
        clear = MissionClearAll(
            target_system=to.sysid,
            target_component=to.compid,
            mission_type=self._parties.mission_type,
        )
        return self._pending.put(Send(clear), now_ns)

    def handle(self, event: Input, now_ns: int) -> list[TransferEffect]:
        if self.ended:
            return []
        match event:
            case Heard():
                match self._parties.concerns(event):
                    case MissionAck(type=MissionResult.ACCEPTED):
                        return self._done(())
                    case MissionAck(type=result):
                        return self._refused(result)
                    case _:
                        return []
            case Wake():
                silence = "the vehicle did not answer"
                repeated = self._pending.wake(now_ns)
                return self._failed(None, silence) if repeated is None else repeated
            case Cancel(why):
                return self._failed(None, why)
            case _:
                assert_never(event)
