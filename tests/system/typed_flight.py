"""The beginning of every flight at the keyboard, typed with real keys."""

from __future__ import annotations

from tests.system.terminal import Terminal

UP = "takeoff 1.5: complete"
TOO_EARLY = "refused NO_ORIGIN"


def until_state(screen: Terminal, state: str) -> None:
    """The state as the first line of the screen shows it, beside the vehicle."""
    screen.until_text(f"px4 quadrotor   {state} ")


def take_off(screen: Terminal) -> None:
    """Arm and climb to 1.5 m, once the vehicle's home is known."""
    until_state(screen, "GROUNDED")
    answer = TOO_EARLY
    while answer == TOO_EARLY:
        screen.press("m")
        screen.until_text("arm: complete")
        screen.press("t")
        answer = screen.until_either(UP, TOO_EARLY)
