"""The keyboard manager: keys change a pending goal, and nothing else; in velocity mode they fly."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from gcs.frames import Vec3
from gcs.ipc import Ask

START_ENU: Final[Vec3] = (0.0, 0.0, 0.5)
STEPS_M: Final[tuple[float, ...]] = (0.1, 0.5, 1.0, 5.0, 10.0)
MIN_TAKE_OFF_UP_M: Final = 1.5
DIRECTIONS: Final[dict[str, Vec3]] = {
    "east": (1.0, 0.0, 0.0),
    "west": (-1.0, 0.0, 0.0),
    "north": (0.0, 1.0, 0.0),
    "south": (0.0, -1.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}


KEY_COUNTS_S: Final = 0.8
"""A key that is held down counts as held from one repetition of the terminal to the next; before
the first one most wait half a second."""
STILL: Final[Vec3] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class VelocityKeys:
    """Velocity mode: a direction key flies that way for as long as it is held down, then the
    vehicle is asked to stand still.  Metres per second E N U."""

    v_enu: Vec3 = STILL
    until_s: float = 0.0
    typed: bool = False  # by a line, with its end: the stream ends with it

    def pressed(self, direction: str, speed_m_s: float, now_s: float) -> VelocityKeys:
        east, north, up = DIRECTIONS[direction]
        v_enu = (east * speed_m_s, north * speed_m_s, up * speed_m_s)
        return VelocityKeys(v_enu, now_s + KEY_COUNTS_S)

    def over(self, now_s: float) -> bool:
        """A typed velocity has been flown for its time."""
        return self.typed and now_s >= self.until_s

    def flown(self, now_s: float) -> Vec3:
        return self.v_enu if now_s < self.until_s else STILL


@dataclass(frozen=True, slots=True)
class PendingGoal:
    """Metres E N U; `yaw_deg` clockwise from north in [0, 360), None = left to the autopilot."""

    goal_enu: Vec3 = START_ENU
    yaw_deg: float | None = None
    step_m: float = 1.0

    @property
    def ask(self) -> Ask:
        """What is sent of it."""
        return Ask(0, "goto", goal_enu=self.goal_enu, yaw_deg=self.yaw_deg)

    def moved(self, direction: str) -> PendingGoal:
        """One step on; rounded to the millimetre, so that ten steps of 0.1 m make 1 m."""
        way = DIRECTIONS[direction]
        east, north, up = (
            round(metres + self.step_m * along, 3) + 0.0
            for metres, along in zip(self.goal_enu, way, strict=True)
        )
        return replace(self, goal_enu=(east, north, up))

    def turned(self, by_deg: float, vehicle_yaw_deg: float | None) -> PendingGoal:
        """Turned by so much, from the vehicle's heading where no yaw was pending yet."""
        start_deg = self.yaw_deg
        if start_deg is None:
            start_deg = 0.0 if vehicle_yaw_deg is None else float(round(vehicle_yaw_deg / 15) * 15)
        return replace(self, yaw_deg=(start_deg + by_deg) % 360.0)

    def with_free_yaw(self) -> PendingGoal:
        return replace(self, yaw_deg=None)

    def at(self, pos_enu: Vec3) -> PendingGoal:
        """Where the vehicle is, to the decimetre: a goal that can be read aloud."""
        east, north, up = (round(metres, 1) + 0.0 for metres in pos_enu)
        return replace(self, goal_enu=(east, north, up))

    def with_next_step(self) -> PendingGoal:
        following = STEPS_M.index(self.step_m) + 1
        return replace(self, step_m=STEPS_M[following % len(STEPS_M)])

    @property
    def take_off_up_m(self) -> float:
        return max(self.goal_enu[2], MIN_TAKE_OFF_UP_M)
