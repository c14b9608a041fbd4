"""The face of `vehicle-sim` on a terminal: one live line per vehicle, log lines above them.

On a pipe there is no face, only plain lines.  `table` is pure; `Face` knows the terminal.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Final

from vehicle_sim.autopilot.interface import Landed

if TYPE_CHECKING:
    from rich.console import Console
    from rich.live import Live

    from vehicle_sim.services.server import VehicleServer
    from vehicle_sim.simulation.channels import Connection

ACTIVE: Final = 4  # MAV_STATE; beyond it is trouble
_ROOM_LEFT: Final = 6  # lines of the terminal that stay for the log
_LEAST_ROOM: Final = 3
_HEAD: Final = ("vehicle", "mode", "state", "height", "speed", "battery", "links")


@dataclass(frozen=True, slots=True)
class VehicleLine:
    """One vehicle as its line shows it, by its own estimate."""

    system: int
    mode: str
    armed: bool
    flying: bool
    failsafe: bool
    up_m: float  # above home
    speed_m_s: float
    battery: float  # charge left, 0..1
    clients: int


@dataclass(frozen=True, slots=True)
class Rhythm:
    """How fast time passes: simulated seconds, and per second of the clock over the last few."""

    time_s: float
    wanted: float
    reached: float


def statuses(servers: Iterable[VehicleServer], links: Iterable[Connection]) -> list[VehicleLine]:
    """Every vehicle's, by its own estimate; a client counts for all vehicles on its link."""
    clients: dict[int, int] = {}
    everybody = 0
    for connection in links:
        if not connection.frames_in:
            continue
        if connection.vehicle is None:
            everybody += 1
        else:
            clients[connection.vehicle] = clients.get(connection.vehicle, 0) + 1
    return [
        _status(server, everybody + clients.get(index, 0)) for index, server in enumerate(servers)
    ]


def _status(server: VehicleServer, clients: int) -> VehicleLine:
    vehicle = server.vehicle
    estimate = vehicle.estimate
    north, east, down = estimate.v_ned
    return VehicleLine(
        system=server.system,
        mode=server.mode_name,
        armed=vehicle.armed,
        flying=vehicle.landed != Landed.ON_GROUND,
        failsafe=vehicle.system_status > ACTIVE,
        up_m=estimate.alt_rel_m,
        speed_m_s=sqrt(north * north + east * east + down * down),
        battery=vehicle.power.remaining_pct / 100.0,
        clients=clients,
    )


def cells(status: VehicleLine) -> tuple[str, ...]:
    """The words of one line."""
    state = "flying" if status.flying else "armed" if status.armed else "disarmed"
    return (
        str(status.system),
        status.mode,
        f"{state}, FAILSAFE" if status.failsafe else state,
        f"{round(status.up_m, 1) + 0.0:.1f} m",  # never -0.0
        f"{status.speed_m_s:.1f} m/s",
        f"{100.0 * status.battery:.0f} %",
        {0: "nobody", 1: "1 client"}.get(status.clients, f"{status.clients} clients"),
    )


def table(statuses: Sequence[VehicleLine], room: int) -> list[tuple[str, ...]]:
    """Rows of words, the head first; beyond `room` vehicles the rest is summed up."""
    shown = statuses if len(statuses) <= room else statuses[: max(1, room - 1)]
    rows = [_HEAD, *(cells(status) for status in shown)]
    rest = statuses[len(shown) :]
    if rest:
        flying = sum(status.flying for status in rest)
        rows.append((f"+{len(rest)}", "", f"{flying} flying", "", "", "", ""))
    return rows


def footer(rhythm: Rhythm) -> str:
    minutes, seconds = divmod(int(rhythm.time_s), 60)
    pace = f"{rhythm.reached:.2f} of {rhythm.wanted:g} times real time"
    return f"{minutes}:{seconds:02d} simulated, {pace}"


class LivePage:
    """Draws on a terminal; use it as a context, so that the cursor comes back."""

    def __init__(self) -> None:
        # Rich is imported when the first vehicle already speaks: it costs a third of its start.
        from rich.console import Console
        from rich.live import Live

        self._console: Console = Console(highlight=False)
        self._live: Live = Live(console=self._console, auto_refresh=False)
        self._live.start()

    def show(self, statuses: Sequence[VehicleLine], rhythm: Rhythm) -> None:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        room = max(_LEAST_ROOM, self._console.height - _ROOM_LEFT)
        head, *rows = table(statuses, room)
        drawn = Table.grid(padding=(0, 2))
        for name in head:
            drawn.add_column(justify="right" if name in ("height", "speed", "battery") else "left")
        drawn.add_row(*(Text(name, style="dim") for name in head))
        for row in rows:
            drawn.add_row(*(Text(word) for word in row))
        self._live.update(Group(drawn, Text(footer(rhythm), style="dim")), refresh=True)

    def say(self, line: str, warning: bool) -> None:
        from rich.text import Text

        self._console.print(Text(line, style="yellow" if warning else ""))

    def close(self) -> None:
        self._live.stop()
