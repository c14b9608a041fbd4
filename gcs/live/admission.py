"""Who may connect: by the page that asks (Origin), and by the name it asked for (Host).  Pure.

A browser lets any page connect to this machine, and says in Origin which page it is.  A page that
gives its own name this machine's address (DNS rebinding) is seen by the Host.
"""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from urllib.parse import urlsplit

VIEWERS = ("https://app.foxglove.dev", "file://")
"""The pages of Foxglove, and the desktop programs (Electron's pages are files).  Files that a
browser shows, and frames in a sandbox on any page, say `null`, and are not let in."""
LOCAL_HOSTS = ("localhost", "127.0.0.1", "::1")


@dataclass(frozen=True, slots=True)
class Admission:
    """`host` is where we listen; `allowed` are origins (`https://viewer.example`) and names of this
    machine (`station.lan`) that are let in, too."""

    host: str
    allowed: frozenset[str] = frozenset()

    def why_refused(self, origin: str | None, host: str | None) -> str:
        """A sentence; empty where it is let in.  A program that is no browser tells no origin."""
        if origin == "null" and origin not in self.allowed:
            return "a page that does not tell its origin ('null') is not let in"
        if origin is not None and not self._knows_origin(origin):
            return f"a page of {origin[:80]!r} is not let in (gcs live --allow {origin[:80]})"
        name = _host_of(f"//{host or ''}")
        if not self._knows_host(name):
            return f"this machine is not known as {name[:80]!r} (gcs live --allow {name[:80]})"
        return ""

    def _knows_origin(self, origin: str) -> bool:
        if origin in VIEWERS or origin in self.allowed:
            return True
        return origin.startswith(("http://", "https://")) and _host_of(origin) in LOCAL_HOSTS

    def _knows_host(self, name: str) -> bool:
        if name in LOCAL_HOSTS or name in (self.host, *self.allowed):
            return True
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return False
        return True


def _host_of(url: str) -> str:
    try:
        return urlsplit(url).hostname or ""
    except ValueError:
        return ""
