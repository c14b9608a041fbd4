"""Flying, as a Python program asks for it: one method a request."""

from __future__ import annotations

from gcs import ipc
from gcs.operator import arguments
from gcs.operator.operation import Operation
from gcs.operator.requests.asks import Asks


@arguments.all_called_right
class Flights(Asks):
    """Everything that moves the vehicle, or stops it."""

    def control(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Take control of a vehicle that flies without the station, and hover."""
        return self.request(ipc.Ask(0, "control"), wait, timeout_s)

    def arm(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Start the motors on the ground; complete when the vehicle reports that it is armed."""
        return self.request(ipc.Ask(0, "arm"), wait, timeout_s)

    def disarm(
        self, *, force: bool = False, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Stop the motors on the ground; `force` in the air too, where the policy allows it."""
        return self.request(ipc.Ask(0, "disarm", force=bool(force)), wait, timeout_s)

    def takeoff(
        self, up_m: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Climb to `up_m` metres above the take-off point and hover."""
        up = arguments.number("takeoff", up_m=up_m)
        return self.request(ipc.Ask(0, "takeoff", up_m=up), wait, timeout_s)

    def goto(
        self,
        east_m: float,
        north_m: float,
        up_m: float,
        yaw_deg: float | None = None,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly straight there and hover; metres from the local origin.  `yaw_deg` from -360 to 360
        is clockwise from north, and the goal is reached when the nose points there, too; None
        leaves the heading to the autopilot."""
        ask = goto_of("goto", east_m, north_m, up_m, yaw_deg)
        return self.request(ask, wait, timeout_s)

    def goto_global(
        self,
        lat_deg: float,
        lon_deg: float,
        up_m: float,
        yaw_deg: float | None = None,
        *,
        amsl: bool = False,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly straight to a place on the map and hover, `up_m` metres above home; with `amsl` above
        mean sea level.  The operation's `goal_enu` is where that is."""
        goal = arguments.numbers("goto_global", lat_deg=lat_deg, lon_deg=lon_deg, up_m=up_m)
        yaw = arguments.degrees("goto_global", yaw_deg=yaw_deg)
        ask = ipc.Ask(0, "goto", goal_global=goal, amsl=bool(amsl), yaw_deg=yaw)
        return self.request(ask, wait, timeout_s)

    def move(
        self,
        east_m: float = 0.0,
        north_m: float = 0.0,
        up_m: float = 0.0,
        yaw_deg: float | None = None,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly straight so far from where the vehicle is reported when the station hears of this,
        and hover."""
        moved = arguments.numbers("move", east_m=east_m, north_m=north_m, up_m=up_m)
        yaw = arguments.degrees("move", yaw_deg=yaw_deg)
        return self.request(ipc.Ask(0, "goto", move_enu=moved, yaw_deg=yaw), wait, timeout_s)

    def forward(
        self,
        forward_m: float,
        right_m: float = 0.0,
        up_m: float = 0.0,
        *,
        wait: bool = True,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly straight so far where the vehicle's nose points, to the right of that, and up; and
        hover.  A heading that it still turns to counts as the one where its nose points."""
        moved = arguments.numbers("forward", forward_m=forward_m, right_m=right_m, up_m=up_m)
        return self.request(ipc.Ask(0, "goto", move_body=moved), wait, timeout_s)

    def heading(
        self, yaw_deg: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Turn the nose, degrees clockwise from north, and keep the place.  It is complete when the
        nose points there, within the policy's `[arrival] yaw_deg`."""
        yaw = arguments.degrees("heading", yaw_deg=arguments.finite("heading", yaw_deg=yaw_deg))
        return self.request(ipc.Ask(0, "heading", yaw_deg=yaw), wait, timeout_s)

    def speed(
        self, speed_m_s: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """The most that the next legs of `goto`, `move` and others are flown at, whoever asks for
        them.  Refused where the policy's `[pace]` has less."""
        most = arguments.number("speed", speed_m_s=speed_m_s)
        return self.request(ipc.Ask(0, "speed", speed_m_s=most), wait, timeout_s)

    def orbit(
        self,
        radius_m: float,
        speed_m_s: float,
        centre: tuple[float, float, float] | None = None,
        *,
        turns: float = 1.0,
        nose: str = "centre",
        wait: bool | None = None,
        timeout_s: float | None = None,
    ) -> Operation:
        """Fly to the circle and round it; a positive radius is clockwise, seen from above.

        `centre` is metres east, north, up; None is where the vehicle is.  `turns` 0 is until
        something else is asked for, and then it is waited for only if that is said.  `nose`:
        centre, initial, free, along.  A speed that the policy or the circle does not allow is
        refused.
        """
        circle = ipc.Circle(
            arguments.place("orbit", centre=centre),
            arguments.finite("orbit", radius_m=radius_m),
            arguments.finite("orbit", speed_m_s=speed_m_s),
            arguments.finite("orbit", turns=turns),
            arguments.text("orbit", nose=nose),
        )
        waits = turns > 0.0 if wait is None else wait
        return self.request(ipc.Ask(0, "orbit", orbit=circle), waits, timeout_s)

    def land(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Land where it is."""
        return self.request(ipc.Ask(0, "land"), wait, timeout_s)

    def rtl(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Return to home and land."""
        return self.request(ipc.Ask(0, "rtl"), wait, timeout_s)

    def hold(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Stop and hold, in the vehicle's own hold mode."""
        return self.request(ipc.Ask(0, "hold"), wait, timeout_s)

    def abort(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Stop now and forget the goal; whoever is in control, and whatever is waited for."""
        return self.request(ipc.Ask(0, "abort"), wait, timeout_s)

    def resume(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """After a hold: hover under the station's control."""
        return self.request(ipc.Ask(0, "resume"), wait, timeout_s)

    def photo(self, *, wait: bool = True, timeout_s: float | None = None) -> Operation:
        """Take a picture while hovering (after a hold `resume` first); moves are refused meanwhile.
        Once it is complete, `picture` of what is returned is the vehicle's own number of it."""
        return self.request(ipc.Ask(0, "photo"), wait, timeout_s)

    def mode(
        self, mode_name: str, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Ask for a flight mode by the autopilot's own name."""
        name = arguments.text("mode", mode_name=mode_name)
        return self.request(ipc.Ask(0, "mode", mode=name), wait, timeout_s)

    def take_control(self) -> None:
        """Be the operator in control of this station, in place of whoever is; all are told."""
        self.request(ipc.Ask(0, "station_take"))


def goto_of(method: str, east_m: object, north_m: object, up_m: object, yaw_deg: object) -> ipc.Ask:
    """A go-to of checked numbers."""
    goal = arguments.numbers(method, east_m=east_m, north_m=north_m, up_m=up_m)
    return ipc.Ask(0, "goto", goal_enu=goal, yaw_deg=arguments.degrees(method, yaw_deg=yaw_deg))
