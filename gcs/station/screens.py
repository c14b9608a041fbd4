"""Which vehicle each operator is shown."""

from __future__ import annotations

from gcs import ipc
from gcs.bridge.bridge import FIRST_NUMBER
from gcs.session.effects import Emit
from gcs.station.operator_control import OperatorControl


class Screens:
    """By the operators' own choice; who has chosen none is shown the first one."""

    def __init__(self, control: OperatorControl) -> None:
        self._control = control
        self._chosen: dict[int, int] = {}

    def show(self, operator: int, sysid: int) -> None:
        """From now on; 0: the first one."""
        chosen = {**self._chosen, operator: sysid}
        self._chosen = {one: each for one, each in chosen.items() if each and one in self._control}

    def chosen(self, operator: int) -> int:
        """The system id that it has asked for; 0: none."""
        return self._chosen.get(operator, 0)

    def shows(self, operator: int, sysid: int, *, first: bool) -> bool:
        """Whether the operator is shown that vehicle, which may be the first one."""
        return self._chosen.get(operator, sysid if first else 0) == sysid

    def tell(self, event: ipc.Event, sysid: int, *, first: bool) -> list[Emit]:
        """The event to those who are shown the vehicle that it is about."""
        if not self._chosen:
            return [Emit(event)] if first else []
        programs = (each for each in self._control if each < FIRST_NUMBER)
        return [Emit(event, each) for each in programs if self.shows(each, sysid, first=first)]

    def elsewhere(self, known: frozenset[int]) -> list[int]:
        """The operators that have chosen a vehicle which is not among these."""
        return [one for one, sysid in self._chosen.items() if sysid not in known]
