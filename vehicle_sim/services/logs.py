"""The log protocol: LOG_REQUEST_LIST, LOG_REQUEST_DATA, LOG_ERASE, LOG_REQUEST_END.

    IDLE --LOG_REQUEST_DATA--> SENDING --the range is sent--> IDLE
                               |  ^   '--LOG_REQUEST_END----> IDLE
                               '--'   another LOG_REQUEST_DATA takes its place

One transfer a channel, paced by wall time: ArduPilot's at 147 kB/s as recorded (J2_logs); PX4's,
recorded at 0.56 MB/s, at 360 kB/s, which a client's buffer of 200 kB takes.  The first frames
answer the request at once, so that a client that asks for many small holes in a row gets them all.
A request always brings at least one LOG_DATA; past the end its count is 0, which is how clients
learn the end.  The numbers of a list stand for the same logs until the next list or
LOG_REQUEST_END, as on PX4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias, assert_never

from vehicle_sim.autopilot.interface import Vehicle
from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.flight_log.log_directory import LogFile
from vehicle_sim.flight_log.recorder import Recorder
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.streams import NEVER
from vehicle_sim.storage.store import StoreError
from vehicle_sim.wire import messages as m

DATA_BYTES: Final = 90
BURST: Final = 32
AT_ONCE: Final = 8
SEVERITY_ERROR: Final = 3
LogRequest: TypeAlias = m.LogRequestList | m.LogRequestData | m.LogErase | m.LogRequestEnd


@dataclass(slots=True)
class _Transfer:
    client: Client
    number: int
    path: str
    offset: int
    end: int
    due_ns: int


class LogServer:
    """One vehicle's logs."""

    def __init__(self, vehicle: Vehicle, profile: Profile, recorder: Recorder) -> None:
        self._vehicle = vehicle
        self._profile = profile
        self._recorder = recorder
        self._listed: dict[int, tuple[LogFile, ...]] = {}  # by channel
        self._transfers: dict[int, _Transfer] = {}
        self._refused = False

    @property
    def deadline_ns(self) -> int:
        return min((transfer.due_ns for transfer in self._transfers.values()), default=NEVER)

    def handle(self, client: Client, asked: LogRequest, now_ns: int) -> list[Effect]:
        if self._vehicle.armed and not self._profile.logs_while_armed:
            return self._refuse(client)
        self._refused = False
        try:
            return self._answer(client, asked, now_ns)
        finally:
            self._vehicle.log_download(bool(self._transfers))

    def _answer(self, client: Client, asked: LogRequest, now_ns: int) -> list[Effect]:
        try:
            match asked:
                case m.LogRequestList():
                    return self._list(client, asked)
                case m.LogRequestData():
                    return self._data(client, asked, now_ns)
                case m.LogErase():
                    return self._erase()
                case m.LogRequestEnd():
                    self.forget(client.channel)
                    return []
                case _:
                    assert_never(asked)
        except StoreError as error:
            return [Note("warning", f"flight logs: {error}")]

    def tick(self, now_ns: int) -> list[Effect]:
        effects: list[Effect] = []
        for transfer in list(self._transfers.values()):
            if now_ns >= transfer.due_ns:
                owed = (now_ns - transfer.due_ns) // self._profile.log_frame_ns + 1
                effects += self._send(transfer, min(BURST, owed), now_ns)
        self._vehicle.log_download(bool(self._transfers))
        return effects

    def forget(self, channel: int) -> None:
        self._transfers.pop(channel, None)
        self._listed.pop(channel, None)
        self._vehicle.log_download(bool(self._transfers))

    def _refuse(self, client: Client) -> list[Effect]:
        """ArduPilot's words, once until a request finds it disarmed."""
        self._transfers.clear()
        if self._refused:
            return []
        self._refused = True
        return [Send(client.channel, m.Statustext(SEVERITY_ERROR, b"Disarm for log download"))]

    def _list(self, client: Client, asked: m.LogRequestList) -> list[Effect]:
        logs = self._recorder.logs()
        self._listed[client.channel] = logs
        self._transfers.pop(client.channel, None)
        if not logs:
            return [Send(client.channel, m.LogEntry(0, 0, 0, 0, 0))]
        lowest = self._profile.first_log
        highest = lowest + len(logs) - 1
        first = max(lowest, min(asked.start, highest))
        last = max(first, min(asked.end, highest))
        return [
            Send(
                client.channel,
                m.LogEntry(log.time_utc_s, log.size, number, len(logs), last),
            )
            for number, log in enumerate(logs, start=lowest)
            if first <= number <= last
        ]

    def _data(self, client: Client, asked: m.LogRequestData, now_ns: int) -> list[Effect]:
        """A number that no log has is not answered, by neither autopilot."""
        logs = self._listed.get(client.channel)
        if logs is None:
            logs = self._listed[client.channel] = self._recorder.logs()
        self._transfers.pop(client.channel, None)
        index = asked.id - self._profile.first_log
        if not 0 <= index < len(logs):
            return [Note("warning", f"there is no log {asked.id}")]
        log = logs[index]
        end = min(log.size, asked.ofs + asked.count_)
        transfer = _Transfer(client, asked.id, log.path, asked.ofs, end, now_ns)
        self._transfers[client.channel] = transfer
        return self._send(transfer, AT_ONCE, now_ns)

    def _send(self, transfer: _Transfer, frames: int, now_ns: int) -> list[Effect]:
        channel = transfer.client.channel
        wanted = max(0, min(frames * DATA_BYTES, transfer.end - transfer.offset))
        try:
            data = self._recorder.read(transfer.path, transfer.offset, wanted)
        except StoreError:
            data = b""  # somebody removed it meanwhile: it ends here
        effects: list[Effect] = [
            Send(
                channel,
                m.LogData(transfer.offset + at, transfer.number, len(chunk), chunk),
            )
            for at in range(0, max(1, len(data)), DATA_BYTES)
            for chunk in (data[at : at + DATA_BYTES],)
        ]
        transfer.offset += len(data)
        transfer.due_ns = now_ns + self._profile.log_frame_ns
        if transfer.offset >= transfer.end or len(data) < wanted:
            del self._transfers[channel]
        return effects

    def _erase(self) -> list[Effect]:
        self._transfers.clear()
        self._listed.clear()
        self._recorder.erase()
        return [Note("info", "flight logs erased")]
