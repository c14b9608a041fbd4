"""Commands and messages that change a vehicle's set-up, by the policy's `[bridge]`."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.bridge.catalog.row import Kind
from gcs.bridge.catalog.tables import command_rows, message_rows
from gcs.bridge.setup_policy.commands import ROWS
from gcs.bridge.setup_policy.guard import Guard
from gcs.bridge.setup_policy.verdict import Allowed, GuardSeen, Refused
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.codec import decode, encode
from gcs.wire.frame import Frame
from gcs.wire.ids import MissionResult
from gcs.wire.messages import CLASSES, Message, MissionAck
from tests.unit.bridge.setup_policy.wire import (
    CLIENT,
    FLYING,
    PARKED,
    VEHICLE,
    allowed,
    command,
    guard,
    refused,
    sent,
)

UNKNOWN = GuardSeen(CLIENT, VEHICLE, armed=None, on_ground=True)
STARTED = GuardSeen(CLIENT, VEHICLE, armed=True, on_ground=True)

SET_HOME = sent("set_home_position", 1, 473977420, 85455940, 488000, 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)
SET_ORIGIN = sent("set_gps_global_origin", 1, 473977420, 85455940, 488000)
SETUP_SIGNING = sent("setup_signing", 1, 1, [7] * 32, 1)
FENCE_POINT = sent("fence_point", 1, 1, 0, 4, 47.0, 8.0)
RALLY_POINT = sent("rally_point", 1, 1, 0, 1, 473977420, 85455940, 20, 0, 0, 0)
RTCM = sent("gps_rtcm_data", 0, 3, [1] * 180)


def count(plan: int) -> Message:
    return sent("mission_count", 1, 1, 4, plan)


def clear(plan: int) -> Message:
    return sent("mission_clear_all", 1, 1, plan)


# MAV_CMD's numbers are those of https://mavlink.io/en/messages/common.html.
DO_SET_HOME, TERMINATION, FENCE_ENABLE = 179, 185, 207
CALIBRATION, STORAGE, REBOOT, INJECT_FAILURE = 241, 245, 246, 420

BY_POLICY = [
    ("home", command(DO_SET_HOME)),
    ("home", SET_HOME),
    ("origin", SET_ORIGIN),
    ("origin", command(611)),
    ("signing", SETUP_SIGNING),
    ("termination", command(TERMINATION, 1.0)),
    ("termination", command(TERMINATION, 0.0)),
    ("fence", command(FENCE_ENABLE, 0.0)),
    ("fence", command(FENCE_ENABLE, 1.0)),
    ("fence", FENCE_POINT),
    ("fence", count(1)),
    ("fence", clear(1)),
    ("rally", RALLY_POINT),
    ("rally", count(2)),
    ("rally", clear(2)),
    ("rtcm", RTCM),
]


@pytest.mark.parametrize(("key", "message"), BY_POLICY)
def test_the_default_refuses_it_in_the_air_and_on_the_ground(key: str, message: Message) -> None:
    for seen in (FLYING, PARKED):
        found = refused(guard().judge(message, seen))
        assert found.refusal.code is Code.POLICY
        assert f"bridge.{key}" in found.refusal.sentence


@pytest.mark.parametrize(("key", "message"), BY_POLICY)
def test_the_policy_may_forward_it(key: str, message: Message) -> None:
    note = allowed(guard(f'{key} = "forward"').judge(message, FLYING)).note
    assert note or key == "rtcm", "five corrections a second are no news"


ON_GROUND = [
    ("home", command(DO_SET_HOME)),
    ("origin", SET_ORIGIN),
    ("calibration", command(CALIBRATION, 1.0)),
    ("calibration", command(42424)),
    ("reboot", command(REBOOT, 1.0)),
]


@pytest.mark.parametrize(("key", "message"), ON_GROUND)
def test_on_ground_is_disarmed_and_on_the_ground(key: str, message: Message) -> None:
    own = guard(f'{key} = "on_ground"')
    allowed(own.judge(message, PARKED))
    for seen in (FLYING, STARTED, UNKNOWN, GuardSeen(CLIENT, VEHICLE, False, on_ground=False)):
        found = refused(own.judge(message, seen))
        assert found.refusal.code is Code.IN_AIR


def test_the_default_calibrates_on_the_ground_and_never_reboots() -> None:
    allowed(guard().judge(command(CALIBRATION, 1.0), PARKED))
    refused(guard().judge(command(REBOOT, 1.0), PARKED))


@pytest.mark.parametrize("param1", [0.0, 1.0])
def test_saving_and_loading_parameters_changes_none(param1: float) -> None:
    allowed(guard().judge(command(STORAGE, param1), FLYING))


@pytest.mark.parametrize(
    "params",
    [(2.0,), (3.0,), (4.0,), (1.5,), (math.nan,), (0.0, 2.0), (1.0, 2.0), (0.0, 0.0, 1.0)],
)
def test_setting_parameters_or_the_mission_back_is_writing_all_of_them(
    params: tuple[float, ...],
) -> None:
    refused(guard().judge(command(STORAGE, *params), PARKED))
    own = guard('parameters = "forward"')
    allowed(own.judge(command(STORAGE, *params), PARKED))
    refused(own.judge(command(STORAGE, *params), FLYING))


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("home", SET_HOME),
        ("origin", SET_ORIGIN),
        ("fence", FENCE_POINT),
        ("rally", RALLY_POINT),
        ("signing", SETUP_SIGNING),
    ],
)
def test_who_is_not_in_control_sets_nothing_up_that_the_policy_forwards(
    key: str, message: Message
) -> None:
    own = guard(f'{key} = "forward"')
    allowed(own.judge(message, PARKED))
    found = refused(own.judge(message, replace(PARKED, in_control=False)))
    assert found.refusal.code is Code.OTHER_OPERATOR


LENIENT = "\n".join(
    f'{key} = "forward"'
    for key in ("parameters", "fence", "rally", "home", "origin", "signing", "termination", "rtcm")
)


@pytest.mark.parametrize("number", [INJECT_FAILURE, 243])
def test_some_commands_no_policy_allows(number: int) -> None:
    found = refused(guard(LENIENT).judge(command(number), PARKED))
    assert found.refusal.code is Code.POLICY


def test_a_command_that_has_no_row_is_refused() -> None:
    assert refused(guard(LENIENT).judge(command(16), PARKED)).refusal.code is Code.UNSUPPORTED
    assert refused(guard(LENIENT).judge(command(64999), PARKED)).refusal.code is Code.UNSUPPORTED


def test_a_message_that_has_no_row_is_refused() -> None:
    heartbeat = sent("heartbeat", 6, 8, 0, 0, 4)
    assert refused(guard(LENIENT).judge(heartbeat, PARKED)).refusal.code is Code.UNSUPPORTED


@pytest.mark.parametrize("message", [count(1), clear(1), count(2), clear(255)])
def test_a_plan_that_is_refused_is_answered_with_a_mission_ack_of_its_type(
    message: Message,
) -> None:
    (answer,) = refused(guard().judge(message, PARKED)).answers
    assert isinstance(answer, MissionAck)
    assert (answer.target_system, answer.target_component) == (245, 190)
    assert answer.type == MissionResult.DENIED
    assert answer.mission_type == message.mission_type  # type: ignore[attr-defined]


def test_clearing_everything_needs_both() -> None:
    refused(guard('fence = "forward"').judge(clear(255), PARKED))
    refused(guard('rally = "forward"').judge(clear(255), PARKED))
    allowed(guard('fence = "forward"\nrally = "forward"').judge(clear(255), PARKED))


@pytest.mark.parametrize("rules", ["", LENIENT])
@pytest.mark.parametrize("message", [count(9), clear(7), count(255)])
def test_a_plan_of_an_unknown_type_is_not_supported(message: Message, rules: str) -> None:
    """All types at once are cleared, and never sent."""
    judged = refused(guard(rules).judge(message, PARKED))
    assert judged.refusal.code is Code.UNSUPPORTED
    (answer,) = judged.answers
    assert isinstance(answer, MissionAck)
    assert answer.type == MissionResult.UNSUPPORTED
    assert answer.mission_type == message.mission_type  # type: ignore[attr-defined]


PLANS = {"MISSION_ITEM", "MISSION_ITEM_INT"}
"""Items are judged with the whole plan that they belong to."""


def test_every_message_and_command_that_is_configuration_has_a_rule() -> None:
    for msgid, row in message_rows().items():
        if row.kind is Kind.CONFIGURATION and row.name not in PLANS:
            message = decode(
                Frame(b"", 0, CLIENT.sysid, CLIENT.compid, msgid, bytes(255), b"", True)
            )
            assert message is not None, row.name
            judgement = guard(LENIENT).judge(message, PARKED)
            if isinstance(judgement, Refused):
                assert judgement.refusal.code is not Code.UNSUPPORTED, row.name
    configuration = {n for n, row in command_rows().items() if row.kind is Kind.CONFIGURATION}
    assert configuration == set(ROWS)


def test_a_mission_is_not_the_guards() -> None:
    allowed(guard().judge(count(0), PARKED))


# ----------------------------------------------------------------------------- never raises

GUARDS = [Guard(DEFAULT.bridge, name) for name in ("px4", "ardupilot", "")]
GUARDS += [guard(LENIENT + '\nftp_writes = "forward"', name) for name in ("px4", "ardupilot")]


@given(
    own=st.sampled_from(GUARDS),
    msgid=st.sampled_from(sorted(CLASSES)),
    payload=st.binary(min_size=1, max_size=255),
    armed=st.sampled_from([None, False, True]),
    on_ground=st.booleans(),
)
def test_whatever_comes_is_judged_and_every_answer_can_be_sent(
    own: Guard, msgid: int, payload: bytes, armed: bool | None, on_ground: bool
) -> None:
    message = decode(Frame(b"", 0, CLIENT.sysid, CLIENT.compid, msgid, payload, b"", True))
    assert message is not None
    seen = GuardSeen(Address(payload[0], 190), VEHICLE, armed, on_ground)
    judgement = own.judge(message, seen)
    match judgement:
        case Refused(refusal, answers, ask_vehicle):
            assert refusal.sentence
            for each in (*answers, *ask_vehicle):
                encode(each)
        case Allowed():
            pass


@given(number=st.sampled_from(sorted(ROWS)), param1=st.floats(width=32))
def test_every_row_is_judged(number: int, param1: float) -> None:
    for own in GUARDS:
        assert own.judge(command(number, param1), FLYING)
