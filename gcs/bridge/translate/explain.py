"""What the gate makes of a message, command or flight mode, in words: `gcs bridge --explain NAME`.

Of a mode nothing is said twice: the lines are what `modes.for_mode` answers in a few situations.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from gcs.bridge.translate.commands import COMMANDS
from gcs.bridge.translate.meaning import Forward, Meaning, Reject, Seen, Words
from gcs.bridge.translate.modes import for_mode
from gcs.bridge.translate.translate import MESSAGES
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot, Mode, mode_named
from gcs.wire.ids import Cmd

AUTOPILOTS: Final = (PX4, ARDUPILOT)

WHAT_IT_IS: Final = {
    FlightMode.HOLD: "it holds its place",
    FlightMode.GUIDED: "a program flies it",
    FlightMode.TAKEOFF: "it takes off",
    FlightMode.MISSION: "it flies its mission",
    FlightMode.RETURN: "it returns and lands",
    FlightMode.LAND: "it lands",
    FlightMode.OTHER: "a pilot flies it with sticks, or it is for something else",
}


def meaning_explanation(name: str) -> str | None:
    """One line about the message or command whose row is called `name`; None where it asks the
    gate for nothing."""
    says = {Cmd(number).name: row.says for number, row in COMMANDS.items()}
    says |= {row.name: row.says for row in MESSAGES.values()}
    return f"  the gate makes of it: {says[name]}" if name in says else None


def mode_explanation(name: str, manual_modes: tuple[str, ...]) -> str | None:
    """Some lines for a person, for each autopilot that has a mode called so; None: none has.

    `manual_modes` are those of the policy.
    """
    found = [(who, mode_named(who, name.strip())) for who in AUTOPILOTS]
    told = [
        line for who, mode in found if mode is not None for line in _lines(who, mode, manual_modes)
    ]
    return "\n".join(told) if told else None


def _lines(autopilot: Autopilot, mode: Mode, manual_modes: tuple[str, ...]) -> Iterator[str]:
    yield f"{mode.name}, a mode of {autopilot.name}: {WHAT_IT_IS[mode.meaning]}"
    yield "  from the client in control, what the gate is asked for, and then decides:"
    situations: dict[str, list[str]] = {}
    for situation, bare in _situations(autopilot):
        seen = replace(bare, manual_modes=manual_modes)
        situations.setdefault(_said(for_mode(mode, seen)), []).append(situation)
    for said, where in situations.items():
        yield f"    {'; '.join(where)}: {said}"
    yield f"  of DO_SET_MODE, which asks for it: {COMMANDS[Cmd.DO_SET_MODE].says}"


def _situations(autopilot: Autopilot) -> Iterator[tuple[str, Seen]]:
    named = autopilot.mode_of_meaning
    hovering = Seen(
        autopilot=autopilot,
        origin=None,
        home_ned=None,
        home_amsl_m=None,
        pos_ned=None,
        v_ned=(0.0, 0.0, 0.0),
        yaw_rad=None,
        on_ground=False,
        armed=True,
        mode_name=named[FlightMode.GUIDED],
        goal_ned=None,
        takeoff_up_m=0.0,
        state=State.HOVERING,
        in_control=True,
    )
    on_hold = replace(hovering, state=State.HOLDING, mode_name=named[FlightMode.HOLD])
    returning = replace(hovering, state=State.RETURNING, mode_name=named[FlightMode.RETURN])
    standing = replace(on_hold, state=State.GROUNDED, on_ground=True, armed=False)
    yield "disarmed on the ground", standing
    yield "hovering under the gate", hovering
    yield "hovering, the client sends sticks", replace(hovering, has_sticks=True)
    yield "on hold", on_hold
    yield "returning", returning


def _said(meaning: Meaning) -> str:
    match meaning:
        case Words(asks=()):
            return "nothing, it is so already"
        case Words(asks, note):
            words = [ask.word.replace("_", " ") for ask in asks]
            if words == ["mode"]:
                return "refused by the gate"
            return ", then ".join(words) + (f" ({note})" if note else "")
        case Forward():
            return "forwarded to the vehicle"
        case Reject(refusal):
            return f"refused {refusal.code.value}: {refusal.sentence}"
        case _:
            raise AssertionError(f"no mode means {meaning}")
