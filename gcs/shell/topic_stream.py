"""What goes into the record, message by message, for operators' programs that asked to watch it.

Nobody waits for a watcher: its connection has a bounded queue (`operator_sockets.py`), raw frames
are left out while others wait in it, and one that takes nothing loses its connection.
"""

from __future__ import annotations

from collections.abc import Callable

from gcs import ipc
from gcs.mcap_file.writer import Channel
from gcs.shell.recording import Recording

Tell = Callable[[bytes, int, bool], None]
"""(line, client, droppable): queue a line for one operator's program."""

NO_RECORD = "this station does not record, so that there are no topics to watch"


class TopicStream:
    """Who watches, and the numbers that topics go by."""

    def __init__(self, recording: Recording, tell: Tell) -> None:
        self._recording = recording
        self._tell = tell
        self._watchers: list[int] = []
        self._numbers: dict[str, int] = {}

    def add(self, client: int) -> None:
        """It watches from now on; what is there already is told at once."""
        if client in self._watchers:
            return
        recorder = self._recording.recorder
        if recorder is None:
            self._tell(ipc.encode(ipc.Trouble(NO_RECORD)), client, False)
            return
        for channel in recorder.channels:
            self._numbers.setdefault(channel.topic, len(self._numbers) + 1)
            self._tell(self._topic(channel), client, False)
        for out in recorder.latched:
            number = self._numbers[out.channel.topic]
            message = ipc.TopicMessage(number, recorder.last_ns, out.message, out.latch)
            self._tell(ipc.encode(message), client, False)
        self._watchers.append(client)
        recorder.watch(self._recorded)

    def remove(self, client: int) -> None:
        """Its connection has ended."""
        if client not in self._watchers:
            return
        self._watchers.remove(client)
        if not self._watchers and self._recording.recorder is not None:
            self._recording.recorder.watch(None)

    def _recorded(self, channel: Channel, data: bytes, log_time_ns: int, latch: str) -> None:
        number = self._numbers.get(channel.topic)
        if number is None:
            number = self._numbers[channel.topic] = len(self._numbers) + 1
            self._tell_all(self._topic(channel), droppable=False)
        line = ipc.encode(ipc.TopicMessage(number, log_time_ns, data, latch))
        self._tell_all(line, droppable=channel.message_encoding == "ros1")

    def _topic(self, channel: Channel) -> bytes:
        return ipc.encode(
            ipc.Topic(
                self._numbers[channel.topic],
                channel.topic,
                channel.message_encoding,
                channel.schema_name,
                channel.schema_encoding,
                channel.schema,
                dict(channel.metadata),
            )
        )

    def _tell_all(self, line: bytes, *, droppable: bool) -> None:
        for client in self._watchers:
            self._tell(line, client, droppable)
