"""Clients whose system id a vehicle does not hear, as it was told to hear one alone.

What the gate makes of a client's words reaches the vehicle all the same, as the station sends it in
its own name.  What is forwarded unchanged does not, and nobody answers it: so each such client is
told, once for each vehicle and system id.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from gcs.bridge.conversation.answers import texts
from gcs.bridge.effects import AboutVehicle, BridgeEffect, LogLine, Reply
from gcs.bridge.peers.client import Client
from gcs.gate.effects import Level
from gcs.protocol.effects import Address
from gcs.protocol.enforced_sysid import Hears

TEXT_ID: Final = 2
"""Joins the pieces of a text; a dropped-messages text beside it has another."""


class Unheard:
    """What the clients of one station were told of this."""

    def __init__(self) -> None:
        self._told: set[tuple[int, Address, int, Hears]] = set()

    def gone(self, link: int) -> None:
        """Whoever was on that link has gone: the next one there was told nothing."""
        self._told = {told for told in self._told if told[0] != link}

    def told(
        self, client: Client, sysids: Iterable[int], vehicle: Address, hears: Hears
    ) -> list[BridgeEffect]:
        """What a client that calls itself `sysids` is to be told of a vehicle now."""
        done: list[BridgeEffect] = []
        for sysid in sorted({each for each in sysids if each not in hears}):
            key = (client.link, vehicle, sysid, hears)
            if key in self._told:
                continue
            self._told.add(key)
            done += _words(client, sysid, vehicle, hears)
        return done


def _words(client: Client, sysid: int, vehicle: Address, hears: Hears) -> list[BridgeEffect]:
    alone = f"hears system {hears.words} alone ({hears.named})"
    lost = "what only it can answer (parameters, modes on the ground, data) gets no answer"
    note = f"{client.name} is system {sysid}, and vehicle {vehicle.sysid} {alone}: {lost}"
    text = f"gate: vehicle {vehicle.sysid} {alone}, not {sysid}: {lost}; use id {hears.first}"
    return [
        AboutVehicle(vehicle.sysid, (LogLine(Level.WARNING, note),)),
        *(Reply(client.link, vehicle, message) for message in texts(Level.WARNING, text, TEXT_ID)),
    ]
