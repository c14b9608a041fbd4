"""The connection graph of a viewer's "Topic graph" panel: what `gcs graph` counts.  Pure."""

from __future__ import annotations

from gcs import ipc
from gcs.graph.traffic import Traffic
from gcs.live.inputs import Graph
from gcs.topics.topic import Heard, Topic, recorded_topic


class ConnectionGraph:
    """Is told all that the station records; counts only while somebody looks."""

    def __init__(self, where: str) -> None:
        """`where`: the name of the record."""
        self._traffic = Traffic(recorded=True, where=where)
        self._topics: dict[int, Topic] = {}

    def topic(self, told: ipc.Topic) -> None:
        metadata = dict(told.metadata)
        self._topics[told.number] = recorded_topic(
            told.topic, told.schema_name, told.message_encoding, metadata, told.schema
        )

    def message(self, told: ipc.TopicMessage, *, wanted: bool) -> None:
        heard = Heard(self._topics[told.number], told.log_time_ns, told.data)
        (self._traffic.hear if wanted else self._traffic.learn)(heard)

    def graph(self) -> Graph:
        """A flow from a node is a topic of that name under it."""
        made = self._traffic.graph()
        titles = {node.id: node.title for node in made.nodes}
        published: dict[str, list[str]] = {}
        subscribed: dict[str, list[str]] = {}
        for edge in made.edges:
            source, target = titles.get(edge.source), titles.get(edge.target)
            if source is None or target is None:
                continue  # an operator that has gone
            for flow in edge.flows:
                name = f"{source}/{flow.name}"
                published[name] = [source]
                subscribed.setdefault(name, []).append(target)
        return Graph(published, subscribed)
