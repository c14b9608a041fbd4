"""`gcs mcp` as a client starts it: over its standard input and output."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import anyio
import pytest
from mcp import Client, StdioServerParameters
from mcp.types import ElicitRequestParams, ElicitResult

from tests.system.flight_log import assert_held, only_log
from tests.system.patience import PATIENT_POLICY, PATIENT_S
from tests.system.programs import GCS, gcs

pytestmark = pytest.mark.system
LEASE_S = 15.0


class Agent:
    """A client's session in mid-flight; every call is made until the station is ready for it."""

    def __init__(self, client: Client) -> None:
        self._client = client

    async def call(self, name: str, **arguments: object) -> dict[str, Any]:
        answer = (await self._client.call_tool(name, arguments)).structured_content
        assert isinstance(answer, dict)
        return answer

    async def do(self, action: str, **arguments: object) -> int:
        with anyio.fail_after(PATIENT_S):
            while True:
                answer = await self.call("check", action=action, **arguments)
                if "verdict" in answer:
                    answer = await self.call(action, verdict=answer["verdict"])
                if "operation" in answer:
                    return int(answer["operation"])
                await anyio.sleep(0.2)

    async def watch(self, operation: int) -> str:
        with anyio.fail_after(PATIENT_S):
            while True:
                answer = await self.call("renew", operation=operation)
                if answer["operation_state"] != "running":
                    return str(answer["operation_state"])
                await anyio.sleep(0.2)

    async def fly(self) -> int:
        """Arm, climb, go; the operation that is under way then."""
        for action, arguments in (("arm", {}), ("takeoff", {"up_m": 3.0})):
            assert await self.watch(await self.do(action, **arguments)) == "complete"
        return await self.do("goto", east_m=140.0, north_m=0.0, up_m=3.0)


async def allow(context: object, params: ElicitRequestParams) -> ElicitResult:
    return ElicitResult(action="accept", content={"allow": True})


def client_of(log_dir: Path) -> Client:
    words = ["mcp", "--sim", "--policy", str(PATIENT_POLICY), "--log-dir", str(log_dir)]
    server = StdioServerParameters(command=GCS, args=words)
    return Client(server, elicitation_callback=allow)


def test_when_the_client_goes_the_vehicle_is_held_and_the_record_is_whole(tmp_path: Path) -> None:
    async def session() -> None:
        async with client_of(tmp_path) as client:
            await Agent(client).fly()

    anyio.run(session)
    assert_held(only_log(tmp_path))
    audited = gcs("log", "audit", str(only_log(tmp_path)))
    assert audited.returncode == 0, audited.stdout


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="nothing is suspended so")
def test_an_agent_that_is_suspended_is_stopped_by_the_station(tmp_path: Path) -> None:
    async def session() -> None:
        async with client_of(tmp_path) as client:
            agent = Agent(client)
            operation = await agent.fly()
            words = ["pgrep", "-f", f"{GCS} mcp .* {tmp_path}"]
            found = subprocess.run(words, capture_output=True, text=True, check=True).stdout
            pid = min(map(int, found.split()))  # the station is its child
            os.kill(pid, signal.SIGSTOP)
            await anyio.sleep(LEASE_S + 2.0)
            os.kill(pid, signal.SIGCONT)
            assert await agent.watch(operation) == "aborted"
            assert (await agent.call("status"))["state"]["state"] == "HOLDING"

    anyio.run(session)


def test_without_the_package_it_says_how_to_get_it() -> None:
    code = (
        "import sys; sys.modules['mcp'] = None; from gcs.cli import main; "
        "sys.exit(main.run(['mcp', '--sim']))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, "pip install 'mavgate[mcp]'" in ended.stderr) == (2, True)
