"""Heartbeats of clients: each goes to the other clients, once.

A client that sends back what it hears (a router, an echo) would have it go round again and again;
and one that calls itself a vehicle would be one for all the others, which no gate flies.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.effects import BridgeEffect, ForwardToLink, LogLine
from gcs.bridge.peers.client import Client
from gcs.bridge.routing import Routes
from gcs.gate.effects import Level
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.ids import MavAutopilot, MavType
from gcs.wire.messages import Heartbeat

THERE_NS: Final = 5_000_000_000
"""How long after its last heartbeat an address is still at home on its link; then another link may
be its home, as for a client that has come back under another port."""
MOST_HOMES: Final = 1024
"""Of more addresses, those that are silent are forgotten."""
NO_VEHICLES: Final = frozenset(
    {
        MavType.GCS,
        MavType.ONBOARD_CONTROLLER,
        MavType.GIMBAL,
        MavType.ADSB,
        MavType.CAMERA,
    }
)
"""Types that scripts and companion computers give, some with an autopilot, without being one."""


class ClientHeartbeats:
    """Which of them go to the other clients."""

    def __init__(self, routes: Routes) -> None:
        self._routes = routes
        self._homes: dict[tuple[int, int], tuple[int, int]] = {}
        """By address: the link on which it was heard first, and when it was heard there last."""
        self._told: set[tuple[int, int, int]] = set()
        """Link and address of clients that call themselves a vehicle, which was told."""

    def gone(self, link: int) -> None:
        """The client on that link has gone."""
        self._homes = {who: home for who, home in self._homes.items() if home[0] != link}
        self._told = {told for told in self._told if told[0] != link}

    def go_round(self, client: Client, frame: Frame, now_ns: int) -> list[BridgeEffect]:
        """A client's HEARTBEAT, for the others; not for those of the same address."""
        who = frame.sysid, frame.compid
        if not self._at_home(who, client.link, now_ns):
            return []
        beat = decode(frame)
        if isinstance(beat, Heartbeat) and _is_vehicle(beat):
            return self._plays_vehicle(client, who)
        others = self._routes.between_clients(frame, client.link)
        return [
            ForwardToLink(other, frame.raw)
            for other in others
            if not self._routes.was_heard(other, frame.sysid, frame.compid)
        ]

    def _at_home(self, who: tuple[int, int], link: int, now_ns: int) -> bool:
        """Whether that link is where the address is; it is from now on where it is nowhere else."""
        home = self._homes.get(who)
        if home is not None and home[0] != link and now_ns - home[1] <= THERE_NS:
            return False
        if home is None and len(self._homes) >= MOST_HOMES:
            there = self._homes.items()
            self._homes = {each: at for each, at in there if now_ns - at[1] <= THERE_NS}
        self._homes[who] = link, now_ns
        return True

    def _plays_vehicle(self, client: Client, who: tuple[int, int]) -> list[BridgeEffect]:
        told = client.link, *who
        if told in self._told:
            return []
        self._told.add(told)
        text = (
            f"heartbeats of {client.name} are not sent to other clients: it calls itself "
            f"{who[0]}/{who[1]}, a vehicle; a vehicle belongs on a --vehicle link"
        )
        return [LogLine(Level.WARNING, text)]


def _is_vehicle(beat: Heartbeat) -> bool:
    return beat.autopilot != MavAutopilot.INVALID and beat.type not in NO_VEHICLES
