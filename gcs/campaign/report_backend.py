"""A recorder's backend that reads along: what `gcs log report` finds, without a file in between."""

from __future__ import annotations

from gcs.flight_report.findings.finding import Finding
from gcs.flight_report.flight import Flight
from gcs.flight_report.scan import Scan
from gcs.mcap_file.format import Channel as StoredChannel
from gcs.mcap_file.format import Message, Schema
from gcs.mcap_file.reader import Condition
from gcs.mcap_file.writer import Backend, Channel, GuardedFile, Log, best_backend


class ReportBackend:
    """What is recorded is scanned; and written, too, where there is a file."""

    def __init__(self, *, to_file: bool) -> None:
        self._scan = Scan(Flight("campaign", 0))
        self._file: Backend | None = best_backend() if to_file else None
        self._channels = 0

    def went_wrong(self) -> list[Finding]:
        """All that went wrong with the vehicle, in the report's order.  Once, at the end."""
        flight = self._scan.finish(Condition(0))
        vehicle = flight.main_vehicle()
        return [] if vehicle is None else vehicle.went_wrong

    def channel(self, channel: Channel) -> Log:
        self._channels += 1
        number, scan = self._channels, self._scan.message
        self._scan.schema(
            Schema(
                id=number,
                name=channel.schema_name,
                encoding=channel.schema_encoding,
                data=channel.schema,
            )
        )
        self._scan.channel(
            StoredChannel(
                id=number,
                schema_id=number,
                topic=channel.topic,
                message_encoding=channel.message_encoding,
                metadata=dict(channel.metadata),
            )
        )
        write = self._file.channel(channel) if self._file is not None else None

        def log(message: bytes, log_time_ns: int) -> None:
            scan(Message(number, 0, log_time_ns, log_time_ns, message))
            if write is not None:
                write(message, log_time_ns)

        return log

    def open(self, file: GuardedFile) -> None:
        if self._file is not None:
            self._file.open(file)

    def flush(self) -> None:
        if self._file is not None:
            self._file.flush()

    def attach(self, name: str, media_type: str, data: bytes, log_time_ns: int) -> None:
        if self._file is not None:
            self._file.attach(name, media_type, data, log_time_ns)

    def metadata(self, name: str, values: dict[str, str]) -> None:
        if self._file is not None:
            self._file.metadata(name, values)

    def close(self) -> None:
        if self._file is not None:
            self._file.close()
