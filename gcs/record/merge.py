"""`gcs log merge`: several records in one, ordered by log_time.

The parts of one session become what the session would have written without them.  Records of
several sessions keep their topics, or get a prefix each.
"""

from __future__ import annotations

import heapq
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from gcs.mcap_file.copier import Source, Target, new_record
from gcs.mcap_file.format import Attachment, Channel, Message, Metadata, Schema
from gcs.mcap_file.reader import Reading

_PART = re.compile(r"_part[0-9]+$")
_OF_A_VEHICLE = re.compile(r"/vehicle/([0-9]+)/")


class SameVehicleError(Exception):
    """Two sessions have a vehicle of the same number: `paths`."""

    def __init__(self, sysid: int, paths: tuple[Path, Path]) -> None:
        super().__init__(f"{paths[0]} and {paths[1]}: both have a vehicle {sysid}")
        self.paths = paths


@dataclass(slots=True)
class Merged:
    """What the new file holds."""

    messages: int = 0
    seconds: float = 0.0
    attachments: int = 0
    not_closed: list[Path] = field(default_factory=list)
    """Sources whose writer was killed: read as far as they go."""
    damaged: int = 0
    """Records of the sources that could not be read."""


def session_of(path: Path) -> str:
    """The name of the session that a file is a part of, as the recorder names parts."""
    return _PART.sub("", path.stem)


def merge(sources: Sequence[Path], target: Path, *, prefixed: bool = False) -> Merged:
    """Write all messages of `sources` into the new file `target`, each attachment once.

    `prefixed`: each session's topics begin with its name.  Without, two sessions with a vehicle
    of the same number are not mixed.  Raises SameVehicleError, BadRecordError, and OSError
    (FileExistsError where `target` exists).
    """
    inputs = [_Input(path, prefixed=prefixed) for path in sources]
    with new_record(target) as made:
        attached: set[tuple[str, bytes | tuple[tuple[str, str], ...]]] = set()
        streams = [each.messages(number, made, attached) for number, each in enumerate(inputs)]
        owners: dict[int, _Input] = {}
        for _, number, message in heapq.merge(*streams):
            source = inputs[number]
            channel = source.channel_in(made, message, owners)
            if channel is not None:
                made.message(channel, message)
    return Merged(
        made.messages,
        made.seconds,
        made.attachments,
        [each.path for each in inputs if not each.reading.condition.closed],
        sum(each.reading.condition.damaged + each.source.orphans for each in inputs),
    )


class _Input:
    """One of the files."""

    def __init__(self, path: Path, *, prefixed: bool) -> None:
        self.path = path
        self.reading = Reading(path)
        self.source = Source()
        self._session = session_of(path)
        self._prefix = "/" + re.sub(r"[^A-Za-z0-9_]+", "_", self._session) if prefixed else ""
        self._seen: set[int] = set()

    def messages(
        self,
        number: int,
        made: Target,
        attached: set[tuple[str, bytes | tuple[tuple[str, str], ...]]],
    ) -> Iterator[tuple[int, int, Message]]:
        """(log_time, number of the file, message); what else there is goes to `made` at once."""
        for record in self.reading:
            match record:
                case Message():
                    yield record.log_time_ns, number, record
                case Channel():
                    self.source.learn(self._renamed(record))
                case Schema():
                    self.source.learn(record)
                case Attachment() | Metadata():
                    key = record.name, _content(record)
                    if key not in attached:
                        attached.add(key)
                        made.attach(record)

    def _renamed(self, channel: Channel) -> Channel:
        if not self._prefix:
            return channel
        return Channel(
            id=channel.id,
            topic=self._prefix + channel.topic,
            message_encoding=channel.message_encoding,
            metadata=channel.metadata,
            schema_id=channel.schema_id,
        )

    def channel_in(self, made: Target, message: Message, owners: dict[int, _Input]) -> int | None:
        """Its number in the new file.  Raises SameVehicleError."""
        if message.channel_id not in self._seen:
            self._seen.add(message.channel_id)
            channel = self.source.channels.get(message.channel_id)
            found = _OF_A_VEHICLE.match(channel.topic) if channel is not None else None
            if found is not None:
                owner = owners.setdefault(int(found[1]), self)
                if owner._session != self._session:
                    raise SameVehicleError(int(found[1]), (owner.path, self.path))
        return self.source.channel_in(made, message)


def _content(record: Attachment | Metadata) -> bytes | tuple[tuple[str, str], ...]:
    match record:
        case Attachment(data=data):
            return data
        case Metadata(metadata=values):
            return tuple(sorted(values.items()))
