"""Closed unions: what a module defines is in its union, frozen, and nothing else is."""

from __future__ import annotations

import inspect
from dataclasses import is_dataclass
from types import ModuleType
from typing import Any, get_args

import msgspec
import pytest

from gcs.bridge.effects import BridgeEffect
from gcs.gate import effects as gate_effects
from gcs.protocol.effects import Send
from gcs.session import effects, inputs, work
from gcs.station.queue import EFFECT_TYPES


def defined_in(module: ModuleType) -> set[type]:
    """Classes of the module's own."""
    found = vars(module).values()
    return {x for x in found if inspect.isclass(x) and x.__module__ == module.__name__}


def frozen(kind: type) -> bool:
    if is_dataclass(kind):
        return bool(kind.__dataclass_params__.frozen)  # type: ignore[attr-defined]
    return issubclass(kind, msgspec.Struct) and kind.__struct_config__.frozen


def test_every_input_is_in_the_union() -> None:
    assert set(get_args(inputs.Input)) == defined_in(inputs)


def test_all_but_a_datagram_is_recorded_as_an_input() -> None:
    assert set(get_args(inputs.Input)) - set(get_args(inputs.OtherInput)) == {inputs.Datagram}


def test_every_effect_is_in_the_union_and_the_queue_knows_it_for_one() -> None:
    assert set(get_args(effects.Effect)) == defined_in(effects) == EFFECT_TYPES


def test_work_is_effects_of_shell_and_gate_messages_and_what_is_defined_for_it() -> None:
    others = set(get_args(effects.Effect)) | set(get_args(gate_effects.Effect)) | {Send}
    others |= set(get_args(BridgeEffect))
    assert set(get_args(work.Work)) == others | defined_in(work)


@pytest.mark.parametrize("union", [inputs.Input, effects.Effect, work.Work])
def test_every_member_is_a_value_that_nobody_changes(union: Any) -> None:  # a union has no type
    assert [kind for kind in get_args(union) if not frozen(kind)] == []
