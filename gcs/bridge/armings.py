"""Armings of the vehicles, whoever asks for them, and what clients have chosen to fly after one.

A take-off or a mission that a client asks for before it arms is kept until then
(`peers/client.py`); the mode of a mission is set on the vehicle meanwhile (`mission_mode.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from gcs import ipc
from gcs.bridge.addressing import Judges
from gcs.bridge.effects import BridgeEffect
from gcs.bridge.peers.client import Exchange, of_vehicle
from gcs.gate.refusal import Refusal


class Armings:
    """Of all vehicles, which are named by their system ids."""

    def __init__(self, judges: Judges, exchanges: Callable[[int], Sequence[Exchange]]) -> None:
        """`exchanges` are those of all clients that are there, with one vehicle."""
        self._judges = judges
        self._exchanges = exchanges
        self._shown_armed: dict[int, bool] = {}
        """By the last heartbeat of each vehicle."""

    def why_not(self, command: ipc.Command, vehicle: int) -> Refusal | None:
        """Why an arming of any operator cannot be judged now."""
        if not isinstance(command, ipc.Ask) or command.word != "arm":
            return None
        return self._judges.of(vehicle).mission_mode.why_not_arm()

    def asked(self, vehicle: int, now_ns: int) -> None:
        """Somebody's arming goes to that vehicle's gate, which sets hold first."""
        for each in self._exchanges(vehicle):
            each.keep_mode_for_now(now_ns)

    def sent(self, vehicle: int, now_ns: int) -> None:
        """The gate has that vehicle armed, whoever asked for it."""
        self._judges.of(vehicle).mission_mode.arm_sent(now_ns)

    def refused(self, vehicle: int) -> None:
        """The vehicle has refused an arming.  Of one that it accepts a heartbeat is to tell."""
        self._judges.of(vehicle).mission_mode.arm_ended()

    def unasked(self, vehicle: int, *, armed: bool, asked: bool) -> bool:
        """Whether a heartbeat shows the vehicle armed that the one before showed disarmed, and not
        by an arming of the gate's: one that is `asked` for now, or that may still come late.

        The gate forgets a vehicle that is lost; here what it was then counts when it is back.
        """
        was, self._shown_armed[vehicle] = self._shown_armed.get(vehicle), armed
        late = self._judges.of(vehicle).mission_mode.arm_may_come
        return armed and was is False and not (asked or late)

    def seen(self, vehicle: int, now_ns: int) -> list[BridgeEffect]:
        """A heartbeat shows it armed: nothing that was chosen before is flown.  A mode that may
        have come after the arming is taken back at once.  Otherwise it is not any more: who arms a
        vehicle that shows it wants it."""
        mode = self._judges.of(vehicle).mission_mode
        late = mode.may_have_come_late()
        mode.arm_ended()
        held: list[BridgeEffect] = []
        for each in self._exchanges(vehicle):
            if late:
                held += of_vehicle(each, each.take_mode_back())
            each.keep_mode()
        return [*held, *self.not_standing(vehicle, "the vehicle is armed", now_ns)]

    def shown(self, mode_name: str, vehicle: int, now_ns: int, *, armed: bool) -> None:
        """A heartbeat of that vehicle shows this mode, and whether it is armed."""
        self._judges.of(vehicle).mission_mode.shown(mode_name, now_ns)
        for each in self._exchanges(vehicle):
            each.dialogue.shown(mode_name, armed=armed)

    def not_standing(self, vehicle: int, why: str, now_ns: int) -> list[BridgeEffect]:
        """Nothing that was chosen before is flown.  Disarmed, it may be said to fly for a moment;
        a mode that a client has set is taken back all the same."""
        return [
            done
            for each in self._exchanges(vehicle)
            for done in of_vehicle(each, each.forget_choice(why, now_ns))
        ]
