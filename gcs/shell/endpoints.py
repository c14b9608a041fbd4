"""Where a link goes, as people write it: MAVSDK's URLs and pymavlink's device strings.

One table of forms feeds the parser and the errors.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

LOOPBACK = "127.0.0.1"
DEFAULT_BAUD = 57_600
MAX_PORT = 65_535


class Kind(Enum):
    UDP_IN = "udpin"
    UDP_OUT = "udpout"
    TCP_IN = "tcpin"
    TCP_OUT = "tcpout"
    SERIAL = "serial"


class EndpointError(ValueError):
    """The text is no endpoint; `hint` says what one looks like."""

    def __init__(self, text: str, why: str, hint: str) -> None:
        super().__init__(f"{text}: {why}")
        self.hint = hint


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One end of a link.  `host` and `port` for networks, `device` and `baud` for serial lines."""

    kind: Kind
    host: str = ""
    port: int = 0
    device: str = ""
    baud: int = DEFAULT_BAUD

    @property
    def listens(self) -> bool:
        """Whether it waits for the other side; then port 0 means any free one."""
        return self.kind in (Kind.UDP_IN, Kind.TCP_IN)

    def __str__(self) -> str:
        """In MAVSDK's form."""
        if self.kind is Kind.SERIAL:
            return f"serial://{self.device}:{self.baud}"
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.kind.value}://{host}:{self.port}"


class Form(NamedTuple):
    """One way to write one kind.  An empty host means loopback."""

    prefix: str
    kind: Kind
    example: str


FORMS = (
    Form("udpin://", Kind.UDP_IN, "udpin://127.0.0.1:14540"),
    Form("udpout://", Kind.UDP_OUT, "udpout://192.168.1.20:14550"),
    Form("tcpout://", Kind.TCP_OUT, "tcpout://127.0.0.1:5760"),
    Form("tcpin://", Kind.TCP_IN, "tcpin://127.0.0.1:5760"),
    Form("serial://", Kind.SERIAL, "serial:///dev/ttyUSB0:57600"),
    Form("udpin:", Kind.UDP_IN, "udpin:127.0.0.1:14550"),
    Form("udpout:", Kind.UDP_OUT, "udpout:127.0.0.1:14550"),
    Form("udp:", Kind.UDP_IN, "udp:127.0.0.1:14550"),
    Form("tcpin:", Kind.TCP_IN, "tcpin:127.0.0.1:5760"),
    Form("tcp:", Kind.TCP_OUT, "tcp:127.0.0.1:5760"),
    Form("/dev/", Kind.SERIAL, "/dev/ttyUSB0,57600"),
    Form("COM", Kind.SERIAL, "COM4,57600"),
)
"""Longer prefixes stand before the shorter ones that they begin with."""

_HOST_PORT = re.compile(r"(?:\[(?P<v6>[0-9A-Fa-f:.%]+)\]|(?P<host>[^:\[\]/]*)):(?P<port>\d+)")
_SERIAL = re.compile(r"(?P<device>/[^,]+?|COM\d+)(?:[:,](?P<baud>\d+))?")


def parse_endpoint(text: str) -> Endpoint:
    """Raises EndpointError."""
    text = text.strip()
    for form in FORMS:
        rest = text.removeprefix(form.prefix)
        if rest != text and not rest.startswith("//"):
            if form.kind is Kind.SERIAL:
                device = rest if form.prefix.endswith("://") else text
                return _serial(text, device, form)
            return _network(text, rest, form)
    scheme = text.partition(":")[0]
    if scheme == "udp":  # udp:// is MAVSDK's older spelling
        place = text.removeprefix("udp://")
        place = LOOPBACK + place if place.startswith(":") else place
        hint = f"udpin://{place} to listen there, or udpout://{place} to send there first"
        raise EndpointError(text, "does not say which side begins", hint)
    known = [form.example for form in FORMS if scheme and form.prefix.startswith(scheme)]
    examples = known or [form.example for form in FORMS if form.prefix.endswith("://")]
    raise EndpointError(text, "no known kind of endpoint", "such as " + ", ".join(examples))


def _network(text: str, rest: str, form: Form) -> Endpoint:
    hint = f"such as {form.example}"
    match = _HOST_PORT.fullmatch(rest)
    if match is None:
        raise EndpointError(text, "expected HOST:PORT after " + form.prefix, hint)
    endpoint = Endpoint(form.kind, match["v6"] or match["host"] or LOOPBACK, int(match["port"]))
    if endpoint.port > MAX_PORT:
        raise EndpointError(text, f"port {endpoint.port} is over {MAX_PORT}", hint)
    if endpoint.port == 0 and not endpoint.listens:
        raise EndpointError(text, "port 0 is nowhere to send to", hint)
    return endpoint


def _serial(text: str, device: str, form: Form) -> Endpoint:
    match = _SERIAL.fullmatch(device)
    if match is None:
        raise EndpointError(text, "expected DEVICE and BAUD", f"such as {form.example}")
    baud = int(match["baud"]) if match["baud"] else DEFAULT_BAUD
    if baud == 0:
        raise EndpointError(text, "a baud rate of 0", f"such as {form.example}")
    return Endpoint(Kind.SERIAL, device=match["device"], baud=baud)
