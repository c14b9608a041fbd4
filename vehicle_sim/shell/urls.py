"""Endpoint URLs: MAVSDK's form and pymavlink's, from one table.

The URL says what the *vehicle* does: `udpout` sends to that address unasked, `udpin` waits there.
Behind it may stand `,normal` or `,onboard`: which streams the link has (`stream_sets.py`).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

from vehicle_sim.services.stream_sets import LinkMode


class UrlKind(Enum):
    UDP_IN = "udpin"
    UDP_OUT = "udpout"
    TCP_IN = "tcpin"
    TCP_OUT = "tcpout"


KINDS: Final[dict[str, UrlKind]] = {
    "udpin://": UrlKind.UDP_IN,
    "udpout://": UrlKind.UDP_OUT,
    "tcpin://": UrlKind.TCP_IN,
    "tcpout://": UrlKind.TCP_OUT,
    "udpin:": UrlKind.UDP_IN,
    "udpout:": UrlKind.UDP_OUT,
    "udp:": UrlKind.UDP_IN,
    "tcpin:": UrlKind.TCP_IN,
    "tcp:": UrlKind.TCP_OUT,
}
"""By prefix, longest first."""

VIEW_FORM: Final = "udp://HOST:PORT"
FORMS: Final = "udpin://HOST:PORT, udpout://HOST:PORT, tcpin://HOST:PORT or tcpout://HOST:PORT"
MODES: Final = {mode.value: mode for mode in LinkMode}


_WAITING: Final = frozenset({UrlKind.UDP_IN, UrlKind.TCP_IN})
_OTHER_END: Final = {
    UrlKind.UDP_IN: UrlKind.UDP_OUT,
    UrlKind.UDP_OUT: UrlKind.UDP_IN,
    UrlKind.TCP_IN: UrlKind.TCP_OUT,
    UrlKind.TCP_OUT: UrlKind.TCP_IN,
}


class UrlError(ValueError):
    """A URL that names no endpoint; the message says what is wrong with it."""


@dataclass(frozen=True, slots=True)
class Url:
    kind: UrlKind
    host: str
    port: int
    mode: LinkMode | None = None  # None: the port says it

    @property
    def waits(self) -> bool:
        """It is bound here; port 0 lets the system choose."""
        return self.kind in _WAITING

    def at(self, port: int) -> Url:
        return Url(self.kind, self.host, port, self.mode)

    @property
    def other_end(self) -> Url:
        """What a client is told, to be at the other end."""
        host = "127.0.0.1" if self.host == "0.0.0.0" else self.host
        return Url(_OTHER_END[self.kind], host, self.port, self.mode)

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.kind.value}://{host}:{self.port}"


def parse(text: str) -> Url:
    """Without a host it is loopback.  Raises UrlError."""
    place, comma, word = text.partition(",")
    if comma and word not in MODES:
        raise UrlError(f"{text}: behind the comma stands normal or onboard, not {word!r}")
    for prefix, kind in KINDS.items():
        if place.startswith(prefix):
            host, colon, port = place.removeprefix(prefix).rpartition(":")
            if not colon or not port.isascii() or not port.isdigit():
                raise UrlError(f"{text}: a port is missing; use {FORMS}")
            least = 0 if kind in _WAITING else 1
            if not least <= int(port) < 65536:
                raise UrlError(f"{text}: {port} is no port (1 to 65535)")
            return Url(kind, host.strip("[]") or "127.0.0.1", int(port), MODES.get(word))
    raise UrlError(f"{text}: no such kind of link; use {FORMS}")


def parse_view(text: str) -> Url:
    """Where a 3-D viewer waits: here `udp` sends.  Raises UrlError."""
    if not text.startswith("udp://"):
        raise UrlError(f"{text}: a viewer is sent to by {VIEW_FORM}")
    return parse(f"udpout://{text.removeprefix('udp://')}")
