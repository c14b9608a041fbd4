"""Operations that go on only while somebody looks at them: a lease that has to be renewed.

`ipc.Ask.lease_s` gives an operation one, `ipc.Renew` renews it.  The station keeps it, not the
operator's program: a program that hangs or is suspended keeps its connection, and renews nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.session.speedup_waits import Times


@dataclass(frozen=True, slots=True)
class _Lease:
    length_ns: int
    until_ns: int


class Leases:
    """By operation, on the session's clock; a lease is real time, as the program that renews it."""

    def __init__(self, times: Times) -> None:
        self._times = times
        self._of: dict[int, _Lease] = {}

    def begin(self, operation: int, lease_s: float | None, now_ns: int) -> None:
        """The operation was accepted; without `lease_s` it has none."""
        if lease_s is not None:
            length_ns = self._times.real_ns(round(lease_s * 1e9))
            self._of[operation] = _Lease(length_ns, now_ns + length_ns)

    def renew(self, operation: int, now_ns: int) -> None:
        """For as long again; one that has run out or has ended stays so."""
        lease = self._of.get(operation)
        if lease is not None:
            self._of[operation] = _Lease(lease.length_ns, now_ns + lease.length_ns)

    def end(self, operation: int) -> None:
        """The operation has ended."""
        self._of.pop(operation, None)

    def overdue(self, now_ns: int) -> list[int]:
        """Those that have run out, once each."""
        over = [operation for operation, lease in self._of.items() if now_ns >= lease.until_ns]
        for operation in over:
            del self._of[operation]
        return over
