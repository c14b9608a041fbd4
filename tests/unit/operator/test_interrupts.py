"""Signals of an operator's program, as something that a wait can end with."""

from __future__ import annotations

import select
import signal

from gcs.operator.interrupts import Interrupts


def test_an_interrupt_is_noted_wakes_the_wait_and_is_given_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGINT)
        assert select.select([interrupts], [], [], 60.0)[0] == [interrupts]
        assert interrupts.name == "SIGINT"
        interrupts.forget()
        assert interrupts.name == ""
        assert select.select([interrupts], [], [], 0.0)[0] == []
        signal.raise_signal(signal.SIGTERM)
        assert interrupts.name == "SIGTERM"
    assert signal.getsignal(signal.SIGINT) is before
