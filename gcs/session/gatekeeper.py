"""Everything to and from the gate: requests in, permits out, commands on their way and back.

The gate decides; what it says is carried out here and told to operator and record.  Nothing
reaches the vehicle's motion on any other path.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable

from gcs.config import LinkConfig
from gcs.frames import Vec3
from gcs.gate import effects, inputs, requests
from gcs.gate.airspace.verifier import Verifier, check_start, verifier_for
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.gate.machine.gate import Gate
from gcs.gate.policy.policy import ControlTimes, Policy
from gcs.gate.refusal import Refusal
from gcs.gate.states import Control, State
from gcs.protocol.effects import Heard
from gcs.record.items import FsaItem
from gcs.session import orders, teller
from gcs.session.desk import Requests
from gcs.session.fences import fence_item, fences_event
from gcs.session.orders import Orders
from gcs.session.outbox import Outbox
from gcs.session.telemetry import Telemetry
from gcs.wire.messages import CommandLong, Message


class Gatekeeper:
    """One gate, for the one vehicle that it judges; a stranger until a vehicle is heard."""

    def __init__(self, policy: Policy, out: Outbox, config: LinkConfig, now_ns: int) -> None:
        self.policy = on_wall_time(policy, config.speedup)
        self._out = out
        self._orders = Orders(config.sysid, config.compid, config.speedup)
        self.seen: Telemetry | None = None
        self.requests = Requests()
        self.gate = Gate(self.policy, "", now_ns)
        self.verifier: Verifier | None = None
        self.bad_start: Refusal | None = None
        self._start_checked = False
        self._fence_on = True

    @property
    def deadline_ns(self) -> int | None:
        """When the next command's wait is over; the gate itself lives on ticks."""
        return self._orders.deadline_ns

    def meet(self, seen: Telemetry, now_ns: int) -> None:
        """A vehicle was heard: from here on the gate knows whose rules apply."""
        self.seen = seen
        before = self.gate
        self.gate = Gate(self.policy, seen.autopilot.name, now_ns)
        for condition, text in before.memory.conditions:
            self.condition(condition, True, text, now_ns)

    # --------------------------------------------------------------------------- towards it

    def request(self, request_id: int, wish: requests.Request, now_ns: int) -> None:
        """Ask for something, in the name of whoever opened `request_id`."""
        asked = self.requests.get(request_id)
        teller.requested(self._out, asked, wish, now_ns)
        self.give(inputs.Requested(request_id, asked.source, wish), now_ns)

    def give(self, given: inputs.Input, now_ns: int) -> None:
        """Hand an input to the gate and do what follows."""
        if isinstance(given, inputs.ConditionChanged) and not self._news(given):
            return
        for effect in self.gate.handle(given, now_ns):
            self.carry_out(effect, now_ns)
        if isinstance(given, inputs.HomeSeen | inputs.GeodeticSeen):
            self.place_fence(now_ns)
        elif isinstance(given, inputs.PositionSeen):
            if given.reset:
                self.place_fence(now_ns)
            self._check_start(given)

    def _news(self, given: inputs.ConditionChanged) -> bool:
        """Whether the condition changed; it is looked at far more often than it does."""
        return given.active != (given.condition in self.gate.conditions)

    def condition(self, condition: Condition, active: bool, text: str, now_ns: int) -> None:
        self.give(inputs.ConditionChanged(condition, active, text), now_ns)

    def ask(self, command: CommandLong, now_ns: int) -> None:
        """A harmless command of the station's own (streams, origin); nobody waits for it."""
        self._from_orders(self._orders.ask(command, now_ns), now_ns)

    def heard(self, heard: Heard, now_ns: int) -> None:
        self._from_orders(self._orders.heard(heard, now_ns), now_ns)

    def wake(self, now_ns: int) -> None:
        self._from_orders(self._orders.wake(now_ns), now_ns)

    def hold_blind(self, now_ns: int) -> None:
        """The last resort: HOLD, past a gate that may be broken, where control was ours."""
        if self.seen is not None and self.gate.control is not Control.NONE:
            hold = effects.SendCommand(0, effects.CommandKind.HOLD, now_ns)
            for item in self._orders.send(hold, self.seen, now_ns):
                if isinstance(item, Message):
                    self.send(item)

    # ---------------------------------------------------------------------------- from it

    def carry_out(self, effect: effects.Effect, now_ns: int) -> None:
        """Do, tell and record what was decided."""
        match effect:
            case effects.SendSetpoint(permit):
                assert self.seen is not None
                self._out.setpoint(self.seen, permit, now_ns)
            case effects.SendCommand():
                assert self.seen is not None
                self._from_orders(self._orders.send(effect, self.seen, now_ns), now_ns)
            case effects.CancelCommand(request_id, kind):
                self._from_orders(self._orders.cancel(request_id, kind, now_ns), now_ns)
            case effects.SwitchedFence(on):
                self._fence_on = on
                self.place_fence(now_ns)
            case effects.Verdict(request_id, _, wish, outcome, refusal, _, evidence):
                goal_ned = wish.goal_ned if isinstance(wish, requests.GoTo) else None
                self.verdict(request_id, outcome, refusal, evidence, goal_ned)
            case effects.Outcome():
                self.ending(effect)
            case effects.Transition():
                teller.transition(self._out, effect, self.gate.active_goal_ned, self._sysid)
            case effects.Say(level, text):
                self._out.say(level, teller.NODE, text, now_ns)

    def verdict(
        self,
        request_id: int,
        outcome: effects.Ruling,
        refusal: Refusal | None,
        evidence: tuple[tuple[str, float], ...] = (),
        goal_ned: Vec3 | None = None,
    ) -> None:
        """Tell the one verdict of a request; a refused or superseded one is over with it."""
        over = outcome is not effects.Ruling.ACCEPTED
        asked = self.requests.close(request_id) if over else self.requests.get(request_id)
        teller.verdict(
            self._out,
            request_id,
            asked,
            self._sysid,
            outcome,
            refusal,
            evidence=evidence,
            goal_ned=goal_ned,
        )

    def ending(self, told: effects.Outcome) -> None:
        """Tell the one ending of an accepted request."""
        asked = self.requests.close(told.request_id)
        teller.ending(self._out, told, asked, self._sysid)

    @property
    def _sysid(self) -> int:
        return self.seen.sysid if self.seen else 0

    def send(self, message: Message) -> None:
        """A message that moves nothing, to our vehicle."""
        assert self.seen is not None
        self._out.send(self.seen.link, message)

    def remind(self) -> None:
        """The state once more: a state bar in a viewer ends at its last message."""
        if self.seen is None:
            return
        now = self.gate
        state = now.state
        self._out.record(
            FsaItem(
                self._sysid,
                int(state),
                state.name,
                state.name,
                "reminder",
                now.control.name,
                now.severity.name,
                now.active_goal_ned,
            )
        )

    def _from_orders(self, news: Iterable[orders.Out], now_ns: int) -> None:
        for item in news:
            match item:
                case inputs.CommandEnded():
                    self.give(item, now_ns)
                case str():
                    self._out.say(Level.DEBUG, "link", item, now_ns)
                case _:
                    self.send(item)

    # -------------------------------------------------------------------------- the fence

    def place_fence(self, now_ns: int) -> None:
        """Home or origin became known, or moved: the fence stands anew, is shown and recorded."""
        seen = self.seen
        if seen is None:
            return
        self.verifier = verifier_for(
            self.policy,
            seen.autopilot.name,
            seen.home_ned,
            seen.origin,
            fence_on=self._fence_on,
        )
        self.give(inputs.VerifierChanged(self.verifier), now_ns)
        self._out.record(fence_item(self.verifier.zones, seen.origin))
        self._out.emit(fences_event(self.verifier.zones))

    def _check_start(self, position: inputs.PositionSeen) -> None:
        """Once, on the ground: is the vehicle inside?  If not, the policy is for elsewhere.

        A vehicle that is met in the air is judged request by request: it must not be left alone.
        """
        grounded = self.gate.state is State.GROUNDED
        if self._start_checked or not grounded or not (self.verifier and self.verifier.zones):
            return
        self._start_checked = True
        self.bad_start = check_start(self.verifier, position.pos_ned)


def on_wall_time(policy: Policy, speedup: float) -> Policy:
    """Times that wait for the other side's heartbeat and answers do not shrink with a speed-up.

    A sped-up vehicle still beats once in a real second and proves a stream in real time, so that
    ordinary clients stay connected; on the session's clock that takes `speedup` times as long.
    """
    times = policy.control
    return dataclasses.replace(
        policy,
        heartbeat_age_s=policy.heartbeat_age_s * speedup,
        control=ControlTimes(times.stream_s * speedup, times.timeout_s * speedup),
    )
