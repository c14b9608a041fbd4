"""What an import found."""

from __future__ import annotations

from dataclasses import dataclass, field

METADATA = "import"
"""Name of the metadata that says from what a record was made."""


@dataclass(slots=True)
class Imported:
    """`kinds` is how many messages there were of each; `messages` are those of the new record."""

    format: str
    kinds: dict[str, int] = field(default_factory=dict)
    garbage_bytes: int = 0
    garbage_stretches: int = 0
    garbage_at: int | None = None
    """Where the first of them begins in the file."""
    late: int = 0
    """Messages of an autopilot's own log whose time does not fit to those around them."""
    messages: int = 0
    first_ns: int | None = None
    last_ns: int = 0

    @property
    def damage(self) -> str:
        """The bytes that are no message."""
        said = f"{self.garbage_bytes} damaged bytes in {self.garbage_stretches} stretches"
        return said if self.garbage_at is None else f"{said}, the first at byte {self.garbage_at}"

    @property
    def read(self) -> int:
        """Messages of the log."""
        return sum(self.kinds.values())

    @property
    def seconds(self) -> float:
        """From the first to the last; 0 of an empty log."""
        return 0.0 if self.first_ns is None else (self.last_ns - self.first_ns) / 1e9

    def span(self, first_ns: int, last_ns: int) -> None:
        """More was read, from `first_ns` to `last_ns`, in order."""
        if self.first_ns is None:
            self.first_ns = first_ns
        self.last_ns = last_ns
