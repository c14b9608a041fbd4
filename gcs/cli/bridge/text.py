"""What goes through a bridge and who is in control, in words; without a terminal."""

from __future__ import annotations

import math
import time

from gcs import ipc
from gcs.enu_text import fixed
from gcs.gate.states import State
from gcs.operator.text import event_text

Row = tuple[str, ...]

LINKS_HEAD: Row = ("vehicle link", "in/s", "out/s", "lost", "")
CLIENTS_HEAD: Row = ("client", "where", "calls itself", "in/s", "out/s", "refused", "dropped", "")
VEHICLES_HEAD: Row = (
    *("vehicle", "state", "control", "severity", "mode"),
    *("east north up", "m/s", "battery", "lost", ""),
)
NARROW: Row = ("control", "severity", "lost")
"""Columns of vehicles that a narrow terminal has no room for."""
LONG_SILENCE_S = 3.0


def vehicle_line(seen: ipc.Snapshot | None) -> str:
    """`1/1 px4 quadrotor, HOVERING, control OURS, severity NOMINAL, ...`."""
    if seen is None or not seen.vehicle:
        others = f"; heard: {', '.join(seen.vehicles)}" if seen and seen.vehicles else ""
        return f"no vehicle heard yet{others}"
    return f"{seen.vehicle}, {event_text.vehicle_words(seen)}"


def conditions_line(seen: ipc.Snapshot | None) -> str:
    """What is wrong with it; empty where nothing is."""
    return "" if seen is None else ", ".join(seen.conditions)


def control_line(seen: ipc.Snapshot | None) -> str:
    """Who of the clients and operators may ask for everything."""
    info = seen.in_control if seen else None
    return f"{info.client} ({info.name})" if info else "nobody: the first who asks for motion"


def link_rows(status: ipc.BridgeStatus | None) -> list[Row]:
    """One a link on which vehicles are, the head first."""
    links = status.links if status else []
    return [
        LINKS_HEAD,
        *(
            (
                each.name,
                f"{each.rx_hz:.0f}",
                f"{each.tx_hz:.0f}",
                f"{each.lost_pct:.1f} %",
                "" if each.rx_hz else "nothing is heard here",
            )
            for each in links
        ),
    ]


def vehicle_rows(status: ipc.BridgeStatus | None, *, narrow: bool = False) -> list[Row]:
    """One a vehicle where there are several, the head first; else empty.  Places are metres of each
    vehicle's own local origin.  `narrow`: without notes, which are `vehicle_notes`."""
    vehicles = status.vehicles if status else []
    if len(vehicles) < 2:
        return []
    shown = [not (narrow and name in NARROW) for name in VEHICLES_HEAD]
    return [
        tuple(word for word, wanted in zip(row, shown, strict=True) if wanted)
        for row in (VEHICLES_HEAD, *(_vehicle_row(each, noted=not narrow) for each in vehicles))
    ]


def vehicle_notes(status: ipc.BridgeStatus | None) -> list[str]:
    """What else is to be known of several vehicles: `vehicle 2: armed, too_close`."""
    vehicles = status.vehicles if status else []
    if len(vehicles) < 2:
        return []
    return [f"vehicle {each.vehicle}: {notes}" for each in vehicles if (notes := _notes(each))]


def _notes(each: ipc.BridgeVehicle) -> str:
    notes = ["armed"] if each.armed else []
    if _is_lost(each):
        notes.append(event_text.lost_words(each.silent_s))
    elif each.silent_s >= LONG_SILENCE_S:
        notes.append(f"silent for {each.silent_s:.0f} s")
    return ", ".join([*notes, *each.conditions])


def _is_lost(each: ipc.BridgeVehicle) -> bool:
    """It has a row because it was heard; the gate knows of no vehicle there any more."""
    return each.state == State.NO_VEHICLE.name


def _vehicle_row(each: ipc.BridgeVehicle, *, noted: bool) -> Row:
    """A lost vehicle stands where it was last; its mode and speed may be others by now."""
    lost = _is_lost(each)
    return (
        each.name,
        each.state,
        each.control,
        each.severity,
        "-" if lost else each.mode,
        "-" if each.pos_enu is None else " ".join(fixed(x, 1) for x in each.pos_enu),
        "-" if lost or each.v_enu is None else f"{math.hypot(*each.v_enu):.1f}",
        "-" if each.battery_pct is None else f"{each.battery_pct:.0f} %",
        f"{each.lost_pct:.1f} %",
        _notes(each) if noted else "",
    )


def moves(before: ipc.BridgeStatus | None, after: ipc.BridgeStatus) -> list[str]:
    """What has changed of all vehicles but the first, whose state is told as it changes."""
    states = {each.vehicle: each.state for each in before.vehicles} if before else {}
    return [
        f"vehicle {each.vehicle}: {states.get(each.vehicle, 'NO_VEHICLE')} -> {each.state}, "
        f"control {each.control}, severity {each.severity}"
        for each in after.vehicles[1:]
        if states.get(each.vehicle) != each.state
    ]


def client_rows(status: ipc.BridgeStatus | None) -> list[Row]:
    """One a client, the head first."""
    clients = status.clients if status else []
    return [CLIENTS_HEAD, *(_client_row(each) for each in clients)]


def _client_row(each: ipc.BridgeClient) -> Row:
    notes = ["IN CONTROL"] if each.in_control else []
    if each.silent_s >= LONG_SILENCE_S:
        notes.append(f"silent for {each.silent_s:.0f} s")
    elif not each.client and each.verified:
        notes.append("not heard")
    if not each.verified:
        notes.append("not verified")
    if each.signed:
        notes.append(each.signed)
    return (
        str(each.client or "-"),
        each.name,
        " ".join(each.ids) or "-",
        f"{each.rx_hz:.0f}",
        f"{each.tx_hz:.0f}",
        str(each.refused),
        str(each.dropped),
        ", ".join(notes),
    )


def status_line(status: ipc.BridgeStatus, seen: ipc.Snapshot | None) -> str:
    """One line for all: `bridge: 1 link 212/s in, 4/s out, 0.0 % lost; 2 clients ...`."""
    rx_hz, tx_hz = sum(x.rx_hz for x in status.links), sum(x.tx_hz for x in status.links)
    lost_pct = max((each.lost_pct for each in status.links), default=0.0)
    heard = [each for each in status.clients if each.client or not each.verified]
    count, unheard = len(heard), len(status.clients) - len(heard)
    unverified = sum(not each.verified for each in status.clients)
    refused = sum(each.refused for each in status.clients)
    dropped = sum(each.dropped for each in status.clients)
    return (
        f"bridge: {rx_hz:.0f}/s in, {tx_hz:.0f}/s out, {lost_pct:.1f} % lost; "
        f"{count} client{'' if count == 1 else 's'}"
        f"{f' ({unverified} not verified)' if unverified else ''}"
        f"{f' ({unheard} not heard)' if unheard else ''}, {refused} refused"
        f"{f', {dropped} dropped' if dropped else ''}; "
        f"in control: {control_line(seen)}"
    )


def decision_line(decision: ipc.BridgeDecision, *, several: bool = False) -> str:
    """`1000 (udp 127.0.0.1:14551) DO_REPOSITION: refused OUTSIDE_FENCE: the goal is ...`.

    `several`: with the vehicle that it was for.
    """
    which = f" of vehicle {decision.vehicle}" if several and decision.vehicle else ""
    label = f"{decision.client} ({decision.name}) {decision.what}{which}"
    return event_text.answer_line(label, decision.outcome, decision.code, decision.sentence)


def clock_text(time_ns: int) -> str:
    """Hours, minutes and seconds of the local day."""
    return time.strftime("%H:%M:%S", time.localtime(time_ns / 1e9))
