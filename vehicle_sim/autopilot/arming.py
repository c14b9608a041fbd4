"""Whether the vehicle may arm, and when it disarms by itself."""

from __future__ import annotations

from vehicle_sim.autopilot.modes import Mode, Personality
from vehicle_sim.autopilot.parameters import Parameters, Quantity

_BATTERY_TOO_LOW = 0.10

# Why not, in the words of each autopilot.
_WORDS: dict[Personality, dict[str, str]] = {
    "px4": {
        "position": "Preflight Fail: no valid position estimate",
        "battery": "Preflight Fail: battery too low",
        "mode": "Arming denied: not in mode {mode}",
    },
    "ardupilot": {
        "position": "PreArm: Need Position Estimate",
        "battery": "PreArm: Battery below minimum arming capacity",
        "mode": "Arm: {mode} mode not armable",
    },
}


def why_not(parameters: Parameters, mode: Mode, position_ok: bool, battery: float) -> str | None:
    """The reason against arming, in the autopilot's own words; None when it may.

    `battery` is the charge left, 0..1.
    """
    words = _WORDS[parameters.personality]
    if not mode.may_arm:
        return words["mode"].format(mode=mode.name)
    if parameters.personality == "ardupilot" and parameters.get("ARMING_CHECK") == 0:
        return None
    if not position_ok:
        return words["position"]
    if battery < _BATTERY_TOO_LOW:
        return words["battery"]
    return None


class AutoDisarm:
    """Disarms an armed vehicle that has landed, or has never taken off.

    Both clocks run on simulated time; negative means never (for ardupilot's DISARM_DELAY: 0).
    `own_landing`: in a mode that lands by itself ArduCopter disarms at once, elsewhere it waits
    DISARM_DELAY; PX4 waits COM_DISARM_LAND after any landing.
    """

    __slots__ = ("_flown", "_since_ns")

    def __init__(self) -> None:
        self._since_ns = 0
        self._flown = False

    def on_ground(self, flown: bool, now_ns: int) -> None:
        """The clock starts: armed just now, or landed just now."""
        self._flown = flown
        self._since_ns = now_ns

    def due(self, parameters: Parameters, own_landing: bool, now_ns: int) -> bool:
        landed = self._flown and (parameters.personality == "px4" or own_landing)
        limit_s = parameters.si(Quantity.DISARM_LANDED_S if landed else Quantity.DISARM_IDLE_S)
        if limit_s < 0.0 or (limit_s == 0.0 and not landed):
            return False
        return now_ns - self._since_ns >= int(limit_s * 1e9)
