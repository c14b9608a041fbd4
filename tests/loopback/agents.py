"""A scripted agent: the MCP client in memory, the server, the station and the vehicle, one clock.

A call is made with the library's own thread and event loop; meanwhile the flight's clock stands,
but for what an answer needs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Literal

import msgspec
from anyio.from_thread import BlockingPortal, start_blocking_portal
from mcp import Client
from mcp.types import ElicitRequestParams, ElicitResult

from gcs import ipc
from gcs.agents.agent import Agent, Around, PlanFile
from gcs.agents.verdicts import Denied
from gcs.cli.mcp.server import server_of
from gcs.gate.states import State
from gcs.operator.client import StationEnded, StationEvent
from gcs.operator.station import Station
from gcs.session import effects, inputs
from tests.loopback.flight import CONFIG, MISSIONS, Flight, Personality

Person = Literal["allows", "refuses", "goes away", "nobody"]
Told = dict[str, Any]
NAME = "agent test"


class AgentFlight(Flight):
    """A flight whose first operator is a program of the library."""

    def __init__(self, personality: Personality = "px4") -> None:
        self._on_event: Callable[[StationEvent], None] = lambda event: None
        super().__init__(personality, config=msgspec.structs.replace(CONFIG, operator=NAME))

    def _carry_out(self, effect: effects.Effect) -> list[inputs.Input]:
        if isinstance(effect, effects.Emit) and effect.operator in (effects.EVERYONE, 1):
            self._on_event(effect.event)
        return super()._carry_out(effect)

    # What follows is `gcs.operator.client.Listened`.

    def send(self, command: ipc.Command) -> bool:
        """It arrives at once; an answer that takes the vehicle some time is waited for."""
        self.feed(inputs.OperatorLine(1, command))
        if isinstance(command, ipc.Ask):
            self.until(lambda: bool(self.verdicts(command.id)))
            if command.word == "mission_check":
                self.done(command.id)
        return True

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        self._on_event = on_event

    def close(self) -> StationEnded:
        return StationEnded(None, None, "")


class ScriptedAgent:
    """What an agent's script is written in; `told` is every call with its answer."""

    def __init__(self, flight: AgentFlight, portal: BlockingPortal, client: Client) -> None:
        self.flight = flight
        self._portal = portal
        self._client = client
        self.calls: list[tuple[str, Told, Told]] = []
        self.asked: list[str] = []
        """What a person was asked."""

    def call(self, name: str, **arguments: object) -> Told:
        """One tool; its answer."""
        result = self._portal.call(lambda: self._client.call_tool(name, arguments))
        answer = result.structured_content
        assert isinstance(answer, dict), result.content
        assert result.is_error == (answer["outcome"] == "refused")
        self.calls.append((name, arguments, answer))
        return answer

    def check(self, action: str, **arguments: object) -> str:
        """The verdict of a check that must be accepted."""
        answer = self.call("check", action=action, **arguments)
        assert answer["outcome"] == "accepted", answer
        return str(answer["verdict"])

    def do(self, action: str, **arguments: object) -> int:
        """Check it, then do it; the operation."""
        answer = self.call(action, verdict=self.check(action, **arguments))
        assert answer["outcome"] == "accepted", answer
        return int(answer["operation"])

    def watch(self, operation: int, timeout_s: float = 60.0) -> Told:
        """Renew it every five seconds until it is over; how it ended."""
        for _ in range(round(timeout_s / 5.0)):
            answer = self.call("renew", operation=operation)
            if answer["operation_state"] != "running":
                return answer
            self.flight.run(5.0)
        raise AssertionError(f"operation {operation} goes on")

    def hover(self, up_m: float = 3.0) -> None:
        """Arm, climb, and be there."""
        self.watch(self.do("arm"))
        ended = self.watch(self.do("takeoff", up_m=up_m))
        assert (ended["operation_state"], self.flight.state) == ("complete", State.HOVERING)

    def read(self, name: str) -> Told:
        """A resource."""
        result = self._portal.call(lambda: self._client.read_resource(f"mavgate://{name}"))
        (content,) = result.contents
        return dict(msgspec.json.decode(content.text))  # type: ignore[union-attr]

    def tools(self) -> list[Any]:
        return list(self._portal.call(self._client.list_tools).tools)


def _plan(name: str) -> PlanFile | Denied:
    """A shipped mission, whatever the fence; its digest is its size."""
    path = MISSIONS / name
    if not path.is_file():
        return Denied("NO_SUCH_FILE", "no such mission")
    return PlanFile(str(path), str(path.stat().st_size))


@contextmanager
def agent_of(
    flight: AgentFlight,
    person: Person = "allows",
    *,
    session: str = "one",
    read_plan: Callable[[str], PlanFile | Denied] = _plan,
    mode: Literal["auto", "legacy"] = "auto",
) -> Iterator[ScriptedAgent]:
    """`mode`: of MCP, how a person is asked differs."""
    station = Station(flight)
    around = Around(session, True, "default", "digest", "", lambda: flight.now_ns, read_plan)
    server = server_of(Agent(station, around), lambda: {"items": []})
    asked: list[str] = []

    async def ask(context: object, params: ElicitRequestParams) -> ElicitResult:
        asked.append(params.message)
        if person == "goes away":
            return ElicitResult(action="cancel")
        return ElicitResult(action="accept", content={"allow": person == "allows"})

    client = Client(server, mode=mode, elicitation_callback=None if person == "nobody" else ask)
    with start_blocking_portal() as portal, portal.wrap_async_context_manager(client):
        agent = ScriptedAgent(flight, portal, client)
        agent.asked = asked
        yield agent
