"""A policy from its file on disk, with the zones of every fence file that it names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from gcs import toml
from gcs.gate.policy.parse import NameFault, parse_policy
from gcs.gate.policy.policy import BridgeRules, Policy
from gcs.gate.policy.zonespec import ZoneSpec
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.zones import zone_specs
from gcs.resources import policy_path


class PolicyFileError(Exception):
    """A policy that cannot be had: `str` says which file, where and what; `hint` what to do."""

    def __init__(self, text: str, hint: str) -> None:
        super().__init__(text, hint)
        self.text, self.hint = text, hint

    def __str__(self) -> str:
        return self.text


def load_policy(
    name: str, read_bytes: Callable[[Path], bytes] = Path.read_bytes
) -> tuple[Policy, str]:
    """The policy `default`, `lab` or of a TOML file, and the text of its file.

    Fence files are found beside the policy's file.  Raises PolicyFileError.
    """
    path = policy_path(name)

    def fence_file(fence_name: str) -> tuple[ZoneSpec, ...]:
        fence_path = path.parent / fence_name
        return zone_specs(read(str(fence_path), read_bytes(fence_path)).fence)

    try:
        text = toml.decode(read_bytes(path), str(path))
        return parse_policy(text, str(path), fence_file, _check_names), text
    except (toml.TomlError, PlanError) as error:
        raise PolicyFileError(str(error), error.hint) from error
    except OSError as error:
        hint = "--policy takes `default`, `lab` or the path of a TOML file"
        raise PolicyFileError(f"{error.filename}: {error.strerror}", hint) from error


def _check_names(rules: BridgeRules) -> NameFault | None:
    if not (rules.extra_denied or rules.extra_harmless or rules.manual_modes):
        return None
    from gcs.bridge.setup_policy.names import check_names

    return check_names(rules)
