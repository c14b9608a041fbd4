"""What operators say, as work of the vehicle that it is about."""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.bridge.bridge import Bridge
from gcs.bridge.judge.climbs import HEIGHT_WRITTEN
from gcs.gate.machine.could import why_not_once_hovering
from gcs.gate.refusal import Refusal
from gcs.gate.requests import GoTo
from gcs.protocol.autopilot import GENERIC
from gcs.protocol.effects import Address
from gcs.request_words import STOPS, BadAskError, Doer, doer_of
from gcs.session import announcements
from gcs.session.effects import Emit
from gcs.session.requests import request_of, source_of
from gcs.session.stop_of_several import StopOfSeveral
from gcs.session.work import STATION, ForOwner, Work
from gcs.station.fleet.goals import settled
from gcs.station.fleet.separation import Separation
from gcs.station.operators import Operators
from gcs.station.vehicles import Vehicles
from gcs.vehicle.gate_port import NOT_FLYING
from gcs.vehicle.own_rule import is_asked_for
from gcs.vehicle.vehicle import Vehicle


def line(
    operators: Operators,
    vehicles: Vehicles,
    separation: Separation,
    bridge: Bridge | None,
    operator: int,
    command: ipc.Command,
    now_ns: int,
) -> ForOwner:
    """One command of an operator; what is about no vehicle is the station's.

    `bridge`: None where no MAVLink client can come.  A climb is held back for a moment after a
    client has written how high one is, and an arming after one has set the mode of a mission.
    """
    if isinstance(command, ipc.Check):
        parts = operators, vehicles, separation, bridge
        answer = _checked(*parts, operator, command.asked, now_ns)
        return ForOwner(STATION, (Emit(answer, operator),))
    if not isinstance(command, ipc.Ask | ipc.Stream):
        return ForOwner(STATION, tuple(operators.line(operator, command, None, None, now_ns)))
    meant = _meant(operators, vehicles, command)
    several = StopOfSeveral(len(meant)) if len(meant) > 1 else None
    work = []
    for owner, asked in meant:
        told = _asked(operators, vehicles, bridge, operator, asked, owner, several, now_ns)
        work.append(ForOwner(owner, tuple(told)))
    return work[0] if several is None else ForOwner(STATION, tuple(work))


def _asked(
    operators: Operators,
    vehicles: Vehicles,
    bridge: Bridge | None,
    operator: int,
    command: ipc.Ask | ipc.Stream,
    owner: int,
    several: StopOfSeveral | None,
    now_ns: int,
) -> list[Work]:
    """What is asked of one vehicle."""
    telemetry = None if owner == STATION else vehicles.of_owner(owner).telemetry
    autopilot = None if telemetry is None else telemetry.autopilot
    held = None
    if bridge is not None and telemetry is not None:
        vehicle = Address(telemetry.sysid, telemetry.compid)
        held = bridge.held_back(command, telemetry.autopilot, vehicle)
    refusal = _why_not(vehicles, bridge, command, owner, now_ns, asked=True)
    if isinstance(command, ipc.Ask) and refusal is None:
        command, refusal = _settled(command, vehicles.of_owner(owner))
    if isinstance(command, ipc.Stream) and owner != STATION:
        streamed = vehicles.of_owner(owner).orbits.streams_itself(operator)
        return [*streamed, *operators.line(operator, command, autopilot, refusal, now_ns)]
    if held is None:
        return operators.line(operator, command, autopilot, refusal, now_ns, several)
    told = operators.line(operator, command, autopilot, refusal or HEIGHT_WRITTEN, now_ns)
    return [held, *told]


def _why_not(
    vehicles: Vehicles,
    bridge: Bridge | None,
    command: ipc.Ask | ipc.Stream,
    owner: int,
    now_ns: int,
    *,
    asked: bool,
) -> Refusal | None:
    """Why nothing, or not this, can be asked of that vehicle, whatever its gate would say."""
    refusal, vehicle = vehicles.refusal(owner, now_ns), vehicles.of_owner(owner)
    if refusal is None and not command.vehicle and not _needs_no_name(command):
        refusal = vehicles.why_unnamed(asked=asked)
    if refusal is None and bridge is not None and vehicle.telemetry is not None:
        refusal = bridge.armings.why_not(command, vehicle.sysid)
    if refusal is None and isinstance(command, ipc.Stream) and vehicle.rule is not None:
        return vehicle.rule.no_legs
    return refusal


def _needs_no_name(command: ipc.Ask | ipc.Stream) -> bool:
    """A stop is for every one that flies; an operation is of one vehicle."""
    if isinstance(command, ipc.Stream):
        return False
    station = doer_of(command.word) is Doer.STATION
    return station or command.word in STOPS or bool(command.operation)


def _settled(ask: ipc.Ask, vehicle: Vehicle) -> tuple[ipc.Ask, Refusal | None]:
    """With its goal in the vehicle's local frame, or why it has none."""
    asked = settled(ask, vehicle)
    return (ask, asked) if isinstance(asked, Refusal) else (asked, None)


def _checked(
    operators: Operators,
    vehicles: Vehicles,
    separation: Separation,
    bridge: Bridge | None,
    operator: int,
    ask: ipc.Ask,
    now_ns: int,
) -> ipc.Checked:
    """The verdict that a request would get now; nothing is opened, recorded or sent for it."""
    owner = vehicles.owner_for(operators.vehicle_of(ask))
    vehicle = vehicles.of_owner(owner)
    refusal = operators.control.refusal(operator, ask)
    refusal = refusal or _why_not(vehicles, bridge, ask, owner, now_ns, asked=False)
    if refusal is None:
        ask, refusal = _settled(ask, vehicle)
    if refusal is not None:
        return announcements.checked(ask, refusal)
    if doer_of(ask.word) is not Doer.GATE:
        return ipc.Checked(ask.id, ask.word, "refused", "BAD_REQUEST", "only requests of the gate")
    try:
        request = request_of(ask, vehicle.telemetry.autopilot if vehicle.telemetry else GENERIC)
    except BadAskError as error:
        return ipc.Checked(ask.id, ask.word, "refused", "BAD_REQUEST", str(error))
    gate, goal = vehicle.gate, None
    near = separation.why_not(vehicles, owner, 0, request, now_ns)
    if isinstance(request, GoTo):
        goal = why_not_once_hovering(gate.memory, request.goal_ned, request.yaw_rad) or near
    if near is not None:
        return announcements.checked(ask, near, goal)
    verdict = gate.would(request, source_of(operator), now_ns)
    if vehicle.rule is not None and is_asked_for(request) and verdict and not verdict.refusal:
        verdict = None  # the operator's own rule is asked first, and only once it is sent
    return announcements.checked(ask, verdict, goal)


def _meant(
    operators: Operators, vehicles: Vehicles, command: ipc.Ask | ipc.Stream
) -> list[tuple[int, ipc.Ask | ipc.Stream]]:
    """The vehicles that a command is for, by slot, and what is asked of each."""
    sysid = operators.vehicle_of(command)
    stops = isinstance(command, ipc.Ask) and command.word in STOPS and not command.operation
    if stops and sysid == ipc.EVERY:
        sysid, command = 0, msgspec.structs.replace(command, vehicle=0)
    flying = _in_the_air(vehicles) if stops and not sysid else []
    if not flying:
        return [(vehicles.owner_for(sysid), command)]
    return [
        (slot, msgspec.structs.replace(command, vehicle=vehicles.of_owner(slot).sysid))
        for slot in flying
    ]


def _in_the_air(vehicles: Vehicles) -> list[int]:
    """The slots of all that were not last seen on the ground, those that are lost or stale at the
    end: the link to a vehicle may be there while the one from it is not."""
    known = [
        (vehicle.gate.state in NOT_FLYING, slot)
        for slot, vehicle in enumerate(vehicles)
        if vehicle.telemetry is not None and not vehicle.gate.memory.on_ground
    ]
    return [slot for _, slot in sorted(known)]
