"""Loops of links: what a client is sent comes in again from the vehicle's side.

Two bridges whose clients are one another's vehicle links send each frame round without end.  None
of it tells that it was here before: on its way it is numbered on, and signed anew, and copies come
over a second link of the same vehicle, too.  But no vehicle has as many heartbeats as a loop makes
of them.  Where an autopilot has, every client's link is sent one LINK_NODE_STATUS in the station's
name, for which clients have no use and which bridges and routers send on.  One that comes in on a
vehicle's link proves the loop, and tells both of its ends.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Final, NamedTuple

from gcs.bridge.effects import Reply
from gcs.protocol.effects import Address
from gcs.wire.codec import decode
from gcs.wire.frame import Frame
from gcs.wire.messages import LinkNodeStatus

MOST_BEATS: Final = 6
"""Heartbeats of one autopilot within `BEATS_NS` on the vehicle's clock, over all of its links."""
BEATS_NS: Final = 1_000_000_000
ASK_AGAIN_NS: Final = 2_000_000_000
"""Between two questions."""
QUESTIONS_KEPT: Final = 8
LEFT_OUT_NS: Final = 5_000_000_000
"""A vehicle's link that was left out is one as any other again once it was silent for so long."""
CUT_NS: Final = 1_000_000_000
"""What was asked later than this after a proof, and comes back too: leaving out a peer of the
vehicle's link did not end the loop."""
FORGOTTEN_NS: Final = 10_000_000_000
"""A proof this long after the last one is of another loop."""


class Loop(NamedTuple):
    """What a client's link is sent comes back."""

    client_link: int
    goes_on: bool
    """It was proved a moment ago, and goes on though a peer may have been left out since."""
    told: bool
    """It is no news."""


class Loops:
    """What is known of them."""

    def __init__(self, own: Address) -> None:
        """`own` is what the station calls itself."""
        self._own = own
        self._beats: dict[int, deque[int]] = {}
        """When the last heartbeats of each autopilot came."""
        self._asked: dict[int, set[int]] = {}
        """The last questions: when each was asked, and on which links it has not come back."""
        self._proved: dict[int, int] = {}
        """When a client's link was first proved to be part of a loop."""
        self.left_out: dict[int, int] = {}
        """Vehicles' links on which nothing is heard, and when something came on each last."""

    def beat(self, sysid: int, clients: Iterable[int], now_ns: int) -> list[Reply]:
        """A heartbeat of the autopilot of that system on any link; `clients` are the links of
        those who are sent what it says."""
        beats = self._beats.setdefault(sysid, deque(maxlen=MOST_BEATS))
        beats.append(now_ns)
        if len(beats) < MOST_BEATS or now_ns - beats[0] > BEATS_NS:
            return []
        if self._asked and now_ns - max(self._asked) < ASK_AGAIN_NS:
            return []
        if len(self._asked) == QUESTIONS_KEPT:
            del self._asked[min(self._asked)]
        links = sorted(clients)
        self._asked[now_ns] = set(links)
        return [Reply(link, self._own, _question(link, now_ns)) for link in links]

    def drops(self, link: int, now_ns: int) -> bool:
        """Something came on a vehicle's link; whether that is left out."""
        last_ns = self.left_out.get(link)
        if last_ns is None:
            return False
        if now_ns - last_ns > LEFT_OUT_NS:
            del self.left_out[link]
            return False
        self.left_out[link] = now_ns
        return True

    def came_back(self, frame: Frame, now_ns: int) -> Loop | None:
        """A frame in the station's own name on a vehicle's link; None where it proves nothing."""
        status = decode(frame)
        if not isinstance(status, LinkNodeStatus) or status.timestamp not in self._asked:
            return None
        link, awaited = status.messages_sent, self._asked[status.timestamp]
        if link not in awaited:
            return Loop(link, goes_on=False, told=True)
        awaited.discard(link)
        proved_ns = self._proved.get(link)
        if proved_ns is None or now_ns - proved_ns > FORGOTTEN_NS:
            self._proved[link] = now_ns
            return Loop(link, goes_on=False, told=False)
        goes_on = status.timestamp - proved_ns > CUT_NS
        return Loop(link, goes_on, told=not goes_on)


def _question(link: int, now_ns: int) -> LinkNodeStatus:
    """Known again by its time, in nanoseconds so that no other station has the same, and by the
    link that it was sent on."""
    return LinkNodeStatus(
        timestamp=now_ns,
        tx_rate=0,
        rx_rate=0,
        messages_sent=link,
        messages_received=0,
        messages_lost=0,
        rx_parse_err=0,
        tx_overflows=0,
        rx_overflows=0,
        tx_buf=0,
        rx_buf=0,
    )
