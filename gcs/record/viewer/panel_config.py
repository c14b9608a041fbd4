"""What a panel's configuration is made of."""

from __future__ import annotations

from typing import TypeAlias

Json: TypeAlias = "str | int | float | bool | list[Json] | dict[str, Json] | None"
Config: TypeAlias = dict[str, Json]
