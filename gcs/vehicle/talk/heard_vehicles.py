"""The vehicles that are heard on the links, and whether it is clear which of them is meant."""

from __future__ import annotations

from typing import Final

from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import autopilot_of, type_name
from gcs.session.speedup_waits import Times
from gcs.wire.messages import Heartbeat

LISTEN_NS: Final = 1_200_000_000
"""A heartbeat comes once a second: after this time every vehicle of a good link was heard."""


class Roster:
    """Every autopilot that was heard, by its system id."""

    def __init__(self, chosen: int, times: Times, gone_ns: int) -> None:
        """`chosen`: the system id that the operator named, 0 for none; a vehicle that is silent for
        `gone_ns` counts no more."""
        self._chosen = chosen
        self._listen_ns = times.real_ns(LISTEN_NS)
        self._gone_ns = gone_ns
        self._labels: dict[int, str] = {}
        self._heard_ns: dict[int, int] = {}
        self._first_ns: int | None = None
        self._committed = False

    def heard(self, sysid: int, compid: int, beat: Heartbeat, now_ns: int) -> bool:
        """A heartbeat of an autopilot; whether it is the first of one among others."""
        new = sysid not in self._labels
        autopilot = autopilot_of(beat.autopilot, beat.type)
        self._labels[sysid] = f"{sysid}/{compid} {autopilot.name} {type_name(beat.type)}"
        self._heard_ns[sysid] = now_ns
        self._first_ns = now_ns if self._first_ns is None else self._first_ns
        return new and len(self._labels) > 1

    def names(self, now_ns: int) -> list[str]:
        """Those that are heard now, by id."""
        return [
            self._labels[sysid] for sysid in sorted(self._heard_ns) if self.hears(sysid, now_ns)
        ]

    def hears(self, sysid: int, now_ns: int) -> bool:
        """Whether the autopilot of that system is heard now."""
        heard_ns = self._heard_ns.get(sysid)
        return heard_ns is not None and now_ns - heard_ns <= self._gone_ns

    def listening(self, now_ns: int) -> bool:
        """Whether others may still be heard that were there all the time."""
        if self._chosen or self._first_ns is None:
            return False
        return now_ns - self._first_ns < self._listen_ns

    def refusal(self, now_ns: int) -> Refusal | None:
        """Why a request cannot be for any of them: there are several, and none was chosen.

        Once a request was for the only one, whoever comes later changes nothing: what flies must be
        stopped.
        """
        names = self.names(now_ns)
        if self._chosen or self._committed or len(names) <= 1:
            self._committed |= bool(names)
            return None
        heard = f"{len(names)} vehicles are heard: {', '.join(names)}"
        sentence = f"{heard}; choose one with --vehicle"
        return Refusal(Code.SEVERAL_VEHICLES, sentence, (("vehicles", float(len(names))),))
