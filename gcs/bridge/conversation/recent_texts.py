"""What a client was told in the last seconds, so that nobody is told the same over and over."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import Final

SAME_TEXT_NS: Final = 5_000_000_000
"""The same text about the same request is sent again to a client only after so long."""
MOST_TEXTS: Final = 50
"""In `SAME_TEXT_NS`; a client that is refused more often than that reads the acknowledgements."""


@dataclass(slots=True)
class RecentTexts:
    """What was said in the last seconds, and is not said again so soon."""

    _until_ns: dict[tuple[Hashable, str], int] = field(default_factory=dict)

    def is_news(self, text: str, now_ns: int, request: Hashable = b"") -> bool:
        """Not said lately of that request, and not the one too many.

        `request` is equal for what repeats one; empty: all that is said is of one, as of a stream.
        """
        said = (request, text)
        if self._until_ns.get(said, now_ns) > now_ns:
            return False
        self._until_ns = {each: at for each, at in self._until_ns.items() if at > now_ns}
        if len(self._until_ns) >= MOST_TEXTS:
            return False
        self._until_ns[said] = now_ns + SAME_TEXT_NS
        return True
