"""A script of pymavlink, unaltered library and all, on the link of a bridged flight.

`VirtualLink` is what `mavutil.mavlink_connection` makes, but for its two ends: bytes come from and
go to the bridge under test, and waiting lets the flight's clock go on.  It does
what most scripts do: `mavwp` holds the plan, `waypoint_clear_all_send`, `waypoint_count_send`, an
item for each question, `arducopter_arm`, `set_mode_auto`.
"""

from __future__ import annotations

from typing import Any

from pymavlink import mavutil, mavwp

from gcs.session import inputs
from tests.loopback.bridged import VEHICLE, BridgedFlight
from tests.loopback.plan_clients import MISSION, NO_PLACE, PlanItem

SYSID, COMPID = 245, 190
LINK = 1
BEAT_S = 1.0
ACCEPTED = 0


class NoAnswerError(AssertionError):
    """What it waited for did not come."""


class VirtualLink(mavutil.mavfile):  # type: ignore[misc]
    """A connection of pymavlink to the bridge."""

    def __init__(self, flight: BridgedFlight) -> None:
        self.flight = flight
        self.waiting = bytearray()
        self.deaf = False
        """It reads no more: what comes is dropped."""
        self.next_beat_s = self.patient_until_s = 0.0
        mavutil.mavfile.__init__(
            self, None, "virtual", source_system=SYSID, source_component=COMPID
        )
        self.mav.robust_parsing = True

    # ------------------------------------------------------------------ what mavfile asks for

    def recv(self, n: int | None = None) -> bytes:
        taken = bytes(self.waiting if n is None else self.waiting[:n])
        del self.waiting[: len(taken)]
        return taken

    def write(self, buf: bytes) -> None:
        self.flight.feed(inputs.Datagram(LINK, bytes(buf)))

    def select(self, timeout: float) -> bool:
        """Time passes; a heartbeat a second, as scripts send it from a thread."""
        if self.flight.elapsed_s >= self.patient_until_s:
            raise NoAnswerError(self.flight.told())
        self.beat()
        self.flight.run(timeout)
        return bool(self.waiting)

    # ------------------------------------------------------------------------ what it does

    def beat(self) -> None:
        if self.flight.elapsed_s >= self.next_beat_s:
            self.mav.heartbeat_send(6, 8, 0, 0, 4)
            self.next_beat_s = self.flight.elapsed_s + BEAT_S

    def hear(self, data: bytes) -> None:
        """From the bridge."""
        if not self.deaf:
            self.waiting += data

    def wait(self, *names: str, within_s: float = 30.0) -> Any:
        """`recv_match`, bounded by the flight's clock."""
        self.patient_until_s = self.flight.elapsed_s + within_s
        return self.recv_match(type=list(names), blocking=True)

    def acknowledged(self, command: int, within_s: float = 30.0) -> int:
        """The result of a COMMAND_ACK of that command; IN_PROGRESS is none."""
        while True:
            ack = self.wait("COMMAND_ACK", within_s=within_s)
            if ack.command == command and ack.result != mavutil.mavlink.MAV_RESULT_IN_PROGRESS:
                return int(ack.result)

    def plan_ack(self, kind: int, within_s: float = 60.0) -> int:
        while True:
            ack = self.wait("MISSION_ACK", within_s=within_s)
            if getattr(ack, "mission_type", MISSION) == kind:
                return int(ack.type)

    def upload(self, items: list[PlanItem]) -> int:
        """MAV_MISSION_RESULT of the whole."""
        kind = items[0].kind
        loader = (
            mavwp.MAVWPLoader(*VEHICLE)
            if kind == MISSION
            else mavwp.MissionItemProtocol_Rally(*VEHICLE)
        )
        for item in items:
            loader.add(_item_int(item))
        if kind == MISSION:
            self.waypoint_clear_all_send()
            cleared = self.plan_ack(kind)
            if cleared != ACCEPTED:
                return cleared
            self.waypoint_count_send(loader.count())
        else:
            self.mav.mission_count_send(*VEHICLE, loader.count(), kind)
        while True:
            told = self.wait("MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK", within_s=60.0)
            if getattr(told, "mission_type", MISSION) != kind:
                continue
            if told.get_type() == "MISSION_ACK":
                return int(told.type)
            self.mav.send(loader.wp(told.seq))

    def arm(self) -> int:
        self.arducopter_arm()
        return self.acknowledged(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM)

    def start_mission(self) -> int:
        self.set_mode_auto()
        return self.acknowledged(mavutil.mavlink.MAV_CMD_MISSION_START)


def _item_int(item: PlanItem) -> Any:
    """Its MISSION_ITEM_INT; the loader numbers it."""
    scale = 1.0 if item.frame == NO_PLACE else 1e7
    place = (round(item.lat_deg * scale), round(item.lon_deg * scale), item.alt_m)
    head = (*VEHICLE, 0, item.frame, item.command, 0, 1, *item.params)
    return mavutil.mavlink.MAVLink_mission_item_int_message(*head, *place, item.kind)


class ScriptFlight(BridgedFlight):
    """A bridged flight whose only client is a script of pymavlink, once it has `join_script`."""

    script: VirtualLink

    def join_script(self) -> VirtualLink:
        self.feed(inputs.ClientCame(LINK, "udp 127.0.0.1:40001", stream=False))
        self.script = VirtualLink(self)
        self.script.wait("HEARTBEAT")
        return self.script

    def to_client(self, link: int, data: bytes) -> None:
        self.script.hear(data)
