"""Battery, link, GPS and the vehicle's own fence, as conditions by the policy's limits."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy
from gcs.protocol.sequence import SequenceCount, SequenceTracker
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput
from gcs.vehicle.health.limit_monitors import Watch
from gcs.wire.ids import ChargeState
from gcs.wire.messages import BatteryStatus, FenceStatus, GpsRawInt, Message, RadioStatus, SysStatus

SECOND_NS = 1_000_000_000


class Script:
    """The watch, a clock, and the conditions that it has told last, with their words."""

    def __init__(self, policy: Policy = DEFAULT, speedup: float = 1.0) -> None:
        self.watch = Watch(policy, Times(speedup))
        self.now_ns = 100 * SECOND_NS
        self.losses = SequenceTracker()
        self.losses.senders[1, 1] = SequenceCount(0, 0, received=0)
        self.told: dict[Condition, str] = {}

    def hear(self, message: Message) -> None:
        self._take(self.watch.heard(message, self.now_ns))

    def radio(self, message: RadioStatus) -> None:
        self._take(self.watch.radio(message, self.now_ns))

    def seconds(self, number: int, came: int = 100, lost: int = 0) -> None:
        for _ in range(number):
            self.now_ns += SECOND_NS
            self.losses.senders[1, 1].received += came
            self.losses.senders[1, 1].lost += lost
            self._take(self.watch.second(self.losses, self.now_ns))

    def _take(self, work: Iterable[GateInput]) -> None:
        for item in work:
            assert isinstance(item.given, ConditionChanged)
            self.told.pop(item.given.condition, None)
            if item.given.active:
                self.told[item.given.condition] = item.given.text


# ------------------------------------------------------------------------------- battery


def system(left_pct: int, mv: int = 16_200) -> SysStatus:
    return SysStatus(0, 0, 0, 0, mv, -1, 0, 0, 0, 0, 0, 0, left_pct)


def battery(
    left_pct: int = 80,
    mv: tuple[int, ...] = (16_200,),
    state: int = ChargeState.OK,
    number: int = 0,
    function: int = 1,
) -> BatteryStatus:
    """As recorded of PX4 1.14.3 and ArduCopter 4.7: the whole voltage in the first cell, the others
    65535, battery_function 1 and 0, charge_state 1."""
    cells = (*mv, *(65535,) * (10 - len(mv)))
    return BatteryStatus(
        current_consumed=0,
        energy_consumed=-1,
        temperature=32767,
        voltages=cells,
        current_battery=-100,
        id=number,
        battery_function=function,
        type=1,
        battery_remaining=left_pct,
        charge_state=state,
    )


@pytest.mark.parametrize(
    ("left_pct", "low", "critical"),
    [(80, 0, 0), (16, 0, 0), (15, 1, 0), (8, 1, 0), (7, 1, 1), (0, 1, 1), (-1, 0, 0)],
)
@pytest.mark.parametrize("tell", [system, battery])
def test_a_low_battery_is_a_condition(
    tell: type[Message], left_pct: int, low: int, critical: int
) -> None:
    script = Script()
    script.hear(tell(left_pct))
    assert (Condition.BATTERY_LOW in script.told) is bool(low)
    assert (Condition.BATTERY_CRITICAL in script.told) is bool(critical)
    if low:
        assert script.told[Condition.BATTERY_LOW] == f"{left_pct} % are left"


@pytest.mark.parametrize(
    ("state", "low", "critical"),
    [
        (ChargeState.UNDEFINED, 0, 0),
        (ChargeState.OK, 0, 0),
        (ChargeState.LOW, 1, 0),
        (ChargeState.CRITICAL, 1, 1),
        (ChargeState.EMERGENCY, 1, 1),
        (ChargeState.FAILED, 1, 1),
        (ChargeState.UNHEALTHY, 1, 0),
        (ChargeState.CHARGING, 0, 0),
        (99, 0, 0),
    ],
)
def test_what_the_vehicle_calls_low_is_low(state: int, low: int, critical: int) -> None:
    """A PX4 with BAT_LOW_THR of 0.7 says LOW at 70 % (recorded: G1b_battery_levels)."""
    script = Script()
    script.hear(battery(70, state=state))
    assert (Condition.BATTERY_LOW in script.told) is bool(low)
    assert (Condition.BATTERY_CRITICAL in script.told) is bool(critical)
    if state == ChargeState.CRITICAL:
        assert script.told[Condition.BATTERY_CRITICAL] == "the vehicle says that it is critical"


def test_a_charged_battery_is_no_longer_low() -> None:
    script = Script()
    script.hear(battery(5))
    script.hear(battery(90))
    assert script.told == {}


@pytest.mark.parametrize("tell", [system, battery])
def test_at_its_limit_it_is_low_once_and_not_again_and_again(tell: type[Message]) -> None:
    """The share goes up and down by a per cent or two as the load does."""
    script = Script()
    for left_pct in (15, 16, 15, 16, 14, 16):
        script.hear(tell(left_pct))
        assert Condition.BATTERY_LOW in script.told
    script.hear(tell(17))
    assert script.told == {}
    script.hear(tell(16))
    assert script.told == {}


def test_a_full_battery_is_not_low_whatever_the_limit() -> None:
    script = Script(parse_policy("[battery]\nlow_pct = 99.5", "my.toml"))
    script.hear(system(99))
    assert Condition.BATTERY_LOW in script.told
    script.hear(system(100))
    assert script.told == {}


def test_of_several_batteries_the_worst_counts_and_a_camera_s_does_not() -> None:
    script = Script()
    script.hear(battery(10, number=1))
    script.hear(battery(80, number=0))
    assert Condition.BATTERY_LOW in script.told
    script = Script()
    script.hear(battery(5, number=2, function=3))
    assert script.told == {}


VOLTS = parse_policy("[battery]\nlow_v = 14.0\ncritical_v = 13.0", "my.toml")


def test_a_voltage_counts_after_five_seconds() -> None:
    script = Script(VOLTS)
    script.hear(system(80, 13_900))
    script.seconds(4)
    script.hear(system(80, 13_900))
    assert Condition.BATTERY_LOW not in script.told
    script.seconds(1)
    script.hear(system(80, 13_900))
    assert script.told[Condition.BATTERY_LOW] == "13.9 V"
    assert Condition.BATTERY_CRITICAL not in script.told
    script.hear(system(80, 14_200))
    assert Condition.BATTERY_LOW in script.told
    script.hear(system(80, 14_300))
    assert script.told == {}


def test_a_sag_of_a_moment_starts_the_five_seconds_anew() -> None:
    script = Script(VOLTS)
    for mv in (12_000, 15_000, 12_000):
        script.hear(system(80, mv))
        script.seconds(4)
    script.hear(system(80, 12_000))
    assert Condition.BATTERY_CRITICAL not in script.told
    script.seconds(1)
    script.hear(system(80, 12_000))
    assert script.told[Condition.BATTERY_CRITICAL] == "12.0 V"


def test_the_voltage_of_cells_is_added_up_and_what_is_not_known_is_not_low() -> None:
    script = Script(VOLTS)
    for message in (battery(mv=(3_600,) * 4), battery(mv=()), system(80, 65_535), system(80, 0)):
        script.hear(message)
        script.seconds(6)
        script.hear(message)
        assert script.told == {}, message
    script.hear(battery(mv=(3_400,) * 4))
    script.seconds(6)
    script.hear(battery(mv=(3_400,) * 4))
    assert script.told[Condition.BATTERY_LOW] == "13.6 V"


# ---------------------------------------------------------------------------------- link


def test_a_link_that_loses_a_third_of_the_frames_is_poor_until_it_loses_less_than_half_that() -> (
    None
):
    script = Script()
    script.seconds(6, came=80, lost=20)
    assert script.told == {}
    script.seconds(5, came=60, lost=40)
    assert script.told[Condition.LINK_POOR] == "40 % of the vehicle's frames are lost"
    script.seconds(5, came=80, lost=20)
    assert Condition.LINK_POOR in script.told, "20 % is more than half of 30 %"
    script.seconds(5, came=95, lost=5)
    assert script.told == {}


def test_a_few_frames_tell_no_share() -> None:
    script = Script()
    script.seconds(10, came=1, lost=2)
    assert script.told == {}


def test_late_frames_that_take_their_loss_back_are_no_gain() -> None:
    script = Script()
    script.seconds(6, came=50, lost=50)
    script.losses.senders[1, 1].lost = 0
    script.seconds(5)
    assert script.told == {}


def radio(rssi: int, noise: int, remrssi: int, remnoise: int) -> RadioStatus:
    return RadioStatus(0, 0, rssi, remrssi, 100, noise, remnoise)


def test_a_radio_that_is_hardly_above_its_noise_at_either_end_is_poor() -> None:
    script = Script()
    script.radio(radio(190, 50, 180, 60))
    assert script.told == {}
    script.radio(radio(190, 50, 68, 60))
    assert script.told[Condition.LINK_POOR] == "the radio's signal is 4 dB above its noise"
    script.radio(radio(190, 50, 73, 60))
    assert Condition.LINK_POOR in script.told, "7 dB is not well above 6 dB"
    script.radio(radio(190, 50, 80, 60))
    assert script.told == {}


def test_what_a_radio_does_not_know_is_not_bad_and_one_that_is_silent_is_forgotten() -> None:
    script = Script()
    script.radio(radio(255, 50, 255, 60))
    script.radio(radio(0, 0, 0, 0))
    assert script.told == {}
    script.radio(radio(50, 50, 50, 50))
    assert Condition.LINK_POOR in script.told
    script.seconds(6)
    assert script.told == {}


# ----------------------------------------------------------------------------------- GPS


def gps(satellites: int = 10, eph: int = 121, h_acc_mm: int = 300, fix_type: int = 3) -> GpsRawInt:
    """ArduCopter 4.7's as recorded: eph 121, 10 satellites, 300 mm."""
    return GpsRawInt(
        0, 473977420, 85455940, 488_000, eph, 200, 0, 0, fix_type, satellites, h_acc=h_acc_mm
    )


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (gps(satellites=5), "5 satellites, 6 are wanted"),
        (gps(eph=260), "HDOP 2.6, 2.5 is allowed"),
        (gps(h_acc_mm=12_000), "accurate to 12 m, 5 m is allowed"),
        (gps(4, 500), "4 satellites, 6 are wanted, HDOP 5.0, 2.5 is allowed"),
    ],
)
def test_a_poor_fix_is_a_condition_after_two_reports_and_over_after_two(
    message: GpsRawInt, words: str
) -> None:
    script = Script()
    script.hear(message)
    assert script.told == {}
    script.hear(message)
    assert script.told == {Condition.GPS_POOR: words}
    script.hear(gps())
    assert Condition.GPS_POOR in script.told
    script.hear(gps())
    assert script.told == {}


@pytest.mark.parametrize(
    "message",
    [
        gps(),
        gps(10, 70, 900),  # PX4 1.14.3's as recorded
        gps(255, 65535, 0),  # not known
        gps(6, 250, 5_000),
        gps(0, 9_999, 99_000, fix_type=1),  # without a fix it is lost, not poor
    ],
)
def test_what_is_not_poor(message: GpsRawInt) -> None:
    script = Script()
    for _ in range(3):
        script.hear(message)
    assert script.told == {}


# -------------------------------------------------------------------------- its own fence


def test_a_breach_of_the_vehicle_s_own_fence_is_a_condition() -> None:
    """Recorded of ArduCopter 4.7: breach 1 type 3 count 1, then breach 0 type 0 count 1."""
    script = Script()
    script.hear(FenceStatus(1000, 1, 1, 3))
    assert script.told[Condition.VEHICLE_FENCE_BREACHED] == (
        "the vehicle breaches its own fence: it is outside its boundary"
    )
    script.hear(FenceStatus(1000, 1, 0, 0))
    assert script.told == {}
    script.hear(FenceStatus(1000, 1, 1, 77))
    assert Condition.VEHICLE_FENCE_BREACHED in script.told


@given(
    left_pct=st.integers(-128, 127),
    state=st.integers(0, 255),
    cells=st.lists(st.integers(0, 65535), min_size=10, max_size=10),
    satellites=st.integers(0, 255),
    eph=st.integers(0, 65535),
    levels=st.tuples(*[st.integers(0, 255)] * 4),
)
def test_whatever_comes_is_judged(
    left_pct: int,
    state: int,
    cells: list[int],
    satellites: int,
    eph: int,
    levels: tuple[int, int, int, int],
) -> None:
    script = Script(VOLTS)
    for _ in range(2):
        script.hear(battery(left_pct, tuple(cells), state))
        script.hear(gps(satellites, eph))
        script.radio(radio(*levels))
        script.seconds(6)
    assert all(words for words in script.told.values())
