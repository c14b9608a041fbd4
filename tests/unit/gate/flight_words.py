"""The words of a row: what happens, and what is looked at.  `rows.py` says how a row is read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from msgspec.structs import replace

from gcs.frames import Vec3, enu_from_ned, ned_from_enu
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import (
    CancelCommand,
    CommandKind,
    Effect,
    Level,
    Outcome,
    Ruling,
    Say,
    SendCommand,
    SendSetpoint,
    StreamVerdict,
    Verdict,
)
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HeartbeatSeen,
    HomeSeen,
    MessageSeen,
    MissionLoaded,
    MissionSeen,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    ReturnHeightSeen,
    StreamSeen,
    Tick,
    VerifierChanged,
)
from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    EndStream,
    GoTo,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import (
    STILL,
    UP,
    default_policy,
    elsewhere,
    lead_to,
    remember,
    streams,
    take_off,
    under_way,
)

Step = Callable[..., object]

REQUESTS: dict[str, Request] = {
    "hold": Hold(),
    "abort": Abort(),
    "land": Land(),
    "return": ReturnHome(),
    "arm": Arm(),
    "disarm": Disarm(),
    "force": Disarm(force=True),
    "control": TakeControl(),
    "resume": Resume(),
    "photo": TakePhoto(),
    "mission": StartMission(),
    "stream": BeginStream(),
    "end-stream": EndStream(),
    "go": GoTo((0.0, 4.0, -UP)),
    "up": TakeOff(2.0),
    "acro": SetMode("ACRO", FlightMode.OTHER),
    "fence-on": SwitchFence(on=True),
    "fence-off": SwitchFence(on=False),
}

MOTION = ("go", "control", "resume", "arm", "up", "return", "photo", "mission", "acro", "fence-on")
"""What needs an operator."""

ANSWERS = {"accepts": 0, "rejects": 1, "refuses": 2, "fails": 4, "ignores": None}
"""MAV_RESULT; `ignores`: no answer came."""

FACTS: dict[str, Callable[[str], object]] = {
    "armed": lambda word: word == "yes",
    "lifted": lambda word: word == "yes",
    "operator_lost": lambda word: word == "yes",
    "mode": lambda word: FlightMode[word],
    "asked_mode": lambda word: None if word == "none" else FlightMode[word],
    "landed": lambda word: LandedState[word],
    "state": lambda word: State[word],
    "control": lambda word: Control[word],
    "guided_until_ns": int,
    "hold_again_ns": lambda _: None,
    "verifier": lambda _: None,
    "return_up_m": lambda _: None,
    "task": lambda _: None,
    "conditions": lambda word: ((Condition[word], ""),),
}
"""Fields of the gate's memory that a row may set, and what their words mean."""


def place(east: str, north: str, up: str) -> Vec3:
    return ned_from_enu((float(east), float(north), float(up)))


def _said(place_ned: Vec3 | None) -> str:
    return "none" if place_ned is None else "{:g} {:g} {:g}".format(*enu_from_ned(place_ned))


@dataclass
class Flight:
    """A script that is flown by words; `names` are those of the requests that it made itself."""

    script: Script
    names: dict[int, str]
    steps: Mapping[str, Step]
    asked: str = ""
    past: list[tuple[int, Effect]] = field(default_factory=list)

    @classmethod
    def begun(cls, situation: str, steps: Mapping[str, Step]) -> Flight:
        settings, _, told = situation.rpartition(":")
        script = _script([setting.strip() for setting in settings.split(",") if setting.strip()])
        if "EXTERNAL" in told:  # where a forced disarm is under way
            script = Script(replace(script.policy, allow_force_disarm=True), script.autopilot)
        flight = cls(script, {}, steps)
        flight.do(told)
        return flight

    def do(self, steps: str) -> None:
        for step in steps.split(";"):
            self.step(step.strip())

    def told(self, event: str, expected: str) -> str:
        """What the steps of `event` led to, in the words of a reaction.

        The letters of `expected` only choose what is looked at besides, and `=`."""
        gate = self.script.gate
        before = gate.memory
        self.past += self.script.effects
        self.script.effects = []
        self.do(event)
        state = f"{self.script.gate.state.name} {self.script.gate.control.name}"
        if (before.state, before.control) == (self.script.gate.state, self.script.gate.control):
            state = "=" if expected[0] in "=?" else state
        sent = [kind.name for kind in self.script.commands()]
        parts = [state, *([f"sends {' '.join(sent)}"] if sent else []), *self.decided()]
        _, *looks = expected.split("; ")
        return "; ".join([", ".join(parts), *(self.look(word, before) for word in looks)])

    def decided(self) -> Iterator[str]:
        """What was decided of each request, the oldest first."""
        found: dict[int, list[str]] = {}
        for _, effect in self.script.effects:
            if isinstance(effect, Verdict):
                code = effect.refusal and effect.refusal.code
                words = "replaced" if effect.ruling is Ruling.SUPERSEDED else str(effect.ruling)
            elif isinstance(effect, Outcome):
                code, words = effect.code, str(effect.kind)
            else:
                continue
            if code and code != "SUPERSEDED":
                words += f" {code}"
            found.setdefault(effect.request_id, []).append(words)
        return (
            f"{self.names.get(one, 'it')} {' '.join(words)}" for one, words in sorted(found.items())
        )

    def look(self, words: str, before: object) -> str:
        """`words` where it is so, else what is."""
        script, gate = self.script, self.script.gate
        match words.split(maxsplit=1):
            case ["streams" | "silent"]:
                return "streams" if streams(script) else "silent"
            case ["settled" | "unsettled"]:
                return "settled" if gate.settled else "unsettled"
            case ["holds", _]:
                return f"holds {_said(gate.hold_goal_ned)}"
            case ["goal", _]:
                return f"goal {_said(gate.active_goal_ned)}"
            case ["landed", _]:
                return f"landed {gate.memory.landed.name}"
            case ["top", _]:
                return f"top {_said(gate.memory.top_ned)}"
            case ["severity", _]:
                return f"severity {gate.severity.name}"
            case ["setpoints", _]:
                found = {_said(ned_from_enu(enu)) for _, enu in script.setpoints()}
                return f"setpoints {' and '.join(sorted(found)) or 'none'}"
            case ["velocities", _]:
                permits = [sent.permit for sent in script.all(SendSetpoint)]
                flown = sorted({_said(permit.v_ned) for permit in permits if permit.v_ned})
                return f"velocities {' and '.join(flown) or 'none'}"
            case ["stream", _]:  # what its client was told of the samples
                told = [v.refusal.code if v.refusal else "flown" for v in script.all(StreamVerdict)]
                return f"stream {' '.join(told) or 'untold'}"
            case ["brakes"]:
                sent = [s.permit.reason for s in script.all(SendSetpoint)]
                return "brakes" if [s.startswith("brake") for s in sent] == [True] else str(sent)
            case ["cancels", _]:
                kinds = [cancelled.kind.name for cancelled in script.all(CancelCommand)]
                return f"cancels {' '.join(kinds) or 'none'}"
            case ["awaits", _]:
                kinds = [kind.name for _, kind in gate.memory.outstanding]
                return f"awaits {' '.join(kinds) or 'none'}"
            case ["due", _]:  # seconds until the next thing is; asking changes nothing
                known, due_ns = gate.memory, gate.deadline_ns
                assert gate.memory == known
                return f"due {'none' if due_ns is None else (due_ns - script.now_ns) / SECOND}"
            case ["asks", _]:
                return f"asks {gate.memory.asked_mode or 'none'}"
            case ["states", _]:
                return f"states {' '.join(state.name for state in script.states()) or 'none'}"
            case ["same"]:
                return "same" if gate.memory == before else "changed"
            case ["tells", *_]:  # every line, with its level
                lines = [f"{said.level.name} {said.text}" for said in script.all(Say)]
                return f"tells {' and '.join(lines) or 'nothing'}"
            case ["warns", *_]:
                lines = [said.text for said in script.all(Say) if said.level >= Level.WARNING]
                return f"warns {' and '.join(lines) or 'not'}"
            case ["unsaid", text]:
                told = [one for one in self.sentences() if text.strip('"') in one]
                return f"says {told}" if told else words
            case ["says", text]:
                told = list(self.sentences())
                return words if any(text.strip('"') in one for one in told) else f"says {told}"
        raise ValueError(words)

    def sentences(self) -> Iterator[str]:
        for _, effect in self.script.effects:
            if isinstance(effect, Say):
                yield effect.text
            elif isinstance(effect, Outcome):
                yield effect.sentence
            elif isinstance(effect, Verdict) and effect.refusal is not None:
                yield effect.refusal.sentence

    def ask(self, name: str, request: Request, source: str = "keyboard") -> None:
        self.asked = self.names[self.script.asked + 1] = name
        self.script.ask(request, source)

    def answer(self, kind: CommandKind, result: int | None, text: str) -> None:
        """The vehicle answers the last command of that kind."""
        effects = [effect for _, effect in (*self.past, *self.script.effects)]
        sent = [e for e in effects if isinstance(e, SendCommand) and e.kind is kind][-1]
        self.script.feed(CommandEnded(sent.request_id, kind, result, text))

    def step(self, phrase: str) -> None:
        script = self.script
        match phrase.split():
            # how it begins
            case ["in", state]:
                lead_to(State[state], script)
            case ["stale", state]:
                under_way(State[state], script)
                script.reports_position = False
                script.wait(1.1)
                assert script.gate.state is State.STALE
            case [state] if state in State.__members__:
                under_way(State[state], script)
                assert script.gate.state is State[state]
            case ["climb", *up]:
                take_off(script, *map(float, up))
            case ["connected", *mode]:
                script.mode = FlightMode[mode[0]] if mode else script.mode
                script.connect()
            case ["armed"]:
                lead_to(State.GROUNDED, script)
            case ["flown", *mode]:
                script.mode = FlightMode[mode[0]] if mode else script.mode
                script.fly(UP)
            case ["ours", *up]:
                script.take_control(*map(float, up or [str(UP)]))
            case ["unheard"]:
                pass
            # what is asked for
            case [name] if name in REQUESTS:
                self.ask(name, REQUESTS[name])
            case ["another's", name] if name in REQUESTS:
                self.ask(name, REQUESTS[name], "somebody else")
            case ["goto", east, north, up]:
                self.ask("goto", GoTo(place(east, north, up)))
            case ["another's", "goto", east, north, up]:
                self.ask("goto", GoTo(place(east, north, up)), "somebody else")
            case ["take-off", up]:
                self.ask("take-off", TakeOff(float(up)))
            case ["mode", name, mode, *instead]:
                self.ask("mode", SetMode(name, FlightMode[mode], *instead))
            case ["quits"]:
                script.feed(OperatorLost("quit"))
            # what the vehicle reports
            case ["shows", *words]:
                modes = [FlightMode[word] for word in words if word.isupper()]
                armed = {"armed": True, "disarmed": False}.get(words[-1]) if words else None
                script.heartbeat(*modes, armed=armed)
            case ["fails-safe", mode]:
                script.mode = FlightMode[mode]
                script.feed(HeartbeatSeen(script.armed, script.mode, mode, failsafe=True))
            case ["is", landed]:
                script.land_state(LandedState[landed])
            case ["at", east, north, up]:
                script.at(float(east), float(north), float(up))
            case ["at", east, north, up, "by", *v_enu]:
                v_east, v_north, v_up = map(float, v_enu)
                script.at(float(east), float(north), float(up), (v_east, v_north, v_up))
            case ["stands-at", *enu]:
                script.pos_ned = place(*enu)
            case ["flies", *enu]:
                script.v_ned = place(*enu)
            case ["position"]:
                script.position()
            case ["jumps", *enu]:
                script.feed(PositionSeen(place(*enu), STILL, script.now_ns // 1_000_000, True))
            case [("velocity" | "another's-velocity") as whose, *enu]:
                source = "keyboard" if whose == "velocity" else "another"
                script.feed(StreamSeen(source, None, place(*enu), None, None, None))
            case ["sample", *enu]:
                script.feed(PositionSeen(place(*enu), STILL, script.now_ns // 1_000_000))
            case ["message"]:
                script.feed(MessageSeen())
            case ["no", ("positions" | "heartbeats" | "landed") as what]:
                setattr(script, f"reports_{what.removesuffix('s')}", False)
            case [("positions" | "heartbeats") as what]:
                setattr(script, f"reports_{what.removesuffix('s')}", True)
            case ["unheard", "for", seconds]:
                script.reports_heartbeat = script.reports_position = False
                script.wait(float(seconds))
            case [answer, kind, *text] if answer in ANSWERS:
                self.answer(CommandKind[kind], ANSWERS[answer], " ".join(text))
            case ["photo", ("seen" | "failed") as how, index]:
                script.feed(PhotoSeen(int(index), how == "seen"))
            case ["loaded", items]:
                script.feed(MissionLoaded("square", int(items)))
            case ["item", seq, total, *over]:
                script.feed(MissionSeen(int(seq), int(total), over == ["finished"]))
            case ["raised", condition, *text]:
                told = " ".join(text) or "bad"
                script.feed(ConditionChanged(Condition[condition], True, told))
            case ["over", condition]:
                script.feed(ConditionChanged(Condition[condition], False))
            # what the station learns
            case ["return-height", up]:
                script.feed(ReturnHeightSeen(float(up)))
            case ["home", *enu]:
                script.feed(HomeSeen(place(*enu)))
            case ["fence", "elsewhere"]:
                script.feed(VerifierChanged(elsewhere(script)))
            case ["same-fence"]:
                verifier = script.gate.memory.verifier
                assert verifier is not None
                script.feed(VerifierChanged(verifier))
            case ["fence", "again"]:
                script.place()
            case ["remembers", *facts]:
                pairs = (fact.split("=") for fact in facts)
                remember(script, **{name: FACTS[name](word) for name, word in pairs})
            # time
            case ["bare-tick"]:  # with no report before it
                script.feed(Tick(0))
            case ["wait", seconds]:
                script.wait(float(seconds))
            case ["tick", *ticks]:
                script.tick(*map(int, ticks))
            case ["later", seconds]:
                script.now_ns += round(float(seconds) * SECOND)
            case ["nothing"]:
                pass
            case [word, *rest]:
                self.steps[word](self, *rest)


def _script(settings: list[str]) -> Script:
    changes: dict[str, object] = {}
    severities = dict(policy("default").severities)
    autopilot, rules = "px4", None
    for setting in settings:
        key, _, value = setting.partition("=")
        if key in Condition.__members__:
            severities[Condition[key]] = Severity[value]
        elif key == "lab":
            rules = policy("lab")
        elif not value:
            autopilot = key
        elif key == "arming.preflight":
            changes["arming"] = replace(policy("default").arming, preflight=value)
        else:
            words: dict[str, object] = {"yes": True, "no": False}
            if value == "lab":
                changes[key] = getattr(policy("lab"), key)
                continue
            number = float(value) if re.fullmatch(r"[\d.]+", value) else value
            changes[key] = words.get(value, number)
    return Script(rules or default_policy(severities=severities, **changes), autopilot)
