"""Plain pymavlink scripts fly both personalities."""

from __future__ import annotations

import itertools
import math
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol

import pytest
from pymavlink import mavutil

from tests.system.patience import PATIENT_S, hold_much
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

ARMED = 128
POSITION_AND_YAW = 2552
GUIDED = 4
OFFBOARD_MAIN = 6
ON_GROUND = 1


PATIENT = ("--param", "COM_OF_LOSS_T=60")
"""A script that the machine stops for a second is not one that has gone."""


class Message(Protocol):
    """What is read of pymavlink's messages here."""

    x: float
    y: float
    z: float
    command: int
    result: int
    base_mode: int
    custom_mode: int
    landed_state: int
    relative_alt: int

    def get_type(self) -> str: ...


class Pilot:
    """A script's link: reads in the script's own loop, streams a goal at 20 Hz meanwhile."""

    def __init__(self, url: str) -> None:
        self.link = mavutil.mavlink_connection(url, source_system=255, source_component=190)
        hold_much(self.link.port)
        assert self.link.wait_heartbeat(timeout=PATIENT_S) is not None
        self.latest: dict[str, Message] = {}
        self.goal_ned: tuple[float, float, float] | None = None
        self._sent_s = 0.0
        self._beat_s = 0.0

    def until(self, condition: Callable[[], bool], what: str, timeout_s: float = PATIENT_S) -> None:
        end = time.monotonic() + timeout_s
        while not condition():
            now = time.monotonic()
            assert now < end, f"not within {timeout_s:g} s: {what}"
            if now - self._beat_s >= 1.0:
                self._beat_s = now
                self.link.mav.heartbeat_send(6, 8, 0, 0, 4)
            if self.goal_ned is not None and now - self._sent_s >= 0.05:
                self._sent_s = now
                self.stream(self.goal_ned)
            message = self.link.recv_match(blocking=True, timeout=0.02)
            if message is not None:
                self.latest[message.get_type()] = message

    def stream(self, goal_ned: tuple[float, float, float]) -> None:
        self.link.mav.set_position_target_local_ned_send(
            0, 1, 1, 1, POSITION_AND_YAW, *goal_ned, 0, 0, 0, 0, 0, 0, 0, 0
        )

    def ask(self, command: int, *params: float) -> None:
        """Sends the command once a second until it is accepted."""
        p = (*params, *(0.0,) * (7 - len(params)))
        asks_s = itertools.count(time.monotonic(), 1.0)
        next_s = next(asks_s)
        self.latest.pop("COMMAND_ACK", None)

        def accepted() -> bool:
            nonlocal next_s
            if time.monotonic() >= next_s:
                self.link.mav.command_long_send(1, 1, command, 0, *p)
                next_s = next(asks_s)
            ack = self.latest.get("COMMAND_ACK")
            return ack is not None and (ack.command, ack.result) == (command, 0)

        self.until(accepted, f"an acceptance of {command}")

    def seen(self, kind: str, condition: Callable[[Message], bool]) -> Callable[[], bool]:
        return lambda: kind in self.latest and condition(self.latest[kind])

    def armed(self) -> bool:
        return bool(self.latest["HEARTBEAT"].base_mode & ARMED)

    def at(self, goal_ned: tuple[float, float, float]) -> bool:
        here = self.latest["LOCAL_POSITION_NED"]
        return math.dist((here.x, here.y, here.z), goal_ned) < 0.5

    def fly_to(self, goal_ned: tuple[float, float, float]) -> None:
        self.goal_ned = goal_ned
        self.until(lambda: self.at(goal_ned), f"at {goal_ned}")

    def land_and_disarm(self) -> None:
        self.goal_ned = None
        self.ask(mavutil.mavlink.MAV_CMD_NAV_LAND)
        landed = self.seen("EXTENDED_SYS_STATE", lambda state: state.landed_state == ON_GROUND)
        self.until(landed, "on the ground")
        self.until(lambda: not self.armed(), "disarmed")


@contextmanager
def pilot(url: str) -> Iterator[Pilot]:
    flier = Pilot(url)
    try:
        yield flier
    finally:
        flier.link.close()


def test_a_script_flies_px4_offboard() -> None:
    port = free_port()
    with (
        vehicle_sim("--speedup", "4", *PATIENT, "--link", f"udpout://127.0.0.1:{port}"),
        pilot(f"udpin:127.0.0.1:{port}") as script,
    ):
        script.until(lambda: "LOCAL_POSITION_NED" in script.latest, "a position")
        script.ask(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
        script.until(script.seen("HEARTBEAT", lambda _: script.armed()), "armed")
        script.ask(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, *(math.nan,) * 4)
        climbed = script.seen("GLOBAL_POSITION_INT", lambda p: p.relative_alt > 1500)
        script.until(climbed, "1.5 m up")
        loitering = script.seen("HEARTBEAT", lambda beat: beat.custom_mode >> 24 == 3)
        script.until(loitering, "taken off")
        script.goal_ned = (4.0, 0.0, -4.0)
        script.ask(mavutil.mavlink.MAV_CMD_DO_SET_MODE, 1, OFFBOARD_MAIN)
        script.fly_to((4.0, 0.0, -4.0))
        script.fly_to((4.0, 4.0, -3.0))
        script.land_and_disarm()


@pytest.mark.thorough
def test_a_script_flies_ardupilot_guided_over_tcp() -> None:
    port = free_port(socket.SOCK_STREAM)
    with (
        vehicle_sim(
            "--autopilot", "ardupilot", "--speedup", "4", "--link", f"tcpin://127.0.0.1:{port}"
        ) as lines,
    ):
        _wait_for_listener(lines)
        with pilot(f"tcp:127.0.0.1:{port}") as script:
            script.link.mav.request_data_stream_send(1, 1, 0, 10, 1)
            script.ask(mavutil.mavlink.MAV_CMD_DO_SET_MODE, 1, GUIDED)
            script.ask(mavutil.mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
            script.until(script.seen("HEARTBEAT", lambda _: script.armed()), "armed")
            script.ask(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 3)
            climbed = script.seen("GLOBAL_POSITION_INT", lambda p: p.relative_alt > 2800)
            script.until(climbed, "3 m up")
            script.fly_to((4.0, 0.0, -4.0))
            script.fly_to((4.0, 4.0, -3.0))
            script.land_and_disarm()


def _wait_for_listener(lines: list[str]) -> None:
    told = threading.Event()
    for _ in range(200):
        if any("listens on TCP" in line for line in lines):
            return
        told.wait(0.05)
    pytest.fail("it does not say that it listens")
