"""The graph as text, and as DOT for Graphviz."""

from __future__ import annotations

from gcs.graph.model import Graph, Node

DOT_FLOWS = 6


def as_text(graph: Graph, most: int) -> list[str]:
    """Each node, and below it what it sends to whom: at most `most` kinds an edge."""
    lines = [f"{graph.title}: {graph.seconds:.1f} s"]
    for node in graph.nodes:
        sent = [edge for edge in graph.edges if edge.source == node.id]
        lines += ["", _name(node)]
        for edge in sent:
            target = graph.node(edge.target).title
            plural = "" if edge.messages == 1 else "s"
            lines.append(f"  -> {target}: {edge.messages} message{plural}")
            width = max(len(flow.name) for flow in edge.shown(most))
            lines += [f"       {flow.name:{width}}  {flow.amount:>9}" for flow in edge.shown(most)]
        if not sent:
            lines.append("  sends nothing" if node.id != "recorder" else "  writes the record")
    return lines


def as_dot(graph: Graph) -> list[str]:
    """For `dot -Tsvg`."""
    lines = ["digraph mavlink {", "  rankdir=LR;", '  node [shape=box, fontname="Helvetica"];']
    lines.append('  edge [fontname="Helvetica", fontsize=10];')
    lines += [
        f"  {_quoted(node.id)} [label={_quoted(node.title, node.detail)}];" for node in graph.nodes
    ]
    for edge in graph.edges:
        label = [f"{flow.name} {flow.amount}" for flow in edge.shown(DOT_FLOWS)]
        ends = f"{_quoted(edge.source)} -> {_quoted(edge.target)}"
        lines.append(f"  {ends} [label={_quoted(*label)}];")
    return [*lines, "}"]


def _name(node: Node) -> str:
    return f"{node.title} ({node.detail})" if node.detail else node.title


def _quoted(*parts: str) -> str:
    """A DOT string, a part a line."""
    escaped = (part.replace("\\", "\\\\").replace('"', '\\"') for part in parts if part)
    return '"' + "\\n".join(" ".join(part.split()) for part in escaped) + '"'
