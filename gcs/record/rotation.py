"""When a record goes on in a new file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rotation:
    """When a new file begins; 0 = never for this reason."""

    size_bytes: int = 0
    age_ns: int = 0

    def due(self, size_bytes: int, age_ns: int) -> bool:
        """Whether a file that is so large and so old is to be closed."""
        too_large = 0 < self.size_bytes <= size_bytes
        return too_large or 0 < self.age_ns <= age_ns


NEVER = Rotation()
