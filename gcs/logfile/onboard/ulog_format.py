"""How the messages of a ULog look, by its format messages (PX4 User Guide, ULog File Format)."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.chunk_reader import Bytes, Index, rows_at

HEAD_BYTES = 3
"""Two bytes of size, which counts what follows the type, and the type."""
_ID_BYTES = 2
_LONGEST = 1 << 16
"""A message has 16 bits for its size."""
_FIELD = re.compile(r"(\w+)(?:\[(\d{1,18})\])? (\w+)\Z")
_CODES = {
    "int8_t": "<i1",
    "uint8_t": "<u1",
    "int16_t": "<i2",
    "uint16_t": "<u2",
    "int32_t": "<i4",
    "uint32_t": "<u4",
    "int64_t": "<i8",
    "uint64_t": "<u8",
    "float": "<f4",
    "double": "<f8",
    "bool": "<i1",
    "char": "<i1",
}


@dataclass(frozen=True, slots=True)
class Subscription:
    """The messages of one topic and instance."""

    name: str
    """Of its table."""
    raw: np.dtype[np.void]
    """Without the padding at its end, which a message may leave out."""
    most: int
    """Bytes with the padding."""
    time_offset: int | None
    """Of the field `timestamp`, from where a message begins."""

    @property
    def least(self) -> int:
        return self.raw.itemsize

    def rows(self, data: Bytes, places: Index, time_ns: Index) -> Records:
        """The messages that begin at these places."""
        fields = [(TIME_FIELD, "<i8"), *((n, self.raw[n]) for n in self.raw.names or ())]
        made = np.empty(len(places), fields)
        as_bytes = made.view(np.uint8).reshape(len(made), made.dtype.itemsize)
        as_bytes[:, 8:] = rows_at(data, places + HEAD_BYTES + _ID_BYTES, self.raw.itemsize)
        made[TIME_FIELD] = time_ns
        return made


class Topics:
    """The formats and subscriptions of one log as far as it was read."""

    def __init__(self) -> None:
        self._fields: dict[str, list[tuple[str, int, str]]] = {}
        self._layouts: dict[str, np.dtype[np.void]] = {}
        """Of each table."""

    def learn(self, text: str) -> bool:
        """`name:type field;type[3] field;`; whether it is one."""
        name, _, described = text.partition(":")
        fields = [_FIELD.match(each) for each in described.split(";") if each]
        if not name or not fields or not all(fields):
            return False
        self._fields[name] = [
            (each[1], int(each[2] or 0), each[3]) for each in fields if each is not None
        ]
        return True

    def subscribe(self, topic: str, instance: int) -> Subscription | None:
        """None where the topic has no format, or one that no message can have."""
        try:
            flat = self._flat(topic, "", [_LONGEST])
        except (KeyError, RecursionError, OverflowError):
            return None
        sizes = [np.dtype(code).itemsize for _, code in flat]
        most = sum(sizes)
        while flat and flat[-1][0].startswith("_padding"):
            flat.pop()
        if not flat:
            return None
        names = _names([name for name, _ in flat])
        raw = np.dtype([(name, code) for name, (_, code) in zip(names, flat, strict=True)])
        at = next((n for n, each in enumerate(flat) if each == ("timestamp", "<u8")), None)
        return Subscription(
            self._table(f"{topic}_{instance}", raw),
            raw,
            most,
            None if at is None else HEAD_BYTES + _ID_BYTES + sum(sizes[:at]),
        )

    def _flat(self, name: str, prefix: str, budget: list[int]) -> list[tuple[str, str]]:
        """Every field and every element of arrays and nested formats, of at most `budget` bytes.
        Raises KeyError, RecursionError and OverflowError."""
        found: list[tuple[str, str]] = []
        for kind, count, field in self._fields[name]:
            code = _CODES.get(kind)
            size = 1 if code is None else np.dtype(code).itemsize
            for number in range(count or 1):
                budget[0] -= size
                if budget[0] < 0:
                    raise OverflowError
                place = prefix + (f"{field}[{number}]" if count else field)
                found += [(place, code)] if code else self._flat(kind, f"{place}.", budget)
        return found

    def _table(self, name: str, raw: np.dtype[np.void]) -> str:
        """Where a topic has two layouts in one log, the second is a table of its own."""
        plain = re.sub(r"\W", "_", name)
        free, number = plain, 1
        while self._layouts.setdefault(free, raw) != raw:
            number += 1
            free = f"{plain}_{number}"
        return free


def _names(given: list[str]) -> list[str]:
    """Names of fields as ROS 1 allows them, all different."""
    made = [TIME_FIELD]
    for name in given:
        plain = re.sub(r"\W+", "_", name).strip("_") or "field"
        while plain in made:
            plain += "_"
        made.append(plain)
    return made[1:]
