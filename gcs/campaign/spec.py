"""CAMPAIGN.toml -> `Plan`: strict, with every file that it names read at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from gcs import toml
from gcs.campaign.case import Rules, Task, Value
from gcs.campaign.flight import START_NS, own_zones
from gcs.campaign.plan import FAULT, POLICY, SEED, TASK, Axis, Choice, Plan, Range, Sample
from gcs.campaign.sampling import grid_size
from gcs.campaign.simulators import Factory, UnknownSimulatorError, factory, truth_of
from gcs.campaign.truth import zones_about
from gcs.operator.line_parser import LineError, parse_line
from gcs.plan.errors import PlanError
from gcs.policy_file import PolicyFileError, load_policy
from gcs.request_words import SendRequests
from gcs.resources import MissionNotFoundError, find
from gcs.toml_lines import KeyPath

MOST_FLIGHTS = 10_000_000
CORNERS_TRIED = 1_000
"""So many values of axes are tried on the simulator before the first flight."""
VARY = "vary"


class _TaskTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    name: Annotated[str, Meta(min_length=1)]
    lines: tuple[str, ...] = ()
    mission: str = ""


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    name: Annotated[str, Meta(min_length=1)]
    sample: Sample
    task: tuple[_TaskTable, ...]
    vary: dict[str, object]
    flights: Annotated[int, Meta(ge=1, le=MOST_FLIGHTS)] | None = None
    seed: Annotated[int, Meta(ge=0, le=1_000_000)] = 1
    timeout_s: Annotated[float, Meta(ge=1.0, le=100_000.0)] = 600.0
    simulator: str = "vehicle-sim"


class _RangeTable(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename={"low": "from", "high": "to"}
):
    low: Annotated[float, Meta(ge=-1e9, le=1e9)]
    high: Annotated[float, Meta(ge=-1e9, le=1e9)]
    steps: Annotated[int, Meta(ge=2, le=100_000)] | None = None


def read_plan(path: Path, read_bytes: Callable[[Path], bytes] = Path.read_bytes) -> Plan:
    """Files are found from the folder of the campaign's own.  Raises TomlError and OSError."""
    return _Reader(path, read_bytes).plan()


class _Reader:
    def __init__(self, path: Path, read_bytes: Callable[[Path], bytes]) -> None:
        self._folder = path.parent
        self._read_bytes = read_bytes
        text = toml.decode(read_bytes(path), str(path))
        self._doc = toml.read(text, str(path))
        self._table = self._doc.convert(_Table, self._doc.data)

    def plan(self) -> Plan:
        table, doc = self._table, self._doc
        tasks = tuple(self._task(number, each) for number, each in enumerate(table.task))
        named = Choice(TASK, tuple(task.name for task in tasks))
        if len(set(named.values)) < len(named.values):
            raise doc.error((TASK,), "two tasks have one name", "a row names its task by it")
        vary = {POLICY: "default", **table.vary}
        if TASK in vary:
            raise doc.error((VARY, TASK), "unknown key", "each [[task]] is flown")
        axes = (named, *(self._axis(name, value) for name, value in vary.items()))
        plan = Plan(
            table.name,
            table.simulator,
            table.sample,
            self._flights(axes),
            table.seed,
            table.timeout_s,
            tasks,
            tuple(self._rules(name) for name in _values(axes, POLICY)),
            {str(name): self._fault(name) for name in _values(axes, FAULT) if name},
            axes,
        )
        self._try(plan)
        return plan

    def _flights(self, axes: tuple[Axis, ...]) -> int:
        table, doc = self._table, self._doc
        if table.sample != "grid":
            if table.flights is None:
                raise doc.error(("flights",), "is missing", "flights = 200")
            return table.flights
        for axis in axes:
            if isinstance(axis, Range):
                hint = "add steps = 5, or list the values"
                raise doc.error((VARY, axis.name), "a grid has no end of a range's values", hint)
        size = grid_size(axes)
        if table.flights not in (None, size):
            raise doc.error(("flights",), f"the grid has {size}", "leave it out")
        if size > MOST_FLIGHTS:
            raise doc.error((VARY,), f"{size} flights", f"at most {MOST_FLIGHTS}")
        return size

    # -------------------------------------------------------------------------- what is flown

    def _task(self, number: int, table: _TaskTable) -> Task:
        at: KeyPath = (TASK, number)
        if bool(table.lines) == bool(table.mission):
            hint = 'lines = ["arm", "takeoff 5", "land"], or mission = "square.toml"'
            raise self._doc.error(at, "has either lines or a mission", hint)
        key = (*at, "lines" if table.lines else "mission")
        lines = table.lines or ("arm", f'mission fly "{table.mission}"')
        files: dict[str, bytes] = {}
        for place, line in enumerate(lines):
            where = (*key, place) if table.lines else key
            try:
                parsed = parse_line(line)
            except LineError as error:
                raise self._doc.error(where, error.sentence, error.hint) from None
            action = None if parsed is None else parsed.action
            for asked in action.requests if isinstance(action, SendRequests) else ():
                if asked.path:
                    files[asked.path] = self._mission(asked.path, where)
        return Task(table.name, lines, files)

    def _mission(self, name: str, at: KeyPath) -> bytes:
        beside = self._folder / name
        try:
            return self._read_bytes(beside if beside.is_file() else find(name))
        except MissionNotFoundError as error:
            raise self._doc.error(at, str(error), error.hint) from None

    def _rules(self, name: Value) -> Rules:
        at = (VARY, POLICY)
        beside = self._folder / str(name)
        try:
            found = str(beside) if beside.is_file() else str(name)
            policy, text = load_policy(found, self._read_bytes)
        except PolicyFileError as error:
            raise self._doc.error(at, str(error), error.hint) from error
        return Rules(str(name), policy, text)

    def _fault(self, name: Value) -> str:
        path = self._folder / str(name)
        try:
            return toml.decode(self._read_bytes(path), str(path))
        except OSError as error:
            what = f"{path}: {error.strerror}"
            raise self._doc.error((VARY, FAULT), what, 'a fault file, or "" for none') from error

    # -------------------------------------------------------------------------- what differs

    def _axis(self, name: str, value: object) -> Axis:
        at = (VARY, name)
        if isinstance(value, dict):
            return self._range(name, self._doc.convert(_RangeTable, value, at), at)
        listed = value if isinstance(value, list) else [value]
        values = [self._value(each, at) for each in listed]
        if not values:
            raise self._doc.error(at, "is empty", "list at least one value")
        kinds = {type(each) for each in values}
        if kinds == {int, float}:
            values = [float(each) for each in values]
        elif len(kinds) > 1:
            raise self._doc.error(at, "has values of two kinds", "numbers, texts or true and false")
        if name in (POLICY, FAULT) and not all(isinstance(each, str) for each in values):
            raise self._doc.error(at, "is a list of files", f'{name} = ["..."]')
        if len(set(map(repr, values))) < len(values):
            raise self._doc.error(at, "has a value twice", "each value is flown as often as others")
        return Choice(name, tuple(values))

    def _value(self, value: object, at: KeyPath) -> Value:
        if isinstance(value, bool | int | str) or (
            isinstance(value, float) and math.isfinite(value)
        ):
            return value
        hint = "a value, a list of them, or { from = 0, to = 10 }"
        raise self._doc.error(at, f"{toml.shown(value)} is no value", hint)

    def _range(self, name: str, table: _RangeTable, at: KeyPath) -> Axis:
        if table.low >= table.high:
            raise self._doc.error((*at, "to"), "is not above `from`", "{ from = 0, to = 10 }")
        if name in (POLICY, FAULT, SEED):
            raise self._doc.error(at, "is no range", "list its values")
        if table.steps is None:
            return Range(name, table.low, table.high)
        step = (table.high - table.low) / (table.steps - 1)
        return Choice(name, tuple(table.low + number * step for number in range(table.steps)))

    def _try(self, plan: Plan) -> None:
        """Make the simulator, and place the fence, with each value of each axis once."""
        try:
            make = factory(plan.simulator)
        except UnknownSimulatorError as error:
            raise self._doc.error(("simulator",), str(error), error.hint) from None
        first = plan.inputs([0.0] * len(plan.axes))
        for _, (axis, value) in zip(range(CORNERS_TRIED), _each(plan.axes), strict=False):
            self._try_one(plan, make, axis, {**first, axis: value})

    def _try_one(self, plan: Plan, make: Factory, axis: str, inputs: Mapping[str, Value]) -> None:
        at: KeyPath = (TASK,) if axis == TASK else (VARY, axis)
        try:
            case = plan.case(0, inputs)
            home = truth_of(make({**case.table, "start_ns": START_NS})).home
            autopilot = str(case.table.get("autopilot", ""))
            zones_about(home, case.rules.policy, autopilot, own_zones(case))
        except PlanError as error:
            raise self._doc.error(at, str(error), error.hint) from error
        except ValueError as error:
            key, _, what = str(error).partition(": ")
            if key in inputs:
                raise self._doc.error((VARY, key), what) from error
            raise self._doc.error(at, str(error)) from error


def _values(axes: tuple[Axis, ...], name: str) -> tuple[Value, ...]:
    found = (axis.values for axis in axes if axis.name == name and isinstance(axis, Choice))
    return next(found, ())


def _each(axes: tuple[Axis, ...]) -> Iterator[tuple[str, Value]]:
    for axis in axes:
        for value in axis.values if isinstance(axis, Choice) else (axis.low, axis.high):
            yield axis.name, value
