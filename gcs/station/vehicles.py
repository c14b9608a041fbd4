"""All vehicles of a session, each with a slot of its own, by which the queue knows its work.

Slot 0 is there from the start, before a vehicle is heard.  A bridge, or the station of `gcs fly`,
without a chosen vehicle meets every other autopilot that it hears, too; any other station flies one
vehicle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Final

import msgspec

from gcs.config import StationConfig
from gcs.gate import inputs
from gcs.gate.effects import Level
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.session.speedup_waits import Times
from gcs.session.work import STATION, ForOwner, GateInput, Log, Work
from gcs.vehicle.gate_port import OF_THE_STATION
from gcs.vehicle.interpreted_messages import is_autopilot
from gcs.vehicle.talk.liveness import LINK_SILENT_NS
from gcs.vehicle.vehicle import Vehicle
from gcs.wire.frame import Frame
from gcs.wire.ids import MsgId

FIRST: Final = 0
MOST_VEHICLES: Final = 16
"""Each has a gate that ticks; of more than these nothing is met, whoever makes up their names."""
NODE: Final = "link"


class Vehicles:
    """One or several; `Vehicles.first` is the one that is meant where none is named, and shown to
    operators who have chosen none."""

    def __init__(self, config: StationConfig, policy: Policy, times: Times, now_ns: int) -> None:
        self._config = config
        self._policy = policy
        self._times = times
        self._several = config.several
        self.first = Vehicle(config, policy, times, now_ns)
        self._all = [self.first]
        self._slots: dict[int, int] = {}
        self._first_is_meant = False
        self._told_too_many = False
        self._told_twice: set[int] = set()
        """System ids that were heard on two links at once, which was told."""
        self.closed = False
        """The station is being left: no other vehicle is met any more."""

    def __iter__(self) -> Iterator[Vehicle]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def of_owner(self, owner: int) -> Vehicle:
        """The vehicle in a slot; for work of the station the first one."""
        return self._all[max(owner, FIRST)]

    def slot_of(self, sysid: int) -> int | None:
        """The slot of the vehicle with that system id; None: it was not met."""
        slot = self._slots.get(sysid)
        if slot is None and sysid and sysid == self.first.sysid:
            slot = self._slots[sysid] = FIRST
        return slot

    def of_sysid(self, sysid: int) -> Vehicle | None:
        """The vehicle with that system id; None: it was not met."""
        slot = self.slot_of(sysid)
        return None if slot is None else self._all[slot]

    @property
    def addresses(self) -> list[Address]:
        """The autopilots that were met, in the order in which they were."""
        known = (vehicle.telemetry for vehicle in self._all)
        return [Address(each.sysid, each.compid) for each in known if each is not None]

    @property
    def links(self) -> list[int]:
        """The links on which vehicles are answered, each once."""
        return sorted({link for vehicle in self._all for link in vehicle.links})

    @property
    def settled(self) -> bool:
        """Every vehicle may be left as it is."""
        return all(vehicle.gate.settled for vehicle in self._all)

    @property
    def deadline_ns(self) -> int | None:
        """When some part of some vehicle waits no longer."""
        times = [time for vehicle in self._all if (time := vehicle.deadline_ns) is not None]
        return min(times, default=None)

    def heard_names(self, now_ns: int) -> list[str]:
        """The names of all that are heard."""
        return [name for vehicle in self._all for name in vehicle.roster.names(now_ns)]

    def why_not_ours(self, sysid: int, now_ns: int) -> str:
        """Of a system that is heard on a link and was not met: why nothing can be asked of it;
        empty where no autopilot of that number is heard."""
        if self.slot_of(sysid) is not None or not self.first.roster.hears(sysid, now_ns):
            return ""
        chosen, is_bridge = self._config.target_sysid, self._config.bridge
        station = "bridge" if is_bridge else "station"
        if chosen:
            option = "--target" if is_bridge else "--vehicle"
            return f"system {sysid} is not this {station}'s: {option} {chosen}"
        ours = ", ".join(str(address.sysid) for address in self.addresses)
        return f"system {sysid} is not this {station}'s, which has met: {ours}"

    def prefix(self, owner: int) -> str:
        """What is said of a vehicle begins so; empty where there is one only, or of the station."""
        if len(self._all) == 1 or owner == STATION:
            return ""
        return f"vehicle {self._all[owner].sysid}: "

    # -------------------------------------------------------------------------------- work

    def each(self, work: Callable[[Vehicle], Sequence[Work]]) -> list[Work]:
        """The same of every vehicle, in its own name."""
        done = ((slot, tuple(work(vehicle))) for slot, vehicle in enumerate(self._all))
        return [ForOwner(slot, items) for slot, items in done if items]

    def to_all(self, item: Work) -> list[Work]:
        """The same item for every vehicle."""
        return [ForOwner(slot, (item,)) for slot in range(len(self._all))]

    def orbit_samples(self, in_control: int, now_ns: int) -> list[Work]:
        """The next sample of every orbit that is flown; `in_control` is an operator's number."""
        return [
            ForOwner(slot, tuple(vehicle.orbit_sample(in_control, now_ns)))
            for slot, vehicle in enumerate(self._all)
            if vehicle.orbits.flown is not None
        ]

    # ------------------------------------------------------------------------------ frames

    def passes(self, link: int, frames: Sequence[Frame], now_ns: int) -> list[int]:
        """See `VehicleFrames.passes`; the slots of those whose gate is to hear that they live."""
        vehicles = enumerate(self._all)
        return [slot for slot, vehicle in vehicles if vehicle.frames.passes(link, frames, now_ns)]

    def in_turn(
        self, link: int, frames: Sequence[Frame], now_ns: int
    ) -> tuple[int, Sequence[Work]] | None:
        """See `VehicleFrames.in_turn`; with the slot of the vehicle whose they are."""
        slot = self.slot_of(frames[0].sysid)
        if slot is None:
            return None
        work = self._all[slot].frames.in_turn(link, frames, now_ns)
        return None if work is None else (slot, work)

    def counted(self, slot: int, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """One of the frames that `in_turn` has counted."""
        vehicle = self._all[slot]
        if frame.msgid == MsgId.RADIO_STATUS and len(self._all) > 1:
            return self.each(
                lambda each: each.frames.counted(link, frame, now_ns) if link in each.links else ()
            )
        work = vehicle.frames.counted(link, frame, now_ns)
        if frame.msgid == MsgId.HEARTBEAT:
            work = [*self._twice(vehicle, link, frame, now_ns), *work]
        return [ForOwner(slot, tuple(work))] if work else []

    def frame(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        """A good frame of anybody on a vehicle's link."""
        slot = self.slot_of(frame.sysid)
        if slot is None and self._is_another(frame):
            return self._meet(link, frame, now_ns)
        if frame.msgid == MsgId.RADIO_STATUS and len(self._all) > 1:
            return self.each(
                lambda each: each.frames.frame(link, frame, now_ns) if link in each.links else ()
            )
        owner = slot or FIRST
        twice = self._twice(self._all[owner], link, frame, now_ns) if slot is not None else []
        work = [*twice, *self._all[owner].frames.frame(link, frame, now_ns)]
        return [ForOwner(owner, tuple(work))] if work else []

    def _twice(self, vehicle: Vehicle, link: int, frame: Frame, now_ns: int) -> Sequence[Work]:
        """A vehicle has two links, or two vehicles have one number, and then nothing that is told
        of them is right: it is said once."""
        if frame.msgid != MsgId.HEARTBEAT:
            return ()
        telemetry = vehicle.telemetry
        if telemetry is None or telemetry.link == link:
            return ()
        silent = now_ns - telemetry.link_ns > self._times.real_ns(LINK_SILENT_NS)
        if silent or frame.sysid in self._told_twice or not is_autopilot(frame):
            return ()
        self._told_twice.add(frame.sysid)
        text = (
            f"vehicle {frame.sysid} is heard on link {telemetry.link} and on link {link}: if these "
            "are two vehicles, give each a system id of its own (PX4: MAV_SYS_ID, "
            "ArduPilot: MAV_SYSID or SYSID_THISMAV), for here they are one"
        )
        return (Log(Level.WARNING, NODE, text),)

    def _is_another(self, frame: Frame) -> bool:
        """A heartbeat of a second vehicle, or of one more, where there may be several."""
        if not self._several or self.first.telemetry is None or frame.msgid != MsgId.HEARTBEAT:
            return False
        return is_autopilot(frame)

    def _meet(self, link: int, frame: Frame, now_ns: int) -> list[Work]:
        if self.closed or len(self._all) >= MOST_VEHICLES:
            told, self._told_too_many = self._told_too_many, True
            text = f"vehicle {frame.sysid} is not met: {len(self._all)} are there already"
            return [] if told or self.closed else [Log(Level.WARNING, NODE, text)]
        slot = self._slots[frame.sysid] = len(self._all)
        config = msgspec.structs.replace(self._config, target_sysid=frame.sysid)
        vehicle = Vehicle(config, self._policy, self._times, now_ns, first=False)
        self._all.append(vehicle)
        wrong: list[Work] = [
            GateInput(inputs.ConditionChanged(name, True, text))
            for name, text in self.first.gate.reasons
            if name in OF_THE_STATION
        ]
        return [ForOwner(slot, (*vehicle.frames.frame(link, frame, now_ns), *wrong))]

    # ---------------------------------------------------------------------------- requests

    def why_unnamed(self, *, asked: bool) -> Refusal | None:
        """Why a request that names no vehicle is for none, where there are several and each is to
        be named.  `asked`: it is one, not only the question what would be said to it.

        Once a request was for the only one, whoever comes later changes nothing, as with `Roster`.
        """
        if self._config.fleet is not True or self._first_is_meant:
            return None
        if len(self._all) == 1:
            self._first_is_meant = asked and self.first.telemetry is not None
            return None
        names = [each.telemetry.label for each in self._all if each.telemetry is not None]
        how = f"name one, by --vehicle or by the words `vehicle {self.first.sysid}`"
        sentence = f"{len(names)} vehicles are heard: {', '.join(names)}; {how}"
        return Refusal(Code.SEVERAL_VEHICLES, sentence, (("vehicles", float(len(names))),))

    def owner_for(self, sysid: int) -> int:
        """Whose a request for the vehicle with that system id is (0: the first); the station's
        where that one is not there."""
        slot = self.slot_of(sysid) if sysid else FIRST
        return STATION if slot is None else slot

    def refusal(self, owner: int, now_ns: int) -> Refusal | None:
        """Why nothing at all can be asked of the vehicle, as of one that is not there (the
        station's)."""
        if owner != STATION:
            return self._all[owner].refusal(now_ns)
        there = ", ".join(str(address.sysid) for address in self.addresses) or "none"
        return Refusal(Code.NO_VEHICLE, f"no such vehicle is heard here; there are: {there}")
