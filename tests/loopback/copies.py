"""What many tests begin with is flown once, and copied for each of them.

A copy goes on as the one that flew there would: the same bytes (`test_determinism.py`).
"""

from __future__ import annotations

import copy
import copyreg
import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from struct import Struct
from types import MappingProxyType
from typing import TypeVar, get_args

from gcs.report import RecordItem
from tests.loopback.observed import Sent

T = TypeVar("T")


def never_copied(constant: type) -> None:
    """What never changes: a copy has the same one."""
    copy._deepcopy_dispatch[constant] = lambda same, _memo: same  # type: ignore[attr-defined]


# Signed links keep hashes, which are copied by their own means.
copyreg.pickle(type(hashlib.sha256()), lambda kept: (kept.copy, ()))
for constant in (MappingProxyType, Struct, Sent, *get_args(RecordItem)):
    never_copied(constant)

_flown: list[tuple[object, object]] = []
"""What each was made of, and what it has become.  Few, and not all can be hashed."""
_copying = True


@contextmanager
def each_flies_itself() -> Iterator[None]:
    """For a test that alters the program: what flew there before knows nothing of that."""
    global _copying
    _copying = False
    try:
        yield
    finally:
        _copying = True


def fly_or_copy(flight: T, made_of: object, fly: Callable[[], object]) -> None:
    """`fly` changes `flight`; of another one that was made of the same, what that became is copied
    into `flight` instead.  A flight that is recorded flies itself."""
    if not _copying or vars(flight).get("recorder") is not None:
        fly()
        return
    before = next((other for others, other in _flown if others == made_of), None)
    if before is None:
        fly()
        kept = copy.copy(flight)
        vars(kept).update(copy.deepcopy(vars(flight), {id(flight): kept}))
        _flown.append((made_of, kept))
        return
    vars(flight).update(copy.deepcopy(vars(before), {id(before): flight}))
