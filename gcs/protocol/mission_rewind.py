"""Make an item of the mission on board the current one, before the mission is started.

An autopilot flies a mission on from its current item: ArduPilot where it was left, PX4 too where it
gets there by its mode.  A mission is verified from its first item, or from the one that was asked
for, so it is to be flown from there.
"""

from __future__ import annotations

from typing import assert_never

from gcs.protocol.effects import Address, Cancel, Heard, Send, TransferEffect, Wake
from gcs.protocol.transfers.transfer import SPEC_TIMING, Input, Parties, Timing, Transfer
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionCurrent, MissionSetCurrent


class MissionRewind(Transfer):
    """MISSION_SET_CURRENT, until MISSION_CURRENT shows it.

    `begin` is the item to begin at, `shown` are those that may be shown for it: ArduPilot goes on
    to the next item that is flown to.
    """

    def __init__(
        self, own: Address, target: Address, begin: int, shown: range, timing: Timing = SPEC_TIMING
    ) -> None:
        super().__init__(Parties(own, target, MissionType.MISSION), timing)
        self._begin = begin
        self._shown = shown

    def start(self, now_ns: int) -> list[TransferEffect]:
        to = self._parties.target
        back = MissionSetCurrent(self._begin, to.sysid, to.compid)
        return self._pending.put(Send(back), now_ns)

    def handle(self, event: Input, now_ns: int) -> list[TransferEffect]:
        if self.ended:
            return []
        match event:
            case Heard(sysid, compid, MissionCurrent(seq=seq)):
                shown = self._parties.target.includes(sysid, compid) and seq in self._shown
                return self._done(()) if shown else []
            case Heard():
                return []
            case Wake():
                silence = f"the vehicle does not go to item {self._begin} of its mission"
                repeated = self._pending.wake(now_ns)
                return self._failed(None, silence) if repeated is None else repeated
            case Cancel(why):
                return self._failed(None, why)
            case _:
                assert_never(event)
