"""The graph as one SVG: the hub in the middle, operators left, components right, recorder below.

Every edge has the hub at one end, so rows beside a tall hub need no routing: arrows are straight,
and nothing crosses.  Light or dark as the viewer is.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from gcs.graph.model import Edge, Flow, Graph, Kind, Node

NODE_WIDTH, NODE_HEIGHT = 190, 62
RECORDER_WIDTH = 270
"""A file's name fits."""
HUB_WIDTH = 150
GAP = 300
"""Between the hub and what is beside it: the room of the flows' names."""
LINE = 17
ROW_GAP = 34
MARGIN = 28
HEADER = 48
MOST_FLOWS = 8
NAME_LETTERS = 30
LETTER_WIDTH = 8

STYLE = """
  .page { fill: #ffffff } .box { fill: #f6f8fa; stroke: #8c959f }
  .operator { stroke: #8250df } .station { stroke: #1a7f37; fill: #effbf2 }
  .link { stroke: #1a7f37 }
  .component { stroke: #0969da } .recorder { stroke: #bc4c00 }
  text { font: 13px system-ui, "Segoe UI", Helvetica, Arial, sans-serif; fill: #1f2328 }
  .title { font-weight: 600; font-size: 15px } .detail, .amount { fill: #656d76 }
  .head { font-size: 16px; font-weight: 600 }
  .flow { font-family: ui-monospace, Menlo, Consolas, monospace; font-size: 11.5px }
  .arrow { stroke: #57606a; stroke-width: 1.5; fill: none } .tip { fill: #57606a }
  @media (prefers-color-scheme: dark) {
    .page { fill: #0d1117 } .box { fill: #161b22; stroke: #6e7681 }
    .operator { stroke: #a371f7 } .station { stroke: #3fb950; fill: #12261a }
    .link { stroke: #3fb950 } .component { stroke: #58a6ff } .recorder { stroke: #f0883e }
    text { fill: #e6edf3 } .detail, .amount { fill: #8d96a0 }
    .arrow { stroke: #8d96a0 } .tip { fill: #8d96a0 }
  }
"""


def as_svg(graph: Graph) -> str:
    """A whole file."""
    hub = graph.node(graph.hub)
    left = [node for node in graph.nodes if node.kind is Kind.OPERATOR]
    right = [node for node in graph.nodes if node.kind is Kind.COMPONENT]
    below = [node for node in graph.nodes if node.kind is Kind.RECORDER]
    hub_x = MARGIN + (NODE_WIDTH + GAP if left else (RECORDER_WIDTH - HUB_WIDTH) // 2)
    right_x = hub_x + HUB_WIDTH + GAP
    width = right_x + NODE_WIDTH + MARGIN
    top = MARGIN + HEADER
    left_rows, left_end = _rows(graph, left, top)
    right_rows, right_end = _rows(graph, right, top)
    hub_end = max(left_end, right_end, top + NODE_HEIGHT)
    parts = [_text(MARGIN, MARGIN + 8, f"{graph.title}, {graph.seconds:.1f} s", "head")]
    for node, y, height in left_rows:
        parts += _spoke(graph, node, (MARGIN, y, height), MARGIN + NODE_WIDTH, hub_x)
    for node, y, height in right_rows:
        parts += _spoke(graph, node, (right_x, y, height), right_x, hub_x + HUB_WIDTH)
    parts += _box(hub, hub_x, top, HUB_WIDTH, hub_end - top)
    end = hub_end
    for node in below:
        parts += _beneath(graph, node, hub_x, hub_end)
        end = hub_end + _label_height(graph.between(graph.hub, node.id)) + ROW_GAP + NODE_HEIGHT
    height = end + MARGIN
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}">',
            f"<style>{STYLE}</style>",
            '<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" '
            'markerHeight="8" orient="auto">',
            '<path class="tip" d="M0 0 10 5 0 10z"/></marker></defs>',
            f'<rect class="page" width="{width}" height="{height}"/>',
            *parts,
            "</svg>\n",
        ]
    )


def _rows(graph: Graph, nodes: Sequence[Node], top: int) -> tuple[list[tuple[Node, int, int]], int]:
    """Node, y, height of each row, and where the last one ends."""
    rows = []
    y = top
    for node in nodes:
        labels = (graph.between(node.id, graph.hub), graph.between(graph.hub, node.id))
        height = max(NODE_HEIGHT, sum(_label_height(edge) for edge in labels))
        rows.append((node, y, height))
        y += height + ROW_GAP
    return rows, y - ROW_GAP if rows else y


def _label_height(edge: Edge | None) -> int:
    """The arrow and the flows below it."""
    return 0 if edge is None else LINE * (len(edge.shown(MOST_FLOWS)) + 1) + 10


def _spoke(
    graph: Graph, node: Node, place: tuple[int, int, int], node_side: int, hub_side: int
) -> list[str]:
    """One node beside the hub, and both arrows with what flows along them."""
    x, y, height = place
    parts = _box(node, x, y, NODE_WIDTH, height)
    towards, from_hub = graph.between(node.id, graph.hub), graph.between(graph.hub, node.id)
    low, high = min(node_side, hub_side), max(node_side, hub_side)
    for edge, start, end in ((towards, node_side, hub_side), (from_hub, hub_side, node_side)):
        if edge is not None:
            parts.append(_arrow(start, y + LINE, end, y + LINE))
            parts += _flows(edge.shown(MOST_FLOWS), low + 14, high - 14, y + 2 * LINE + 2)
            y += _label_height(edge)
    return parts


def _beneath(graph: Graph, node: Node, hub_x: int, hub_end: int) -> list[str]:
    """A node below the hub."""
    edge = graph.between(graph.hub, node.id)
    room = _label_height(edge) + ROW_GAP
    middle = hub_x + HUB_WIDTH // 2
    parts = [_arrow(middle, hub_end, middle, hub_end + room)]
    if edge is not None:
        parts += _flows(
            edge.shown(MOST_FLOWS), middle + 16, middle + 16 + GAP - 60, hub_end + 2 * LINE
        )
    return parts + _box(
        node, middle - RECORDER_WIDTH // 2, hub_end + room, RECORDER_WIDTH, NODE_HEIGHT
    )


def _flows(flows: Sequence[Flow], left: int, right: int, y: int) -> list[str]:
    """A line each: name, and how much of it."""
    parts = []
    for number, flow in enumerate(flows):
        at = y + number * LINE
        parts.append(_text(left, at, _cut(flow.name, NAME_LETTERS), "flow"))
        parts.append(_text(right, at, flow.amount, "flow amount", anchor="end"))
    return parts


def _box(node: Node, x: int, y: int, width: int, height: int) -> list[str]:
    middle, centre = x + width // 2, y + height // 2
    rectangle = f'<rect class="box {node.kind}" x="{x}" y="{y}" width="{width}" height="{height}"'
    lift = 5 if node.detail else -5
    return [
        f'{rectangle} rx="8" stroke-width="1.8"/>',
        _text(middle, centre - lift, node.title, "title", anchor="middle"),
        _text(
            middle, centre + 14, _cut(node.detail, width // LETTER_WIDTH), "detail", anchor="middle"
        ),
    ]


def _arrow(x0: int, y0: int, x1: int, y1: int) -> str:
    return f'<path class="arrow" d="M{x0} {y0} {x1} {y1}" marker-end="url(#tip)"/>'


def _text(x: int, y: int, text: str, style: str, *, anchor: str = "start") -> str:
    shown = escape("".join(char if char.isprintable() else "?" for char in text))
    return f'<text class="{style}" x="{x}" y="{y}" text-anchor="{anchor}">{shown}</text>'


def _cut(text: str, letters: int) -> str:
    return text if len(text) <= letters else text[: letters - 1] + "…"
