"""The messages of a record, topic by topic as they come: of a whole file, or of one that grows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gcs.mcap_file.format import Channel, Message, Record, Schema
from gcs.topics.topic import Heard, Topic, recorded_topic


class RecordedTopics:
    """Takes records in file order and gives the messages; `topics` are those seen so far."""

    def __init__(self) -> None:
        self.topics: dict[int, Topic] = {}
        self._schemas: dict[int, tuple[str, bytes]] = {0: ("", b"")}

    def heard(self, records: Iterable[Record]) -> Iterator[Heard]:
        for record in records:
            match record:
                case Message(channel_id=number, log_time_ns=time_ns, data=data):
                    topic = self.topics.get(number)
                    if topic is not None:
                        yield Heard(topic, time_ns, data)
                case Schema(id=number, name=name, data=text):
                    self._schemas[number] = (name, text)
                case Channel(id=number) if number not in self.topics:
                    schema, text = self._schemas.get(record.schema_id, ("", b""))
                    self.topics[number] = recorded_topic(
                        record.topic, schema, record.message_encoding, record.metadata, text
                    )
                case _:
                    pass
