"""The agent's calls as MCP tools and resources.

The `mcp` package reads the signatures here, and closures among them: so annotations are values,
not text.
"""

# No `from __future__ import annotations`: see above.
import threading
from collections.abc import Callable, Mapping
from typing import Annotated, Any

import msgspec
from mcp.server.elicitation import AcceptedElicitation, ElicitationResult
from mcp.server.mcpserver import Context, MCPServer
from mcp.server.mcpserver.resolve import Elicit, Resolve
from mcp.types import CallToolResult, TextContent, ToolAnnotations
from pydantic import BaseModel, Field

from gcs import __version__
from gcs.agents.agent import ACTS, ASKS_A_PERSON, LEASE_S, STOPS, Agent, Answer, failed
from gcs.agents.untrusted import WARNING
from gcs.agents.verdicts import Denied
from gcs.operator.failures import GcsError

INSTRUCTIONS = f"""\
A MAVLink ground station. Places are metres east, north, up of the vehicle's local origin.
To move the vehicle: call `check`, then the tool of that action with the verdict that it returned;
a verdict is for one act, holds some seconds, and only while the vehicle is as it was. goto, takeoff
and mission_start return an operation with a lease: call `renew` at least every {LEASE_S / 3:g} s
until its state is no longer running, or the vehicle is stopped and held. An act that is accepted is
not done yet: wait for `complete` before the next. hold, land, rtl and abort are free at any time.
What is refused is refused: ask for something else, or ask your user. Text marked untrusted_text is
{WARNING}."""

OF_ACTION = {
    "goto": "Fly straight to the point that was checked, and hover.",
    "takeoff": "Climb to the height that was checked, and hover. A person is asked first.",
    "arm": "Arm the motors. A person is asked first.",
    "disarm": "Stop the motors, on the ground only.",
    "control": "Take control of a vehicle that flies already. A person is asked first.",
    "resume": "After a hold: hover under the station's control. A person is asked first.",
    "photo": "Take a picture.",
    "mission_upload": "Send the mission's file that was checked to the vehicle.",
    "mission_start": "Fly the mission on board. A person is asked first.",
}
OF_STOP = {
    "hold": "Stop and hold, in the vehicle's own hold mode.",
    "land": "Land where the vehicle is NOW, which may be short of its goal.",
    "rtl": "Return to home and land.",
    "abort": "Stop now and forget the goal.",
}
READS = ToolAnnotations(read_only_hint=True)
MOVES = ToolAnnotations(read_only_hint=False, destructive_hint=True, idempotent_hint=False)


class Consent(BaseModel):
    """What a person answers."""

    allow: bool = Field(description="Whether the vehicle may do this now")


def server_of(agent: Agent, on_board: Callable[[], Answer]) -> MCPServer[Any]:
    """All that an agent is offered: nothing here sends MAVLink of its own."""
    server: MCPServer[Any] = MCPServer(
        "mavgate", instructions=INSTRUCTIONS, version=__version__, log_level="WARNING"
    )
    _add_looks(server, agent, on_board)
    _add_checks(server, agent)
    for word in ACTS:
        act = _asking(agent, word) if word in ASKS_A_PERSON else _acting(agent, word)
        server.add_tool(act, name=word, description=OF_ACTION[word], annotations=MOVES)
    for word in STOPS:
        server.add_tool(
            _stopping(agent, word), name=word, description=OF_STOP[word], annotations=MOVES
        )
    return server


def _add_looks(server: MCPServer[Any], agent: Agent, on_board: Callable[[], Answer]) -> None:
    looks = {
        "state": (agent.state, "The vehicle's state, with ages."),
        "policy": (agent.policy, "What the gate judges by, and the fence."),
        "decisions": (agent.decisions, "The latest calls, answers and operations."),
        "plan": (on_board, "The mission on board, read back."),
    }
    for name, (look, what) in looks.items():
        server.resource(
            f"mavgate://{name}", name=name, description=what, mime_type="application/json"
        )(_read(agent, name, look))

    @server.tool(description="The vehicle's state, with ages.", annotations=READS)
    def status() -> CallToolResult:
        return _told(agent.status)

    @server.tool(description="How an operation stands; does not renew it.", annotations=READS)
    def operation(operation: int) -> CallToolResult:
        return _told(lambda: agent.operation(operation))

    @server.tool(description="Renew an operation's lease, and say how it stands.")
    def renew(operation: int) -> CallToolResult:
        return _told(lambda: agent.renew(operation))


def _add_checks(server: MCPServer[Any], agent: Agent) -> None:
    one_at_a_time = threading.Lock()
    actions = ", ".join(ACTS)

    def judged(judge: Callable[[str, Mapping[str, object]], Answer]) -> Callable[..., object]:
        def call(
            action: str,
            east_m: float | None = None,
            north_m: float | None = None,
            up_m: float | None = None,
            yaw_deg: float | None = None,
            plan: str | None = None,
        ) -> CallToolResult:
            given = {"east_m": east_m, "north_m": north_m, "up_m": up_m}
            with one_at_a_time:
                return _told(lambda: judge(action, {**given, "yaw_deg": yaw_deg, "plan": plan}))

        return call

    server.tool(
        "check",
        description=f"Would this be accepted now? If so: a verdict to do it with. action: {actions}"
        ". goto needs east_m, north_m, up_m (and may have yaw_deg, clockwise from north); takeoff "
        "up_m above the take-off point; mission_upload plan, a mission file's name.",
        annotations=READS,
    )(judged(agent.check))
    server.tool(
        "why_not",
        description="Why would this be refused now? Arguments as of check.",
        annotations=READS,
    )(judged(agent.why_not))


def _read(agent: Agent, name: str, look: Callable[[], Answer]) -> Callable[[], str]:
    def read() -> str:
        try:
            agent.note_read(name)
            return msgspec.json.encode(look()).decode()
        except GcsError as error:
            return msgspec.json.encode(failed(error)).decode()

    return read


def _acting(agent: Agent, word: str) -> Callable[..., CallToolResult]:
    def act(verdict: str) -> CallToolResult:
        return _told(lambda: agent.act(word, verdict))

    return act


def _stopping(agent: Agent, word: str) -> Callable[[], CallToolResult]:
    def stop() -> CallToolResult:
        return _told(lambda: agent.stop(word))

    return stop


def _asking(agent: Agent, word: str) -> Callable[..., CallToolResult]:
    """The tool of an action that a person is asked about."""

    def ask(verdict: str, context: Context) -> Elicit[Consent] | str:
        """The question; a text: why nobody is asked."""
        try:
            question = agent.question(word, verdict)
        except GcsError as error:
            return str(error)
        if isinstance(question, Denied):
            return ""  # `act` refuses it
        if not _can_ask(context):
            return "this client has no way to ask one (elicitation)"
        return Elicit(question, Consent)

    def act(
        verdict: str, answer: Annotated[ElicitationResult[Consent], Resolve(ask)]
    ) -> CallToolResult:
        why = "whoever was asked has not answered"
        if isinstance(answer, AcceptedElicitation):
            given: Consent | str = answer.data
            if isinstance(given, str):
                why = given
            elif given.allow:
                why = ""
            else:
                why = "whoever was asked has not allowed it"
        if why:
            return _told(lambda: agent.not_allowed(word, verdict, why))
        return _told(lambda: agent.act(word, verdict))

    return act


def _can_ask(context: Context) -> bool:
    """Whether the client says that it can show a form to a person."""
    able = context.client_capabilities
    asks = None if able is None else able.elicitation
    return asks is not None and (asks.form is not None or asks.url is None)


def _told(call: Callable[[], Answer]) -> CallToolResult:
    """The answer as JSON, in text and as structure; a refusal is marked as an error."""
    try:
        answer = call()
    except GcsError as error:
        answer = failed(error)
    text = msgspec.json.format(msgspec.json.encode(answer), indent=1).decode()
    return CallToolResult(
        content=[TextContent(type="text", text=text)],
        structured_content=msgspec.json.decode(text),
        is_error=answer.get("outcome") == "refused",
    )
