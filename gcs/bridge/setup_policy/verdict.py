"""What the guard is told beside a message, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.messages import Message


@dataclass(frozen=True, slots=True)
class GuardSeen:
    """Who sent a message, and how the vehicle is."""

    client: Address
    vehicle: Address
    """The autopilot's."""
    armed: bool | None
    on_ground: bool
    max_takeoff_up_m: float = 0.0
    """The policy's highest take-off; 0: its default height may not be set."""
    in_control: bool = True
    """The client is in control of the station, or nobody is."""
    now_ns: int = 0

    @property
    def stands_disarmed(self) -> bool:
        """Known to be disarmed, and on the ground."""
        return self.armed is False and self.on_ground


@dataclass(frozen=True, slots=True)
class Allowed:
    """It goes to the vehicle unchanged; `note` is what the log says of it, empty for nothing."""

    note: str = ""


@dataclass(frozen=True, slots=True)
class Refused:
    """It does not.

    `answers` go to the client in the name of the component that it addressed.  A command's
    COMMAND_ACK and the STATUSTEXT with the reason are not among them: the bridge makes those of
    every refusal.  `ask_vehicle` goes to the vehicle in the place of what was refused, so that the
    vehicle itself tells the client what it has.
    """

    refusal: Refusal
    answers: tuple[Message, ...] = ()
    ask_vehicle: tuple[Message, ...] = ()


Judgement: TypeAlias = Allowed | Refused


def by_choice(choice: str, key: str, what: str, seen: GuardSeen) -> Judgement:
    """As the policy's `choice` for `key` has it."""
    match choice:
        case "forward":
            return Allowed(f"{what} is forwarded")
        case "on_ground" if seen.stands_disarmed:
            return Allowed(f"{what} is forwarded")
        case "on_ground":
            return Refused(Refusal(Code.IN_AIR, on_ground_only(what, key)))
        case _:
            return Refused(Refusal(Code.POLICY, not_allowed(what, key)))


def on_ground_only(what: str, key: str) -> str:
    """The sentence of what the policy's "on_ground" refuses."""
    sentence = f"{what} is allowed while the vehicle is disarmed on the ground only"
    return f"{sentence} (policy: bridge.{key})"


def not_allowed(what: str, key: str) -> str:
    """The sentence of what the policy's "refuse" refuses."""
    return f"{what} is not allowed (policy: bridge.{key})"
