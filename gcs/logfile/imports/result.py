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
    messages: int = 0
    first_ns: int | None = None
    last_ns: int = 0

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
