"""What comes in on the links: bytes become frames, and each frame goes to the part that it is for.

Nearly all frames of a vehicle are only recorded, counted and sent on to clients, which is no work
for the queue: at 100,000 a second every call counts here.
"""

from __future__ import annotations

from collections.abc import Sequence

from gcs.gate.condition import Condition
from gcs.protocol.effects import Address
from gcs.report import Direction, FrameItem, FramesItem, GarbageItem
from gcs.session.effects import ClientVerified, Effect, Record
from gcs.session.inputs import Datagram
from gcs.session.work import Work, condition
from gcs.station.bridge_port import BridgePort
from gcs.station.links import Links
from gcs.station.operators import Operators
from gcs.station.queue import WorkQueue
from gcs.station.signatures import Signatures
from gcs.station.vehicles import FIRST, Vehicles
from gcs.vehicle.interpreted_messages import INTERPRETED, PLACES
from gcs.vehicle.received_frames import ALIVE
from gcs.vehicle.record_items import pieces
from gcs.wire.blanking import without_key
from gcs.wire.frame import Frame, Garbage, Item, raw_of
from gcs.wire.ids import MsgId
from gcs.wire.signing import Reason

_RECEIVED = Direction.RECEIVED  # looking it up costs more than what it is used for


class FramesRaisedError(Exception):
    """Some frames of a run raised, which is a bug of ours; all others are handled.

    `effects` are those of the others; `dropped` has the input that each frame which raised would
    have been, and what it raised.
    """

    def __init__(
        self, effects: Sequence[Effect], dropped: Sequence[tuple[Datagram, Exception]]
    ) -> None:
        super().__init__(f"{len(dropped)} inputs raised")
        self.effects = effects
        self.dropped = dropped


class Incoming:
    """The way of every datagram into the session; client links have the numbers from
    `first_client_link` up."""

    def __init__(
        self,
        own: Address,
        first_client_link: int,
        links: Links,
        signatures: Signatures,
        queue: WorkQueue,
        vehicles: Vehicles,
        operators: Operators,
        bridge: BridgePort,
    ) -> None:
        self._own = own.sysid, own.compid
        self._first_client_link = first_client_link
        self._links = links
        self._signatures = signatures
        self._queue = queue
        self._vehicles = vehicles
        self._operators = operators
        self._bridge = bridge
        self.other_station_ns = 0
        """When a frame of another station that calls itself as this one came last."""
        self._in_run = False
        """What is being handled is a run: one frame that raises does not take the others along."""
        self.dropped: list[tuple[Datagram, Exception]] = []

    def of_client(self, given: Datagram) -> bool:
        """Whether it came from a MAVLink client, not from the vehicle's side."""
        return given.link >= self._first_client_link

    def datagram(self, given: Datagram, now_ns: int) -> bool:
        """Frame by frame: what one leads to is done before the next is looked at.

        False: nothing was in it but what only passes through, so nothing else has changed."""
        loops = self._bridge.loops
        if loops.left_out and loops.drops(given.link, now_ns):
            return False
        self._in_run = len(given.frames) > 1
        link, run = given.link, self._queue.run
        if given.as_recorded is None:
            items = self._links.split(link, given.data, given.frames)
        else:
            items = self._links.again(link, given.as_recorded)
        if (
            items is given.frames
            and not self.of_client(given)
            and not self._signatures.signed(link)
        ):
            return self._from_vehicles(link, given.frames, given.frames, now_ns)
        rest = self._links.rest(link)
        if rest or not items:
            run(pieces(link, len(items), rest), now_ns)
        taken = self._taken(link, items, now_ns)
        if not self.of_client(given):
            frames = [item for item in taken if not isinstance(item, GarbageItem)]
            return self._from_vehicles(link, taken, frames, now_ns)
        for item in taken:
            if isinstance(item, GarbageItem):
                run([Record(item)], now_ns)
            else:
                run(self._client_frame(link, item, now_ns), now_ns)
        return True

    def take_dropped(self) -> list[tuple[Datagram, Exception]]:
        """The frames of the run that raised, and what they raised."""
        dropped, self.dropped = self.dropped, []
        return dropped

    def _drop(self, link: int, frame: Frame, error: Exception, mark: int) -> bool:
        """Leave out a frame that raised; False where that is the whole input."""
        if self._in_run:
            self._queue.back_to(mark)
            self.dropped.append((Datagram(link, frame.raw), error))
        return self._in_run

    def _taken(self, link: int, items: Sequence[Item], now_ns: int) -> list[Frame | GarbageItem]:
        """The frames that are taken, and the rest as the record has it."""
        signed = self._signatures.signed(link)
        verifying = self._bridge.open and link in self._bridge.bridge.unverified
        taken: list[Frame | GarbageItem] = []
        for item in items:
            if isinstance(item, Garbage):
                taken.append(GarbageItem(link, item.raw, item.reason.value))
            elif (signed or item.signature) and (
                reason := self._signatures.refused(link, item, now_ns, verifying=verifying)
            ):
                # Not as a frame: nobody shall take it for the sender's, in a viewer neither.
                taken.append(GarbageItem(link, without_key(item.raw), reason.value))
                if reason is Reason.TOO_OLD:
                    # It has the key.  What we send moves its clock on, which may be behind.
                    self._links.peer_known(link)
            else:
                taken.append(item)
        return taken

    def _from_vehicles(
        self,
        link: int,
        taken: Sequence[Frame | GarbageItem],
        frames: Sequence[Frame],
        now_ns: int,
    ) -> bool:
        """What came on a vehicle's link, and the frames of it: they are first of all sent on to the
        clients, together as they came.  Nearly all of them are only recorded and counted, in runs
        and not one by one, which is no work for the queue."""
        effects = self._queue.effects
        mark = len(effects)
        try:
            if self._bridge.open:
                for to, raws, left_out in self._bridge.bridge.from_vehicle(frames, now_ns):
                    effects += self._links.together(to, raws, now_ns, left_out)
        except Exception as error:
            if len(frames) > 1 and self._in_run:
                self._queue.back_to(mark)
                for item in taken:
                    of_it = [item] if type(item) is Frame else []
                    self._from_vehicles(link, [item], of_it, now_ns)
                return True
            if not frames or not self._drop(link, frames[0], error, mark):
                raise
            return True
        if frames:
            self._links.peer_known(link)
            if len(frames) == len(taken):
                try:
                    found = self._vehicles.in_turn(link, frames, now_ns)
                except Exception:
                    if not self._in_run:
                        raise
                    found = None  # which one of them raises is looked for one by one
                if found is not None:
                    return self._in_turn(link, frames, *found, now_ns)
        worked = False
        special, own_compid = self._operators.subscriptions.subscribed, self._own[1]
        passing: list[Frame] = []
        for item in taken:
            if type(item) is Frame:
                msgid = item.msgid
                alone = msgid in INTERPRETED or msgid in special or item.compid == own_compid
                if not alone:
                    passing.append(item)
                    continue
            worked |= self._pass(link, passing, now_ns)
            passing = []
            if isinstance(item, GarbageItem):
                effects.append(Record(item))
                continue
            mark = len(effects)
            try:
                effects.append(Record(FrameItem(link, _RECEIVED, item.raw)))
                worked |= self._work(self._vehicle_frame(link, item, now_ns), now_ns)
                worked |= msgid not in PLACES
            except Exception as error:
                if not self._drop(link, item, error, mark):
                    raise
                worked = True
        return self._pass(link, passing, now_ns) or worked

    def _in_turn(
        self, link: int, frames: Sequence[Frame], slot: int, alive: Sequence[Work], now_ns: int
    ) -> bool:
        """Frames of one autopilot that were counted together: recorded together, and those that
        somebody interprets looked at; whether they lead to anything."""
        queue, effects = self._queue, self._queue.effects
        kept_at = len(effects)
        raws = tuple(map(raw_of, frames))
        effects.append(Record(FramesItem(link, _RECEIVED, raws)))
        worked = bool(alive) and queue.run(alive, now_ns, slot)
        special, vehicle = self._operators.subscriptions.subscribed, self._vehicles.of_owner(slot)
        wanted = [each for each in frames if each.msgid in INTERPRETED or each.msgid in special]
        for frame in wanted:
            mark = len(effects)
            try:
                if frame.msgid in PLACES and frame.msgid not in special:
                    work = vehicle.frames.placed(frame, now_ns)
                    worked |= bool(work) and queue.run(work, now_ns, slot)
                else:
                    worked, work = True, self._vehicles.counted(slot, link, frame, now_ns)
                    queue.run(self._also(frame, work, now_ns), now_ns)
            except Exception as error:
                if not self._drop(link, frame, error, mark):
                    raise
                raws = tuple([raw for raw in raws if raw is not frame.raw])
                effects[kept_at] = Record(FramesItem(link, _RECEIVED, raws))
                worked = True
        return worked

    def _pass(self, link: int, frames: Sequence[Frame], now_ns: int) -> bool:
        """Frames in a row that only pass through; whether they lead to anything."""
        if not frames:
            return False
        mark, worked = len(self._queue.effects), False
        try:
            raws = tuple(map(raw_of, frames))
            self._queue.effects.append(Record(FramesItem(link, _RECEIVED, raws)))
            for owner in self._vehicles.passes(link, frames, now_ns):
                worked |= self._queue.run(ALIVE, now_ns, owner)
        except Exception as error:
            if len(frames) > 1 and self._in_run:
                self._queue.back_to(mark)
                for frame in frames:
                    self._pass(link, [frame], now_ns)
                return True
            if not self._drop(link, frames[0], error, mark):
                raise
            return True
        return worked

    def _work(self, work: Sequence[Work], now_ns: int) -> bool:
        """Do it; whether anything has changed by it."""
        return bool(work) and self._queue.run(work, now_ns)

    def _client_frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of a MAVLink client: judged first, because the record says how.  The first
        one of a client that was not verified has a good signature, as others are not taken."""
        self._links.client_spoke(link, frame.raw)
        bridge = self._bridge.bridge
        verified: list[Work] = []
        if link in bridge.unverified:
            verified = [ClientVerified(link), *bridge.verify(link)]
        judged = self._bridge.from_client(link, frame, now_ns)
        direction = Direction.REFUSED if judged.refused else Direction.RECEIVED
        return [Record(FrameItem(link, direction, frame.raw)), *verified, *judged.effects]

    def _vehicle_frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        sysid, compid = self._own
        if frame.compid == compid and frame.sysid == sysid:
            back = self._bridge.came_back(link, frame, now_ns)
            if back is not None:
                return back
            self.other_station_ns = now_ns
            who = f"another station on link {link} calls itself {sysid}/{compid}"
            text = f"{who}, as this one does: start one of the two with another --sysid"
            return [condition(Condition.OTHER_STATION, True, text)]
        return self._also(frame, self._vehicles.frame(link, frame, now_ns), now_ns)

    def _also(self, frame: Frame, work: list[Work], now_ns: int) -> list[Work]:
        """What a vehicle's frame is to the vehicle, and to clients and operators."""
        if not self._bridge.open:
            pass
        elif frame.msgid == MsgId.PARAM_VALUE:
            work += self._bridge.parameter(frame, now_ns)
        elif frame.msgid == MsgId.HEARTBEAT:
            work += self._bridge.beat(frame, now_ns)
        if frame.msgid in self._operators.subscriptions.subscribed:
            slot = self._vehicles.slot_of(frame.sysid)
            if slot is not None:
                work += self._operators.heard_message(frame, now_ns, first=slot == FIRST)
        return work
