"""A camera that needs time: one exposure after another, each told when it is over."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Shot:
    """A picture that was just finished; `index` counts from 0 since boot."""

    index: int


class Camera:
    """`update` with the simulated time; at most one picture is in the making."""

    __slots__ = ("_interval_ns", "_left", "_next_ns", "_ready_ns", "images")

    def __init__(self) -> None:
        self.images = 0
        self._ready_ns: int | None = None
        self._left = 0
        self._next_ns = 0
        self._interval_ns = 0

    @property
    def exposing(self) -> bool:
        return self._ready_ns is not None

    @property
    def busy(self) -> bool:
        """A picture, or a series of them, is under way."""
        return self._ready_ns is not None or self._left != 0

    def capture(self, interval_s: float, count: int, now_ns: int) -> None:
        """`count` pictures (0 = until `stop`), the start of one `interval_s` after the last."""
        self._left = count if count > 0 else -1
        self._interval_ns = int(interval_s * 1e9)
        self._next_ns = now_ns

    def stop(self) -> None:
        """No further picture; one in the making is finished."""
        self._left = 0

    def update(self, now_ns: int, exposure_s: float) -> Shot | None:
        """The picture that is ready now, if one is."""
        shot = None
        if self._ready_ns is not None and now_ns >= self._ready_ns:
            self._ready_ns = None
            shot = Shot(self.images)
            self.images += 1
        if self._ready_ns is None and self._left != 0 and now_ns >= self._next_ns:
            self._ready_ns = now_ns + int(exposure_s * 1e9)
            self._next_ns = now_ns + self._interval_ns
            if self._left > 0:
                self._left -= 1
        return shot
