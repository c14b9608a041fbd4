"""Parameters set one after the other: read, set where they differ, read back, or why not."""

from __future__ import annotations

import struct

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.lock_parameters import Wanted
from gcs.protocol.parameter_setup import EVERY_NS, TRIES, Change, ParameterSetup
from gcs.wire.messages import Message, ParamError, ParamRequestRead, ParamSet, ParamValue

OWN, VEHICLE = Address(255, 190), Address(1, 1)
INT32, REAL32 = 6, 9


def to(value: float) -> Wanted:
    return Wanted("RTL_ALT_M", lambda _: value)


class Script:
    """A setup, its clock, and what it sent."""

    def __init__(self, *wanted: Wanted, encoding: ParamEncoding = ParamEncoding.CAST) -> None:
        self.setup = ParameterSetup(OWN, VEHICLE, encoding, wanted)
        self.now_ns = 0
        self.sent: list[Message] = [send.message for send in self.setup.start(0)]

    def hear(self, message: Message, sysid: int = 1) -> list[Message]:
        return self._keep(self.setup.handle(Heard(sysid, 1, message), self.now_ns))

    def has(self, name: str, value: float, kind: int = REAL32, sysid: int = 1) -> list[Message]:
        return self.hear(ParamValue(value, 1, 0, name, kind), sysid)

    def denies(self, name: str) -> list[Message]:
        return self.hear(ParamError(-1, OWN.sysid, OWN.compid, name, 1))

    def wait(self) -> list[Message]:
        self.now_ns += EVERY_NS
        return self._keep(self.setup.handle(Wake(), self.now_ns))

    def _keep(self, sends: list[Send]) -> list[Message]:
        sent = [send.message for send in sends]
        self.sent += sent
        return sent

    @property
    def asked(self) -> list[str]:
        return [each.param_id for each in self.sent if isinstance(each, ParamRequestRead)]

    @property
    def set(self) -> list[tuple[str, float, int]]:
        return [
            (each.param_id, each.param_value, each.param_type)
            for each in self.sent
            if isinstance(each, ParamSet)
        ]


def test_it_is_read_set_and_over_once_it_is_told_back() -> None:
    script = Script(Wanted("FENCE_RADIUS", lambda _: 60.0))
    assert script.asked == ["FENCE_RADIUS"]
    assert script.has("FENCE_RADIUS", 150.0) != []
    assert script.set == [("FENCE_RADIUS", 60.0, REAL32)]
    assert script.setup.changes == []
    (asked,) = script.has("FENCE_RADIUS", 60.0)
    assert isinstance(asked, ParamRequestRead)  # an echo says little
    assert script.setup.changes == []
    assert script.has("FENCE_RADIUS", 60.0) == []
    assert script.setup.over
    assert script.setup.changes == [Change("FENCE_RADIUS", 150.0, 60.0)]
    assert script.setup.deadline_ns is None


def test_what_is_right_already_is_not_set() -> None:
    script = Script(Wanted("FENCE_RADIUS", lambda is_now: is_now), Wanted("B", lambda _: 1.0))
    script.has("FENCE_RADIUS", 150.0)
    assert script.set == []
    assert script.asked == ["FENCE_RADIUS", "B"]


def test_an_older_name_in_another_unit_is_set_in_that_unit() -> None:
    """RTL_ALT is in centimetres."""
    script = Script(to(15.0))
    assert script.asked == ["RTL_ALT_M", "RTL_ALT"]
    script.denies("RTL_ALT_M")
    script.has("RTL_ALT", 3000.0)
    assert script.set == [("RTL_ALT", 1500.0, REAL32)]
    script.has("RTL_ALT", 1500.0)
    script.has("RTL_ALT", 1500.0)
    assert script.setup.changes == [Change("RTL_ALT", 3000.0, 1500.0)]


def test_a_float_that_has_no_float32_is_kept_as_near_as_it_can_be() -> None:
    script = Script(Wanted("COM_OF_LOSS_T", lambda _: 0.1))
    script.has("COM_OF_LOSS_T", 1.0)
    for _ in range(2):
        script.has("COM_OF_LOSS_T", struct.unpack("<f", struct.pack("<f", 0.1))[0])
    assert script.setup.over


def test_a_px4_has_the_bytes_of_an_integer_in_the_float() -> None:
    script = Script(Wanted("GF_ACTION", lambda _: 2.0), encoding=ParamEncoding.BYTEWISE)
    (three, two) = (struct.unpack("<f", struct.pack("<i", n))[0] for n in (3, 2))
    script.has("GF_ACTION", three, INT32)
    assert script.set == [("GF_ACTION", two, INT32)]
    script.has("GF_ACTION", two, INT32)
    script.has("GF_ACTION", two, INT32)
    assert script.setup.changes == [Change("GF_ACTION", 3.0, 2.0)]


def test_what_is_lost_is_sent_again_and_what_stays_as_it_is_ends_it() -> None:
    script = Script(to(15.0), Wanted("B", lambda _: 1.0))
    script.has("RTL_ALT_M", 30.0)
    for _ in range(TRIES - 1):
        script.wait()
    assert len(script.set) == TRIES
    script.has("RTL_ALT_M", 30.0)
    script.wait()
    assert script.setup.over
    assert script.setup.failure == "RTL_ALT_M: stays 30"
    assert "B" not in script.asked


def test_one_that_is_echoed_and_not_kept_is_set_again() -> None:
    script = Script(to(15.0))
    script.has("RTL_ALT_M", 30.0)
    script.has("RTL_ALT_M", 15.0)
    script.has("RTL_ALT_M", 30.0)
    script.wait()
    assert len(script.set) == 2
    assert not script.setup.over


def test_a_vehicle_that_does_not_answer_or_has_no_such_parameter_ends_it() -> None:
    silent = Script(to(15.0))
    for _ in range(TRIES):
        silent.wait()
    assert silent.setup.failure == "RTL_ALT_M: the vehicle did not answer"
    without = Script(to(15.0))
    without.denies("RTL_ALT")
    assert not without.setup.over
    without.denies("RTL_ALT_M")
    assert without.setup.failure == "RTL_ALT_M: the vehicle has no such parameter"


def test_a_setting_that_is_refused_ends_it() -> None:
    script = Script(to(15.0))
    script.has("RTL_ALT_M", 30.0)
    script.denies("RTL_ALT_M")
    assert script.setup.failure == "RTL_ALT_M: the vehicle refuses it (PARAM_ERROR)"


def test_another_vehicle_and_another_parameter_say_nothing() -> None:
    script = Script(to(15.0))
    assert script.has("RTL_ALT_M", 30.0, sysid=2) == []
    assert script.has("B", 30.0) == []
    assert script.set == []
