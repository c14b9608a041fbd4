"""Who talks with the station, and which of them is in control of it.

One operator is in control and may ask for everything.  The others look, and may ask for what makes
the vehicle safer (`ALWAYS_HEARD`).  Taking control over from another operator is a request of its
own (`station_take`), and all are told of it.  This is about operators; whether the station flies
the vehicle is the gate's (`gcs.gate.states.Control`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from gcs import ipc
from gcs.bridge.bridge import FIRST_NUMBER
from gcs.gate import inputs as gate_inputs
from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.request_words import ALWAYS_HEARD
from gcs.session.effects import Emit
from gcs.session.requests import FIRST
from gcs.session.work import STATION, ForOwner, GateInput, Log, Work

NOBODY = 0

LEAVING_NS = 3_000_000_000
"""How long an operator who leaves waits until the vehicle is seen to hold."""

NODE = "link"


@dataclass(frozen=True, slots=True)
class Operator:
    """One operator's program."""

    number: int
    name: str
    hold_on_leave: bool = True

    @property
    def label(self) -> str:
        return f"operator {self.number} ({self.name})"


class OperatorControl:
    """The operators that are there.  Their numbers are never given a second time."""

    def __init__(self, first_name: str, first_looks: bool = False) -> None:
        """`first_looks`: whoever started the station does not begin in control of it (a bridge)."""
        self._there = {FIRST: Operator(FIRST, first_name)}
        self._by_default = NOBODY if first_looks else FIRST
        self.in_control = self._by_default
        """The operator's number, or NOBODY."""
        self.leaving: dict[int, int] = {}
        """Operators that are still to be told good-bye, and until when they wait for the hold."""

    @property
    def first_is_alone(self) -> bool:
        """Nobody has joined whoever started the station; MAVLink clients look at no screen."""
        return all(operator == FIRST or operator >= FIRST_NUMBER for operator in self._there)

    def name(self, operator: int) -> str:
        """Empty where it is not there."""
        known = self._there.get(operator)
        return known.name if known else ""

    def __contains__(self, operator: int) -> bool:
        return operator in self._there

    def __iter__(self) -> Iterator[int]:
        return iter(self._there)

    # ----------------------------------------------------------------------- come and go

    def join(self, operator: int, name: str, hold_on_leave: bool) -> list[Work]:
        """Another one has connected."""
        joined = self._there[operator] = Operator(operator, name, hold_on_leave)
        return [Log(Level.DEBUG, NODE, f"{joined.label} joined"), self._told()]

    def leave(self, operator: int, hold: bool, now_ns: int) -> list[Work]:
        """It goes in good order: the gate holds the vehicle where that is wanted, now or when it
        joined, and once it is seen to hold, `farewells` says good-bye."""
        leaving = self._there.get(operator)
        if leaving is None or operator in self.leaving:
            return []
        if hold:
            self._there[operator] = replace(leaving, hold_on_leave=True)
        held = self.leaves_held(operator)
        self.leaving[operator] = now_ns + LEAVING_NS if held else now_ns
        return self._hold("left") if held else []

    def leaves_held(self, operator: int) -> bool:
        """Whether the vehicle is held when this operator leaves."""
        return operator == self.in_control and self._there[operator].hold_on_leave

    def lost(self, operator: int, reason: str) -> list[Work]:
        """Its connection ended without a word, perhaps after one: an operator who was in control
        is lost, and the vehicle is held."""
        gone = self._there.get(operator)
        if gone is None:
            return []
        held = operator in self.leaving or operator != self.in_control
        return [*([] if held else self._hold(reason)), *self._forget(gone)]

    def farewells(self, settled: bool, now_ns: int) -> list[int]:
        """Those who left and need not wait any longer: the vehicle is seen to hold, or overdue."""
        return [
            operator for operator, until_ns in self.leaving.items() if settled or now_ns >= until_ns
        ]

    def gone(self, operator: int) -> list[Work]:
        """The good-bye was said."""
        return self._forget(self._there[operator])

    def _forget(self, gone: Operator) -> list[Work]:
        del self._there[gone.number]
        self.leaving.pop(gone.number, None)
        work: list[Work] = [Log(Level.DEBUG, NODE, f"{gone.label} left")]
        if gone.number == self.in_control:
            work += self._give(self._by_default if FIRST in self._there else NOBODY)
        else:
            work.append(self._told())
        return work

    @staticmethod
    def _hold(reason: str) -> list[Work]:
        """Every vehicle that is flown here: none of them has anybody in control any more."""
        return [ForOwner(STATION, (GateInput(gate_inputs.OperatorLost(reason, for_good=False)),))]

    # --------------------------------------------------------------------------- control

    def give_where_free(self, operator: int, ask: ipc.Ask) -> list[Work]:
        """Before a request that `refusal` did not refuse: where nobody is in control, the first
        who asks for something that needs it gets it."""
        if ask.word in ALWAYS_HEARD or self.in_control != NOBODY:
            return []
        return self._give(operator)

    def refusal(self, operator: int, ask: ipc.Ask) -> Refusal | None:
        """Why this operator may not ask for it, if it may not."""
        if operator in self.leaving or operator not in self._there:
            return Refusal(Code.OPERATOR_LOST, "this operator has left")
        if self.in_control in (operator, NOBODY) or (ask.word in ALWAYS_HEARD and not ask.force):
            return None
        other = self._there[self.in_control].label
        how = "take it over with --take, or by the words `station take`"
        if operator >= FIRST_NUMBER:
            how = "MAV_CMD_REQUEST_OPERATOR_CONTROL takes it over"
        return Refusal(
            Code.OTHER_OPERATOR,
            f"{other} is in control of this station; {how}",
            (("in_control", float(self.in_control)),),
        )

    def take(self, operator: int) -> list[Work]:
        """It takes control over from whoever has it."""
        return [] if operator == self.in_control else self._give(operator)

    def release(self, operator: int) -> list[Work]:
        """It gives control up, and the first who asks gets it.

        Until then nobody is in control, so the vehicle is held as for an operator who is lost.
        Hovering would not do: a stream of the same operator that goes on would get control again.
        Who wants a goal flown on lets another one take over.
        """
        if operator != self.in_control:
            return []
        why = f"{self._there[operator].label} has released control"
        return [*self._hold(why), *self._give(NOBODY)]

    def _give(self, operator: int) -> list[Work]:
        before, self.in_control = self._there.get(self.in_control), operator
        now = self._there.get(operator)
        text = "nobody is in control of the station"
        if now is not None:
            text = f"{now.label} is in control of the station"
            text += f", taken over from {before.label}" if before else ""
        return [Log(Level.WARNING if before else Level.INFO, NODE, text), self._told()]

    def _told(self) -> Emit:
        infos = [ipc.OperatorInfo(one.number, one.name) for one in self._there.values()]
        return Emit(ipc.Operators(infos, self.in_control))
