"""TIMESYNC and PING: echoed at once."""

from __future__ import annotations

from vehicle_sim.effects import Client, Send
from vehicle_sim.wire import messages as m


def timesync(client: Client, asked: m.Timesync, time_ns: int) -> list[Send]:
    """A request has tc1 = 0; the answer's tc1 is our time, its ts1 the asker's."""
    if asked.tc1 != 0:
        return []
    # A tc1 of 0 would be a request again.
    answer = m.Timesync(max(time_ns, 1), asked.ts1, client.system, client.component)
    return [Send(client.channel, answer)]


def ping(client: Client, asked: m.Ping) -> list[Send]:
    """A request has target 0/0; one with a target is somebody's answer."""
    if asked.target_system or asked.target_component:
        return []
    answer = asked._replace(target_system=client.system, target_component=client.component)
    return [Send(client.channel, answer)]
