"""The failsafe that is being acted on, and the delay before that."""

from __future__ import annotations

from math import inf

from vehicle_sim.autopilot.failsafes.failsafe import Action, Failsafe
from vehicle_sim.autopilot.modes import Mode

_EMERGENCY = frozenset({Action.DESCEND, Action.DISARM, Action.TERMINATE})


class ActingFailsafe:
    """`failsafe` is what is acted on, from the mode `came_from`, in place of `overruled`.

    `due_ns`: until then PX4 holds, so that somebody can take over; `grace_left_s` is what was left
    of that delay at `grace_ns`.  `on_its_own`: the mode is being changed by it, not by an operator.
    """

    __slots__ = (
        "came_from",
        "due_ns",
        "failsafe",
        "grace_left_s",
        "grace_ns",
        "on_its_own",
        "overruled",
    )

    def __init__(self, time_ns: int) -> None:
        self.restart(time_ns)

    def restart(self, time_ns: int) -> None:
        """As after power-up."""
        self.on_its_own = False
        self.due_ns: int | None = None
        self.grace_left_s = inf
        self.grace_ns = time_ns
        self.stand_down(time_ns)

    def stand_down(self, time_ns: int) -> None:
        """Nothing is being done about anything."""
        if self.due_ns is not None:  # what is left of the delay is left for the next one
            self.grace_left_s = max(0.0, (self.due_ns - time_ns) * 1e-9)
            self.grace_ns = time_ns
        self.failsafe: Failsafe | None = None
        self.due_ns = None
        self.came_from: Mode | None = None
        self.overruled: Failsafe | None = None

    @property
    def emergency(self) -> bool:
        """What is being done is a last resort: MAV_STATE_EMERGENCY in place of CRITICAL."""
        return self.failsafe is not None and self.failsafe.action in _EMERGENCY
