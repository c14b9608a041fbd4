"""A MAVLink link to a real vehicle, past the gate: what it says of itself, and words to it."""

from typing import Any

from pymavlink import mavutil

from tests.real.autopilots import PX4, Kind
from tests.real.truth import Sample, Truth


class Link:
    def __init__(self, kind: Kind, port: int, sysid: int) -> None:
        self.kind = kind
        self.mavlink: Any = mavutil.mavlink_connection(
            f"udpin:127.0.0.1:{port}", source_system=sysid
        )
        self.truth = Truth()
        self.armed = False
        self.custom_mode = -1
        self.texts: list[str] = []

    @property
    def now(self) -> Sample:
        """The truth."""
        return self.truth.now

    def take(self, message: Any) -> None:
        self.truth.take(message)
        match message.get_type():
            case "HEARTBEAT" if message.get_srcComponent() == 1:
                self.armed = bool(message.base_mode & 128)
                self.custom_mode = message.custom_mode
            case "STATUSTEXT":
                self.texts.append(message.text)

    def command(self, number: int, *params: float) -> None:
        words = [*params, *[0.0] * (7 - len(params))]
        self.mavlink.mav.command_long_send(1, 1, number, 0, *words)

    def mode(self, custom_mode: int) -> None:
        if self.kind is PX4:
            self.command(176, 1.0, custom_mode >> 16 & 255, custom_mode >> 24)
        else:
            self.command(176, 1.0, custom_mode)
