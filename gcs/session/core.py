"""The composition: everything that reaches the link, and everything that leaves it.

`handle(input, now_ns) -> effects`; no socket, no clock, no file.  Bytes become messages, messages
become what the gate hears, what the gate says becomes frames; and all of it becomes the record.
"""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.gate import inputs, requests
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.gate.machine.gate import Gate
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import GENERIC
from gcs.record.items import AttachmentItem, InputItem, LogItem, MetadataItem
from gcs.session import teller
from gcs.session.desk import BadAskError, wish_of
from gcs.session.gatekeeper import Gatekeeper
from gcs.session.intake import Intake
from gcs.session.missions import MISSION_WORDS, MissionDesk
from gcs.session.outbox import Outbox
from gcs.session.ports import (
    Datagram,
    Effect,
    FileRead,
    FileWritten,
    Finish,
    Input,
    LinkEvent,
    OperatorGone,
    OperatorLine,
    OperatorNoise,
    RecorderChanged,
    RecorderGrew,
    SimGone,
    SimLine,
    Wake,
)
from gcs.session.screen import snapshot
from gcs.session.setup import Setup
from gcs.session.telemetry import Telemetry

TICK_NS = 50_000_000
"""20 Hz, on a grid that is fixed at start; a missed tick is reported and never made up for."""
TICKS_A_SECOND = 20
LATE_NS = 20_000_000
"""Of real time; a tick that is later than this is told."""
VERY_LATE_NS = 250_000_000
LATE_SHOWN_NS = 10_000_000_000
LEAVING_NS = 3_000_000_000

NODE = "link"
EXIT_NO_LINK = 3
EXIT_REFUSED_BY_GATE = 6
EXIT_BUG = 70
MAX_FAULTS = 10


class Session:
    """One operator, one vehicle, any number of links; from the first byte to `Finish`."""

    def __init__(self, setup: Setup, now_ns: int) -> None:
        config = setup.config
        self._setup = setup
        self._start_ns = now_ns
        self._next_tick_ns = now_ns + TICK_NS
        self._tick_no = 0
        links = len(setup.endpoints)
        self._out = Outbox(config.sysid, config.compid, links, now_ns, setup.waiting)
        self._keeper = Gatekeeper(setup.policy, self._out, config, now_ns)
        self._missions = MissionDesk(config, self._keeper, self._out)
        self._intake = Intake(setup, self._keeper, self._missions, self._out)
        self._log_path = setup.log_path
        self._recording = bool(setup.log_path)
        self._recorded_bytes = 0
        self._leaving_since_ns: int | None = None
        self._told_no_vehicle = False
        self._late_until_ns = 0
        self._faults = 0
        self._introduced = False
        self._finished = False

    @property
    def deadline_ns(self) -> int:
        """When `Wake` is due; no side effects."""
        parts = (self._keeper.deadline_ns, self._intake.deadline_ns, self._missions.deadline_ns)
        return min([self._next_tick_ns, *(time for time in parts if time is not None)])

    @property
    def gate(self) -> Gate:
        """To look at, not to handle."""
        return self._keeper.gate

    @property
    def telemetry(self) -> Telemetry | None:
        """The vehicle as it reports itself, None before one is heard."""
        return self._keeper.seen

    def handle(self, given: Input, now_ns: int) -> list[Effect]:
        """Everything that follows from `given` at `now_ns`, in order."""
        if not self._introduced:
            self._introduced = True
            self._introduce()
        self._record_input(given, now_ns)
        match given:
            case Datagram(link, data):
                self._intake.datagram(link, data, now_ns)
            case Wake():
                self._wake(now_ns)
            case OperatorLine(command):
                self._operator(command, now_ns)
            case OperatorNoise(text):
                self._out.emit(ipc.Trouble(f"not a command: {text}"))
            case OperatorGone(reason):
                self._leave(reason, now_ns)
            case LinkEvent(_, text, trouble):
                self._out.say(Level.WARNING if trouble else Level.INFO, NODE, text, now_ns)
            case FileRead() | FileWritten():
                self._missions.file(given, now_ns)
            case RecorderChanged():
                self._recorder(given, now_ns)
            case RecorderGrew(size_bytes):
                self._recorded_bytes = size_bytes
            case SimLine(text):
                self._sim_line(text, now_ns)
            case SimGone(exit_code):
                self._sim_gone(exit_code, now_ns)
        self._settle(now_ns)
        return self._out.take()

    def fault(self, given: Input, report: str, now_ns: int) -> list[Effect]:
        """A bug of ours, met while `given` was handled: the vehicle must not pay for it.

        Bytes or words that we cannot take are dropped, said and recorded.  Where it happens on
        the clock, or again and again, the vehicle is told to hold and the link goes.
        """
        self._out.take()
        self._faults += 1
        self._out.record(InputItem("Fault", msgspec.json.encode(report)))
        self._out.say(Level.FATAL, NODE, f"internal error: {report.splitlines()[-1]}", now_ns)
        if isinstance(given, Wake) or self._faults > MAX_FAULTS:
            self._keeper.hold_blind(now_ns)
            self._finished = True
            self._out.put(Finish(EXIT_BUG, "an internal error: the vehicle was told to hold"))
        return self._out.take()

    # ------------------------------------------------------------------------------ time

    def _wake(self, now_ns: int) -> None:
        self._keeper.wake(now_ns)
        self._intake.wake(now_ns)
        self._missions.wake(now_ns)
        if now_ns >= self._next_tick_ns:
            lateness_ns = now_ns - self._next_tick_ns
            self._next_tick_ns += TICK_NS * (lateness_ns // TICK_NS + 1)
            self._tick(lateness_ns, now_ns)

    def _tick(self, lateness_ns: int, now_ns: int) -> None:
        self._keeper.give(inputs.Tick(lateness_ns), now_ns)
        self._judge_lateness(lateness_ns, now_ns)
        if self._tick_no % TICKS_A_SECOND == 0:
            self._second(now_ns)
        if self._tick_no % 2 == 0:
            self._out.emit(self._snapshot(now_ns))
        self._tick_no += 1

    def _judge_lateness(self, lateness_ns: int, now_ns: int) -> None:
        """A late tick is told; one so late that the stream had a gap is a condition for a while."""
        speedup = self._setup.config.speedup
        text = f"a tick came {lateness_ns / 1e6 / speedup:.0f} ms late"
        if lateness_ns > LATE_NS * speedup:
            self._out.say(Level.DEBUG, NODE, text, now_ns)
        if lateness_ns > VERY_LATE_NS * speedup:
            self._late_until_ns = now_ns + LATE_SHOWN_NS
        late = now_ns < self._late_until_ns
        self._keeper.condition(Condition.TICK_LATE, late, text, now_ns)

    def _second(self, now_ns: int) -> None:
        """Once a second: heartbeat, what is missing, and the slow half of the record."""
        self._out.heartbeat()
        self._keeper.remind()
        if self._keeper.seen is None:
            self._nobody_yet(now_ns)
        else:
            self._intake.second(self._keeper.seen, now_ns)

    def _nobody_yet(self, now_ns: int) -> None:
        waited_s = (now_ns - self._start_ns) / 1e9
        if self._told_no_vehicle or waited_s < self._setup.config.connect_timeout_s:
            return
        self._told_no_vehicle = True
        where = ", ".join(self._setup.endpoints)
        hint = "is the vehicle running, and does it send to this address? (try: gcs fly --sim)"
        text = f"no vehicle heard for {waited_s:.0f} s ({where})"
        self._out.emit(ipc.Trouble(text, hint, EXIT_NO_LINK))
        self._out.say(Level.WARNING, NODE, text, now_ns)

    # -------------------------------------------------------------------------- operator

    def _operator(self, command: ipc.Command, now_ns: int) -> None:
        match command:
            case ipc.Ask():
                self._ask(command, now_ns)
            case ipc.Pending(goal_enu, _):
                where = teller.triple(goal_enu)
                self._out.say(Level.INFO, "keyboard_manager", f"Keyboard: {where}", now_ns)
            case ipc.Leave(reason):
                self._leave(reason, now_ns)

    def _ask(self, ask: ipc.Ask, now_ns: int) -> None:
        if ask.word in MISSION_WORDS:
            self._missions.ask(ask, now_ns)
            return
        try:
            wish = wish_of(ask, self._keeper.seen.autopilot if self._keeper.seen else GENERIC)
        except BadAskError as error:
            refused = ipc.VerdictEvent(ask.id, ask.word, "refused", "BAD_REQUEST", str(error))
            self._out.emit(refused)
            return
        if isinstance(wish, requests.SetMode) and wish.meaning is FlightMode.MISSION:
            # The mission mode by its name is a mission start, and is verified like one.
            self._missions.ask(ask, now_ns)
            return
        request_id = self._keeper.requests.open(ask.id, ask.word)
        self._keeper.request(request_id, wish, now_ns)

    # --------------------------------------------------------------------------- leaving

    def _leave(self, reason: str, now_ns: int) -> None:
        """Hold where we fly, wait until that is seen (at most 3 s), then finish."""
        if self._leaving_since_ns is None:
            self._leaving_since_ns = now_ns
            self._out.say(Level.INFO, NODE, f"leaving: {reason}", now_ns)
            self._keeper.give(inputs.OperatorLost(reason), now_ns)

    def _settle(self, now_ns: int) -> None:
        if self._finished:
            return
        refusal = self._keeper.bad_start
        if refusal is not None:
            policy = self._setup.config.policy_path or self._setup.policy.name
            text = f"{policy}: fence: the vehicle stands outside: {refusal.sentence}"
            hint = "fly from inside the fence, or give a policy for this place with --policy"
            self._out.emit(ipc.Trouble(text, hint, EXIT_REFUSED_BY_GATE))
            self._finish(EXIT_REFUSED_BY_GATE, text, now_ns)
        elif self._leaving_since_ns is not None:
            overdue = now_ns - self._leaving_since_ns >= LEAVING_NS
            if self._keeper.gate.settled or overdue:
                self._finish(0, self._last_words(), now_ns)

    def _finish(self, exit_code: int, sentence: str, now_ns: int) -> None:
        self._finished = True
        self._missions.leave(now_ns)
        self._out.say(Level.INFO, NODE, sentence, now_ns)
        self._keeper.remind()
        self._out.put(Finish(exit_code, sentence))

    def _last_words(self) -> str:
        seen = self._keeper.seen
        if seen is None:
            return "no vehicle was heard"
        if not self._keeper.gate.settled:
            return f"the vehicle was not seen to hold within {LEAVING_NS / 1e9:.0f} s"
        if self._keeper.gate.memory.on_ground:
            return "the vehicle is on the ground" + (", still ARMED" if seen.armed else "")
        height = "" if seen.pos_ned is None else f", {-seen.pos_ned[2]:.1f} m up"
        return f"the vehicle is STILL FLYING in {seen.mode_name}{height}"

    # ---------------------------------------------------------------------------- record

    def _introduce(self) -> None:
        """First of all: what this session is, in the record and on the screen."""
        setup = self._setup
        config = setup.config
        values = (
            ("version", setup.version),
            ("endpoints", " ".join(setup.endpoints)),
            ("policy", setup.policy.name),
            ("station", f"{config.sysid}/{config.compid}"),
            ("speedup", f"{config.speedup:g}"),
            ("seed", str(config.sim.seed) if config.sim else ""),
        )
        self._out.record(MetadataItem("mavgate", values))
        policy = setup.policy_text.encode()
        self._out.record(AttachmentItem("policy.toml", "application/toml", policy))
        self._out.record(InputItem("Setup", msgspec.json.encode(config)))
        self._out.emit(
            ipc.Hello(setup.version, setup.log_path, list(setup.endpoints), setup.policy.name)
        )

    def _record_input(self, given: Input, now_ns: int) -> None:
        """All but the frames, which are recorded as such; with them it is the audit's input."""
        match given:
            case Datagram() | RecorderGrew():
                pass
            case FileRead(token, path, data, error):
                size = -1 if data is None else len(data)
                told = {"token": token, "path": path, "size": size, "error": error}
                self._out.record(InputItem("FileRead", msgspec.json.encode(told)))
            case _:
                self._out.record(InputItem(type(given).__name__, msgspec.json.encode(given)))

    def _recorder(self, news: RecorderChanged, now_ns: int) -> None:
        self._recording, self._log_path = news.recording, news.path
        level = Level.INFO if news.recording else Level.ERROR
        self._out.say(level, "recorder", news.text, now_ns)
        failed = Condition.RECORDER_FAILED
        self._keeper.condition(failed, not news.recording, news.text, now_ns)

    def _sim_line(self, text: str, now_ns: int) -> None:
        """`LEVEL node: text`, as vehicle-sim prints it; anything else is an INFO line."""
        word, _, rest = text.partition(" ")
        node, colon, line = rest.partition(": ")
        if word in Level.__members__ and colon and node.startswith("vehicle"):
            # The operator has it from the vehicle itself; the record keeps both.
            self._out.record(LogItem(Level[word], f"sim.{node}", line))
        elif word in Level.__members__ and colon:
            self._out.say(Level[word], f"sim.{node}", line, now_ns)
        else:
            self._out.say(Level.INFO, "sim", text, now_ns)

    def _sim_gone(self, exit_code: int, now_ns: int) -> None:
        """Before it was heard, there is nothing to wait for; later, its silence tells."""
        text = f"the vehicle's process ended by itself with exit code {exit_code}"
        self._out.say(Level.ERROR, NODE, text, now_ns)
        if self._keeper.seen is None:
            hint = "the lines from `sim` in the log tell why"
            self._out.emit(ipc.Trouble(text, hint, EXIT_NO_LINK))
            self._finish(EXIT_NO_LINK, text, now_ns)

    def _snapshot(self, now_ns: int) -> ipc.Snapshot:
        return snapshot(
            self._keeper.gate,
            self._keeper.seen,
            now_ns,
            losses=self._intake.losses,
            log_path=self._log_path,
            recording=self._recording,
            recorded_bytes=self._recorded_bytes,
        )
