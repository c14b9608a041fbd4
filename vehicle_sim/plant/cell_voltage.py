"""The open-circuit voltage of a lithium-polymer cell over its charge."""

from __future__ import annotations

from typing import Final

CURVE: Final = (
    (3.00, 0.0), (3.45, 0.05), (3.60, 0.10), (3.70, 0.20), (3.78, 0.40), (3.88, 0.60),
    (4.02, 0.80), (4.20, 1.0),
)  # fmt: skip
"""Volts and charge (0..1), straight in between: the usual shape of a LiPo's curve."""


def cell_v(remaining: float) -> float:
    """`CURVE` as a kernel: volts for the charge (0..1) that is left."""
    return (
        4.02 + (remaining - 0.80) * 0.90
        if remaining > 0.80
        else 3.88 + (remaining - 0.60) * 0.70
        if remaining > 0.60
        else 3.78 + (remaining - 0.40) * 0.50
        if remaining > 0.40
        else 3.70 + (remaining - 0.20) * 0.40
        if remaining > 0.20
        else 3.60 + (remaining - 0.10) * 1.00
        if remaining > 0.10
        else 3.45 + (remaining - 0.05) * 3.00
        if remaining > 0.05
        else 3.00 + remaining * 9.00
    )
