"""Which frames of a record count in a rate: each once, though it may have crossed several links."""

from __future__ import annotations

from gcs.report import Direction
from gcs.topics.topic import Heard


class Crossings:
    """Of a component that is heard, the frames that were received: what a bridge passes on of it,
    answers in its name, or refuses of another one that calls itself so, is not its own traffic.
    Of a component that is only sent, such as the station itself, all of them.
    """

    def __init__(self, *, each_topic: bool = False) -> None:
        """`each_topic`: what is sent, or refused, and received of nobody counts for its topic."""
        self._each_topic = each_topic
        self._received: set[str] = set()

    def counts(self, heard: Heard) -> bool:
        """Messages are given in the order of the record."""
        direction = heard.direction
        if direction is None:
            return True
        name = heard.topic.name
        source = name if self._each_topic else name.rpartition("/")[0]
        if direction == Direction.RECEIVED:
            self._received.add(source)
            return True
        return source not in self._received
