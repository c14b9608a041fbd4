"""What an operator asked of a station and the running one, which it would join, has otherwise.

Policy, log folder, vehicle, speed-up and whether it is kept are fixed when a station starts.  Who
joins a running one gets it as it is; what was asked for by name and differs is told.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gcs.config import Wanted
from gcs.shell.stations import Description


@dataclass(frozen=True, slots=True)
class Difference:
    """`option` as a Python program writes it, `wanted` what was asked for, `has` what is there."""

    option: str
    wanted: str
    has: str

    def __str__(self) -> str:
        return f"{self.option} {self.wanted} was asked for, it has {self.has}"


def differences(found: Description, wanted: Wanted) -> list[Difference]:
    """What the station has otherwise.  Policies are compared by what is in their files.

    Raises OSError for a policy that cannot be read.
    """
    return list(_differences(found, wanted))


def sentence(found: Description, different: Sequence[Difference]) -> str:
    """What differs, in words."""
    told = "; ".join(map(str, different))
    return f"the link is held by the running station of process {found.pid}, which differs: {told}"


def hint(found: Description, different: Sequence[Difference], prefix: str = "") -> str:
    """How to go on; `prefix` is what an option begins with."""
    names = " and ".join(
        f"{prefix}{each.option.replace('_', '-' if prefix else '_')}" for each in different
    )
    end = "".join(f" --link {link}" for link in found.endpoints[:1])
    return f"leave out {names} to use that station as it is, or end it: gcs stations end{end}"


def _differences(found: Description, wanted: Wanted) -> Iterator[Difference]:
    if wanted.policy is not None and found.policy_digest:
        from gcs.policy_digest import policy_digest

        if policy_digest(wanted.policy) != found.policy_digest:
            another = found.policy == wanted.policy
            has = "another one of that name" if another else found.policy
            yield Difference("policy", wanted.policy, has)
    if wanted.log_dir is not None:
        folder = os.path.realpath(wanted.log_dir)
        has = os.path.dirname(os.path.realpath(found.log_path)) if found.log_path else ""
        if folder != has:
            yield Difference("log_dir", wanted.log_dir, has or "no log")
    if wanted.vehicle is not None:
        names = found.vehicles or [found.vehicle]
        if str(wanted.vehicle) not in [name.partition("/")[0] for name in names]:
            has = ", ".join(names) or "heard no vehicle yet"
            yield Difference("vehicle", str(wanted.vehicle), has)
    if wanted.speedup is not None and wanted.speedup != found.speedup:
        yield Difference("speedup", f"{wanted.speedup:g}", f"{found.speedup:g}")
    if wanted.keep is not None and wanted.keep != found.keep:
        yield Difference("keep", str(wanted.keep), str(found.keep))
