"""The names in the policy's `[bridge]`: whether they are those of messages, commands and modes, and
what the policy says of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.bridge.catalog.explain import explain
from gcs.bridge.catalog.row import Kind
from gcs.gate.policy.parse import NameFault
from gcs.gate.policy.policy import BridgeRules
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.autopilot import ARDUPILOT, PX4, mode_named
from gcs.toml import did_you_mean

_NOT_DENIED: Final = {
    Kind.CARRIER: ("carries commands", "write the command's name"),
    Kind.LOCAL: ("is between a client and the gate", ""),
}
_NOT_HARMLESS: Final = {
    Kind.HARMLESS: ("is harmless already", "leave it out"),
    Kind.MOTION: ("moves the vehicle: the gate decides", ""),
    Kind.CONFIGURATION: ("has a key of its own in [bridge]", ""),
    **_NOT_DENIED,
}
_MODES: Final = tuple(dict.fromkeys(mode.name for each in (PX4, ARDUPILOT) for mode in each.modes))
"""Each once: many are both autopilots'."""

DENIED_BY_NAME: Final = Refusal(
    Code.POLICY, "the policy denies it by its name (policy: bridge.extra_denied)"
)


def kinds_by_name(rules: BridgeRules) -> Mapping[str, Kind]:
    """What the policy says of messages and commands by name; they are as `check_names` has them."""
    denied = {explain(name).name: Kind.DENIED for name in rules.extra_denied}
    return denied | {explain(name).name: Kind.HARMLESS for name in rules.extra_harmless}


def check_names(rules: BridgeRules) -> NameFault | None:
    """The first name that is wrong; for `parse_policy`."""
    for key, names, wrong in (
        ("extra_denied", rules.extra_denied, _NOT_DENIED),
        ("extra_harmless", rules.extra_harmless, _NOT_HARMLESS),
    ):
        for entry, name in enumerate(names):
            try:
                row = explain(name)
            except KeyError as error:
                return NameFault(key, entry, str(error.args[0]))
            if name not in (row.name, f"MAV_CMD_{row.name}"):
                return NameFault(key, entry, f'"{name}" is no name', f"did you mean {row.name}?")
            if row.kind in wrong:
                what, hint = wrong[row.kind]
                return NameFault(key, entry, f'"{name}" {what}', hint)
    for entry, name in enumerate(rules.manual_modes):
        if mode_named(PX4, name) is None and mode_named(ARDUPILOT, name) is None:
            what = f'"{name}" is no mode of an autopilot'
            return NameFault("manual_modes", entry, what, did_you_mean(name, _MODES))
    return None
