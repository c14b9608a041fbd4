"""Takes the requests about what one vehicle keeps, and does one at a time.

What can be asked is in the other files here.  A second request is refused BUSY.
"""

from __future__ import annotations

from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address, Heard, Wake
from gcs.protocol.parameters import Parameter
from gcs.protocol.transfers.parameter_list import parameter_of
from gcs.session.speedup_waits import Times
from gcs.session.work import AskReader, Work
from gcs.vehicle.readers.files import FileJob, ListFolder, ListLogs, ReadLog, SumUpFile
from gcs.vehicle.readers.job import Asked, Job, refused
from gcs.vehicle.readers.parameters import GetParameter, ListParameters, SetParameter
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import ParamValue

MOST_KNOWN = 4096
"""Parameters that are remembered at most; an autopilot has 900 to 1,400."""


class Readers:
    """Of one vehicle."""

    def __init__(self, own: Address, times: Times) -> None:
        self._own = own
        self._times = times
        self._job: Job | None = None
        self._left = False
        self._known: dict[str, Parameter] = {}
        """By name, as they were told last, to whomever."""

    @property
    def deadline_ns(self) -> int | None:
        return None if self._job is None else self._job.deadline_ns

    def ask(
        self, asked: AskReader, telemetry: Telemetry | None, policy: Policy, now_ns: int
    ) -> list[Work]:
        """One request; its verdict may come later, once the vehicle has told what is needed."""
        refusal = None
        if self._left:
            refusal = Refusal(Code.OPERATOR_LOST, "the station is leaving")
        elif telemetry is None:
            refusal = Refusal(Code.NO_VEHICLE, "no vehicle is heard")
        elif self._job is not None:
            under_way = self._job.asked.ask.word.replace("_", " ")
            refusal = Refusal(Code.BUSY, f"{under_way} is still under way")
        if refusal is not None or telemetry is None:
            assert refusal is not None
            return refused(asked.request_id, asked.ask.word, refusal)
        job = self._job = self._job_for(
            Asked(asked.request_id, asked.ask, self._own, self._times, telemetry, policy)
        )
        return self._follow(job.start(now_ns))

    def _job_for(self, asked: Asked) -> Job:
        match asked.ask.word:
            case "param_list":
                return ListParameters(asked)
            case "param_get":
                return GetParameter(asked, self._known)
            case "param_set":
                return SetParameter(asked, self._known)
            case "file_read":
                return FileJob(asked)
            case "file_list":
                return ListFolder(asked)
            case "file_crc":
                return SumUpFile(asked)
            case "log_list":
                return ListLogs(asked)
            case "log_read":
                return ReadLog(asked)
        raise AssertionError(f"{asked.ask.word} is for another part")

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A message about parameters, files or logs."""
        if isinstance(heard.message, ParamValue) and heard.compid == telemetry.compid:
            told = parameter_of(heard.message, telemetry.autopilot.param_encoding)
            if told is not None and (told.name in self._known or len(self._known) < MOST_KNOWN):
                self._known[told.name] = told
        return [] if self._job is None else self._follow(self._job.handle(heard, now_ns))

    def wake(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        return [] if self._job is None else self._follow(self._job.handle(Wake(), now_ns))

    def stop(self, request_id: int) -> list[Work]:
        """Somebody stops the job of that request, if it is under way."""
        if self._job is None or self._job.asked.request_id != request_id:
            return []
        return self._end(Code.OPERATOR, "stopped by an operator")

    def forget(self) -> list[Work]:
        """The vehicle restarted or was away."""
        self._known.clear()
        return self._end(Code.LINK_LOST, "the vehicle restarted or was away")

    def leave(self) -> list[Work]:
        """The session ends."""
        self._left = True
        return self._end(Code.OPERATOR_LOST, "the station left before it was done")

    def _end(self, code: Code, sentence: str) -> list[Work]:
        job = self._job
        if job is None:
            return []
        refusal = Refusal(code, sentence)
        ends = job.abort(code, sentence) if job.accepted else job.refuse(refusal)
        return self._follow([*job.stopped(), *ends])

    def _follow(self, work: list[Work]) -> list[Work]:
        if self._job is not None and self._job.over:
            self._job = None
        return work
