"""Clients that a vehicle does not hear are told so, once."""

from __future__ import annotations

from gcs.bridge.bridge import Bridge
from gcs.bridge.effects import BridgeEffect, LogLine, Reply
from gcs.gate.policy.parse import parse_policy
from gcs.protocol.effects import Address
from gcs.protocol.enforced_sysid import Hears
from gcs.protocol.transfers.transfer import SPEC_TIMING
from tests.unit.bridge.test_bridge import HEARTBEAT, OWN, VEHICLE, S, frame_of, of, texts

ALONE = Hears(7, 7, "SYSID_ENFORCE")
"""The clients here are system 245."""


def bridge_with(*links: int) -> Bridge:
    rules = parse_policy("", "my.toml").bridge
    bridge = Bridge(OWN, rules, {}, 10 * S, SPEC_TIMING, S // 2)
    for link in links:
        bridge.came(link, f"udp {link}")
        bridge.from_client(link, frame_of(HEARTBEAT), [VEHICLE], lambda _: None, S)
    return bridge


def links_told(effects: list[BridgeEffect]) -> set[int]:
    return {each.link for each in of(Reply, effects)}


def test_each_client_is_told_once_in_the_vehicles_name_and_in_the_log() -> None:
    bridge = bridge_with(1, 2)
    effects = bridge.hears_alone(VEHICLE, ALONE)
    assert links_told(effects) == {1, 2}
    assert {each.source for each in of(Reply, effects)} == {VEHICLE}
    assert "vehicle 1 hears system 7 alone (SYSID_ENFORCE), not 245" in texts(effects)
    assert [note.text.split(":")[0] for note in of(LogLine, effects)] == [
        f"udp {link} is system 245, and vehicle 1 hears system 7 alone (SYSID_ENFORCE)"
        for link in (1, 2)
    ]
    assert bridge.hears_alone(VEHICLE, ALONE) == []


def test_who_is_heard_is_told_nothing() -> None:
    assert bridge_with(1).hears_alone(VEHICLE, Hears(245, 255, "MAV_OPTIONS")) == []


def test_who_comes_later_on_the_same_link_is_told_again() -> None:
    bridge = bridge_with(1)
    bridge.hears_alone(VEHICLE, ALONE)
    bridge.gone(1, "closed")
    bridge.came(1, "udp 1")
    assert bridge.hears_alone(VEHICLE, ALONE) == [], "it has said nothing yet"
    bridge.from_client(1, frame_of(HEARTBEAT), [VEHICLE], lambda _: None, 2 * S)
    assert links_told(bridge.hears_alone(VEHICLE, ALONE)) == {1}


def test_another_vehicle_or_another_number_is_news() -> None:
    bridge = bridge_with(1)
    bridge.hears_alone(VEHICLE, ALONE)
    assert bridge.hears_alone(Address(2, 1), ALONE) != []
    assert "system 8 alone" in texts(bridge.hears_alone(VEHICLE, Hears(8, 8, "SYSID_ENFORCE")))
