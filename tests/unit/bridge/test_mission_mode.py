"""The mode of a mission and armings on one vehicle: one waits for the other."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs import ipc
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import ClientRequest, ForwardToVehicle
from gcs.bridge.mission_mode import LATE_NS, NOT_SHOWN, RECENT_NS, SHOWN_NS, MissionMode
from gcs.bridge.peers.client import Client, Exchange
from gcs.bridge.translate.chosen_before_arming import KEPT_NS
from gcs.bridge.translate.says import ask
from gcs.protocol.autopilot import PX4
from gcs.protocol.effects import Address
from gcs.protocol.transfers.transfer import SPEC_TIMING
from gcs.wire.ids import Cmd
from tests.unit.bridge.test_bridge import HEARTBEAT, VEHICLE, Table, of
from tests.unit.bridge.vehicles import standing

NOW_NS = 5_000_000_000
BY = From(1, Address(245, 190), Address(1, 1))


def test_an_arming_waits_until_the_mode_is_shown() -> None:
    mode = MissionMode()
    assert mode.why_not_arm() is None
    mode.sent(NOW_NS)
    assert mode.why_not_arm() is NOT_SHOWN
    mode.shown("AUTO.LOITER", NOW_NS + SHOWN_NS - 1)
    assert mode.why_not_arm() is NOT_SHOWN
    mode.shown("AUTO.MISSION", NOW_NS + SHOWN_NS - 1)
    assert mode.why_not_arm() is None


def test_or_until_a_late_heartbeat_shows_that_it_was_not_taken() -> None:
    mode = MissionMode()
    mode.sent(NOW_NS)
    mode.shown("AUTO.LOITER", NOW_NS + SHOWN_NS)
    assert mode.why_not_arm() is None


def heard() -> MissionMode:
    mode = MissionMode()
    mode.shown("AUTO.LOITER", NOW_NS)
    return mode


def test_the_mode_waits_while_an_arming_may_come_late() -> None:
    mode = heard()
    assert mode.may_be_sent(NOW_NS)
    mode.arm_sent(NOW_NS)
    assert not mode.may_be_sent(NOW_NS)
    mode.arm_ended()
    assert mode.may_be_sent(NOW_NS)


def test_of_an_arming_that_nobody_refused_a_late_heartbeat_tells() -> None:
    mode = MissionMode()
    mode.arm_sent(NOW_NS)
    mode.shown("AUTO.LOITER", NOW_NS + LATE_NS - 1)
    assert not mode.may_be_sent(NOW_NS + LATE_NS - 1)
    mode.shown("AUTO.LOITER", NOW_NS + LATE_NS)
    assert mode.may_be_sent(NOW_NS + LATE_NS)


def test_the_mode_goes_out_only_after_a_young_heartbeat() -> None:
    assert not MissionMode().may_be_sent(NOW_NS)
    assert heard().may_be_sent(NOW_NS + RECENT_NS)
    assert not heard().may_be_sent(NOW_NS + RECENT_NS + 1)


def test_of_an_armed_vehicle_the_mode_may_have_come_late() -> None:
    mode = heard()
    assert not mode.may_have_come_late()
    mode.sent(NOW_NS)
    assert mode.may_have_come_late()
    mode.arm_sent(NOW_NS)
    assert not mode.may_have_come_late(), "this station's own arming"
    mode.arm_ended()
    mode.shown("AUTO.MISSION", NOW_NS)
    assert not mode.may_have_come_late()


# --------------------------------------------------------- where no start of the mission follows


def chosen() -> Exchange:
    """A client has set the mode on vehicle 1 at `NOW_NS`."""
    client = Client(1, "udp", SPEC_TIMING, 500_000_000)
    client.begin(1000)
    exchange = client.at(1)
    seen = standing(PX4, mission_items=3)
    assert exchange.chooses_mission(ask("mission_start"), seen, BY, NOW_NS)
    return exchange


AUTO, MISSION = 4, 4
ENABLED = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
ARMED_TOO = ENABLED | mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def old_set_mode(flags: int) -> Any:
    return mavlink.MAVLink_set_mode_message(1, flags, AUTO << 16 | MISSION << 24)


def do_set_mode(flags: float) -> Any:
    params = (flags, AUTO, MISSION, 0, 0, 0, 0)
    return mavlink.MAVLink_command_long_message(1, 1, Cmd.DO_SET_MODE, 0, *params)


@pytest.mark.parametrize(
    ("message", "sent_on"),
    [
        (old_set_mode(ENABLED), True),
        (do_set_mode(ENABLED), True),
        (old_set_mode(ARMED_TOO), False),
        (do_set_mode(ARMED_TOO), False),
    ],
    ids=["SET_MODE", "DO_SET_MODE", "SET_MODE that arms", "DO_SET_MODE that arms"],
)
def test_a_mode_is_sent_on_only_where_it_does_not_arm_too(message: Any, sent_on: bool) -> None:
    """Nobody has judged an arming that comes with a mode: it is asked of the gate instead."""
    table = Table(seen=standing(PX4, mission_items=3))
    table.says(HEARTBEAT)
    table.bridge.armings.shown("AUTO.LOITER", VEHICLE.sysid, table.now_ns, armed=False)
    judged = table.says(message)
    assert bool(of(ForwardToVehicle, judged.effects)) is sent_on
    asked = [each.command.word for each in of(ClientRequest, judged.effects)]
    assert asked == ([] if sent_on else ["mission_start"])


def due_ns(exchange: Exchange) -> int | None:
    return exchange.chosen_until_ns


def holds(exchange: Exchange, now_ns: int) -> list[ipc.Command]:
    return [done.command for done in exchange.wake(now_ns) if isinstance(done, ClientRequest)]


def test_the_mode_is_taken_back_once() -> None:
    exchange = chosen()
    assert due_ns(exchange) == NOW_NS + KEPT_NS
    assert holds(exchange, NOW_NS + KEPT_NS) == [ipc.Ask(1, "hold", vehicle=1)]
    assert due_ns(exchange) is None
    assert exchange.take_mode_back() == []


def test_not_out_of_an_arming_but_after_one_that_is_refused() -> None:
    exchange = chosen()
    both, _ = exchange.joined_with_choice(ask("arm"), standing(PX4), NOW_NS + KEPT_NS // 2)
    assert both != ask("arm")
    assert holds(exchange, NOW_NS + KEPT_NS) == []
    exchange.keep_mode_for_now(NOW_NS + KEPT_NS)  # somebody else's
    assert due_ns(exchange) == NOW_NS + 2 * KEPT_NS
    assert len(holds(exchange, NOW_NS + 2 * KEPT_NS)) == 1


def test_armings_that_are_refused_again_and_again_do_not_keep_the_mode() -> None:
    exchange = chosen()
    exchange.joined_with_choice(ask("arm"), standing(PX4), NOW_NS)
    for seconds in (5, 10, 15):
        exchange.keep_mode_for_now(NOW_NS + seconds * 1_000_000_000)
    assert due_ns(exchange) == NOW_NS + 2 * KEPT_NS
    assert len(holds(exchange, NOW_NS + 2 * KEPT_NS)) == 1


def test_not_from_a_vehicle_that_is_armed() -> None:
    exchange = chosen()
    exchange.joined_with_choice(ask("arm"), standing(PX4), NOW_NS)
    exchange.keep_mode()
    assert due_ns(exchange) is None
