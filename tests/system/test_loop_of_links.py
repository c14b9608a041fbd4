"""Two bridges that send to one another: real programs, real sockets, one vehicle."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from tests.system.patience import PATIENT_POLICY, until
from tests.system.programs import Running
from tests.system.test_bridge_cli import Client, bridge, ended, of_vehicle
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

MOST_HZ = 1000.0
"""A vehicle sends some 250 messages a second; a loop makes many thousands of them."""
ACCEPTED = 0


def rates_hz(program: Running) -> list[float]:
    """Of the messages on its vehicle link, once a second."""
    events = [json.loads(line) for line in [*program.out] if '"type":"bridge"' in line]
    return [link["rx_hz"] for event in events for link in event["links"]]


def told(program: Running, text: str) -> bool:
    return any(text in line for line in [*program.out, *program.err])


@pytest.mark.parametrize("second_sysid", [250, 255])
def test_a_loop_of_two_bridges_ends_and_a_client_behind_the_second_one_arms(
    tmp_path: Path, second_sysid: int
) -> None:
    first_port, second_port, client_port = (free_port() for _ in range(3))
    ports = [f"127.0.0.1:{each}" for each in (first_port, second_port)]
    first = ("--vehicle", f"udpin://{ports[0]}", "--client", f"udpout://{ports[1]}")
    second = ("--vehicle", f"udpin://{ports[1]}", "--client", f"udpout://{ports[0]}")
    behind = ("--client", f"udpin://127.0.0.1:{client_port}", "--sysid", str(second_sysid))
    both = ("--policy", PATIENT_POLICY, "--json")
    with (
        vehicle_sim("--link", f"udpout://{ports[0]}"),
        bridge(tmp_path, *first, *both) as one,
        bridge(tmp_path, *second, *both, *behind) as other,
    ):
        until(lambda: told(one, "is left out, until it has been silent"), "the end of the loop")
        assert told(one, "a loop of links: what is sent to udp")
        assert not told(one, "the loop of links goes on")
        seen = [len(rates_hz(each)) for each in (one, other)]
        until(lambda: len(rates_hz(one)) >= seen[0] + 6, "six seconds of the first one's")
        until(lambda: len(rates_hz(other)) >= seen[1] + 6, "six seconds of the second one's")
        for each, number in zip((one, other), seen, strict=True):
            later = rates_hz(each)[number + 2 :]
            assert 0.0 < max(later) < MOST_HZ, later
        client = Client(f"udpout:127.0.0.1:{client_port}", 245)
        client.until("HEARTBEAT", of_vehicle)
        if second_sysid != 255:
            client.send(dialect.MAVLink_command_long_message(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0))
            answer = client.until("COMMAND_ACK", lambda ack: ack.command == 400)
            assert answer.result == ACCEPTED
        client.close()
        assert ended(other) == ExitCode.DONE
        assert ended(one) == ExitCode.DONE
