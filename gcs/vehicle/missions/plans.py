"""A plan on its way to the vehicle and back: from a file to wire items, and what is on board.

Everything here is about the plan alone; whether its path may be flown is `paths.verify`'s to say.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from gcs.gate.effects import Level
from gcs.gate.refusal import Refusal
from gcs.plan import commands
from gcs.plan.commands import KINDS, Kind
from gcs.plan.errors import Level as PlanLevel
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read_in_steps
from gcs.plan.lint import lint
from gcs.plan.model import Geodetic, Plan
from gcs.plan.parts import WORDS, apart, held
from gcs.plan.wire import WireItem, from_wire, to_wire
from gcs.plan.wire_fence import fence_to_wire, has_heights, rally_to_wire
from gcs.steps import Steps
from gcs.vehicle.missions.paths import autopilot_name, on_earth
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MissionType

MAX_ITEMS = 2_000
"""More would keep the 20 Hz tick waiting while they are checked."""

STOPS = (Kind.MOVE, Kind.WAIT, Kind.RETURN)
"""Items whose reaching ends a mission, where they are the last of their kind."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """A plan placed on Earth, its items as they will leave, and what its readers remarked."""

    plan: Plan
    sent: tuple[WireItem, ...]
    remarks: tuple[tuple[Level, str], ...]
    fence: tuple[WireItem, ...] = ()
    rally: tuple[WireItem, ...] = ()
    not_sent: str = ""
    """What of the plan is not sent, to end a sentence with."""


@dataclass(frozen=True, slots=True)
class OnBoard:
    """The mission that we brought on board and read back equal."""

    plan: Plan
    sent: tuple[WireItem, ...]
    last_seq: int | None
    """The last stop; None where the mission ends on the ground, which is telemetry by landing."""
    loops: bool
    """It jumps back: its last stop may be reached many times."""


def prepare(
    path: str, data: bytes, telemetry: Telemetry, kind: MissionType = MissionType.MISSION
) -> Steps[Prepared | Refusal]:
    """Read, lint and place the plan in `data`: all of it, or its fence or rally points alone.

    Raises PlanError for a file that is none, none that can be flown, or has none of that `kind`;
    refuses where the vehicle's origin or home is not known.
    """
    written = yield from read_in_steps(path, data, autopilot_name(telemetry))
    yield
    if kind is MissionType.MISSION:
        return (yield from prepare_plan(path, written, telemetry))
    alone, rest = apart(kind, written)
    if not held(alone):
        hint = f"it has {', '.join(held(rest)) or 'nothing'}"
        raise PlanError(path, "", WORDS[kind], "none is in this file", hint=hint)
    prepared = yield from prepare_plan(path, alone, telemetry)
    if isinstance(prepared, Refusal) or not held(rest):
        return prepared
    return replace(prepared, not_sent=f"; not sent of the file: {', '.join(held(rest))}")


def prepare_items(
    path: str, items: tuple[WireItem, ...], telemetry: Telemetry
) -> Steps[Prepared | Refusal]:
    """The same for a mission that came over a link; `path` stands for a file in errors."""
    yield
    written = from_wire(items, autopilot_name(telemetry), path)
    for item in written.items:
        if KINDS.get(item.command) is Kind.FENCE:
            what = "belongs to a fence or to rally points, which are plans of their own"
            raise PlanError(path, item.where, commands.name(item.command), what)
    yield
    return (yield from prepare_plan(path, written, telemetry))


def prepare_plan(path: str, written: Plan, telemetry: Telemetry) -> Steps[Prepared | Refusal]:
    """Lint and place what was read; as `prepare`."""
    who = autopilot_name(telemetry)
    home = Geodetic(*telemetry.home) if telemetry.home else None
    if not held(written):
        hint = "`gcs mission clear`, `gcs fence clear` and `gcs rally clear` clear what is on board"
        raise PlanError(path, "", "plan", "has no items, no fence and no rally points", hint=hint)
    if not written.items and has_heights(written.fence):
        hint = "`gcs fence put` puts the policy's fence on board, its ceiling as a parameter"
        what = "has heights, which the zones of a vehicle have not"
        raise PlanError(path, "", "fence", what, hint=hint)
    if len(written.items) > MAX_ITEMS:
        what = f"has {len(written.items)} items"
        raise PlanError(path, "", "mission", what, f"at most {MAX_ITEMS}")
    remarks = []
    for finding in lint(written, who, home):
        if finding.level is PlanLevel.ERROR:
            raise PlanError(path, finding.where, finding.item, finding.what, hint=finding.hint)
        level = Level.WARNING if finding.level is PlanLevel.WARNING else Level.INFO
        remarks.append((level, f"{finding.item}: {finding.what}"))
    yield
    plan = on_earth(written, telemetry)
    if isinstance(plan, Refusal):
        return plan
    yield
    sent = to_wire(plan, who, home)
    amsl_m = home.alt_amsl_m if home is not None and who == "px4" else None
    rally = rally_to_wire(plan.rally, amsl_m)
    if has_heights(plan.fence):
        remarks.append((Level.WARNING, "fence: is kept by the gate and not sent: it has heights"))
        return Prepared(plan, sent, tuple(remarks), (), rally, "; its fence is not sent")
    fence = fence_to_wire(path, plan.fence)
    return Prepared(plan, sent, tuple(remarks), fence, rally)


def on_board(plan: Plan, sent: tuple[WireItem, ...]) -> OnBoard:
    """What `sent` is once it was read back equal."""
    home_items = len(sent) - len(plan.items)
    return OnBoard(plan, sent, _last_stop(plan, home_items), _loops(plan))


def _last_stop(plan: Plan, home_items: int) -> int | None:
    """The seq whose reaching ends the mission; None if it ends with a landing or a return."""
    stops = [i for i, item in enumerate(plan.items) if KINDS.get(item.command) in STOPS]
    if not stops:
        return len(plan.items) - 1 + home_items
    return None if _lands(plan) else stops[-1] + home_items


def _loops(plan: Plan) -> bool:
    return any(KINDS.get(item.command) is Kind.JUMP for item in plan.items)


def _lands(plan: Plan) -> bool:
    """Whether it ends on the ground: that is telemetry by the landing, and by nothing before it."""
    stops = [item for item in plan.items if KINDS.get(item.command) in STOPS]
    if not stops:
        return False
    return stops[-1].command == Cmd.NAV_LAND or KINDS.get(stops[-1].command) is Kind.RETURN
