"""Who sends what to whom: programs and components as nodes, their messages as flows."""

from __future__ import annotations

from enum import StrEnum

import msgspec


class Kind(StrEnum):
    """What a node is."""

    OPERATOR = "operator"
    STATION = "station"
    LINK = "link"
    COMPONENT = "component"
    RECORDER = "recorder"


class Node(msgspec.Struct, frozen=True):
    id: str
    kind: Kind
    title: str
    detail: str = ""


class Flow(msgspec.Struct, frozen=True):
    """Messages of one name on one edge; `hz` while it is sent, None: too few, or a burst."""

    name: str
    messages: int
    hz: float | None = None

    @property
    def amount(self) -> str:
        """ "50.0 Hz", or "3 x"."""
        return f"{self.messages} x" if self.hz is None else f"{self.hz:.1f} Hz"


class Edge(msgspec.Struct, frozen=True):
    """From one node to another; the flow with most messages first."""

    source: str
    target: str
    flows: list[Flow]

    @property
    def messages(self) -> int:
        return sum(flow.messages for flow in self.flows)

    def shown(self, most: int) -> list[Flow]:
        """At most so many; the rest is one flow, "N more"."""
        if len(self.flows) <= most:
            return self.flows
        head, rest = self.flows[: most - 1], self.flows[most - 1 :]
        rates = [flow.hz for flow in rest if flow.hz is not None]
        total = sum(flow.messages for flow in rest)
        return [*head, Flow(f"{len(rest)} more", total, sum(rates) if rates else None)]


class Graph(msgspec.Struct, frozen=True):
    """One node, `hub`, is at an end of every edge: a station, or the link that is listened to."""

    title: str
    seconds: float
    hub: str
    nodes: list[Node]
    edges: list[Edge]

    def node(self, id_: str) -> Node:
        return next(node for node in self.nodes if node.id == id_)

    def between(self, source: str, target: str) -> Edge | None:
        found = (edge for edge in self.edges if (edge.source, edge.target) == (source, target))
        return next(found, None)
