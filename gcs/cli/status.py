"""`gcs status`: the latest snapshot as a table, or as JSON; of a bridge its other vehicles,
too, and the clients that are not verified."""

from __future__ import annotations

import math

import click
import msgspec

from gcs import ipc
from gcs.cli.progress import ProgressDisplay
from gcs.enu_text import signed_enu
from gcs.exit_codes import ExitCode
from gcs.operator.dialogue import Dialogue
from gcs.operator.preflight import waiting
from gcs.operator.text.control_text import as_typed_now, control_words
from gcs.operator.text.event_text import whole_degrees

SLOW_VALUES_WAIT_S = 1.5
"""Battery and mode come less often than the position."""
FAILSAFES_WAIT_S = 10.0
"""An autopilot's own failsafes are read parameter by parameter when it appears."""


def report(dialogue: Dialogue, display: ProgressDisplay, *, as_json: bool) -> ExitCode:
    """Give the slower values a moment to arrive, then print."""

    def whole() -> bool:
        seen, hello = dialogue.snapshot, dialogue.hello
        if seen is None or seen.battery_pct is None:
            return False
        others = len(seen.vehicles) > 1 or (hello is not None and bool(hello.client_ports))
        return not others or dialogue.bridge is not None

    def failsafes_told() -> bool:
        seen = dialogue.snapshot
        return seen is not None and bool(seen.failsafes)

    dialogue.wait_until(whole, SLOW_VALUES_WAIT_S)
    if not failsafes_told() and "failsafes" in waiting(dialogue.look_before_flight()):
        dialogue.wait_until(failsafes_told, FAILSAFES_WAIT_S)
    display.clear()
    return show(dialogue.snapshot, dialogue.number, as_json=as_json, bridge=dialogue.bridge)


def show(
    seen: ipc.Snapshot | None,
    number: int,
    *,
    as_json: bool,
    bridge: ipc.BridgeStatus | None = None,
) -> ExitCode:
    """Print it; NO_VEHICLE if nothing was heard."""
    if seen is None:
        return ExitCode.NO_VEHICLE
    if as_json:
        told = msgspec.to_builtins(seen)
        if bridge is not None and len(bridge.vehicles) > 1:
            told["fleet"] = msgspec.to_builtins(bridge.vehicles)
        click.echo(msgspec.json.encode(told).decode())
        return ExitCode.DONE

    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False)
    table.add_column(style="dim")
    table.add_column()
    for name, value in rows(seen, number, bridge):
        table.add_row(name, value)
    Console(highlight=False, markup=False).print(table)
    return ExitCode.DONE


def rows(
    seen: ipc.Snapshot, number: int, bridge: ipc.BridgeStatus | None = None
) -> list[tuple[str, str]]:
    """What is shown to operator `number`, top to bottom; unknown values are a dash.

    `bridge` has the vehicles of a bridge, of which `seen` is the first one, and its clients.
    """
    armed = {None: "-", True: "armed", False: "disarmed"}[seen.armed]
    conditions = f" ({', '.join(seen.conditions)})" if seen.conditions else ""
    flown = {each.name: each for each in bridge.vehicles} if bridge else {}
    others = [name for name in seen.vehicles if name != seen.vehicle and name not in flown]
    mends = [as_typed_now(each, seen, number) for each in seen.mends]
    unverified = [each for each in bridge.clients if not each.verified] if bridge else []
    return [
        ("vehicle", seen.vehicle),
        *([("also heard", ", ".join(others))] if others else []),
        ("state", f"{seen.state}, control {seen.control}"),
        ("control", control_words(seen, number)),
        ("severity", f"{seen.severity}{conditions}"),
        ("mode", f"{seen.mode or '-'}, {armed}, {seen.landed or '-'}"),
        ("position", f"{signed_enu(seen.pos_enu)} m, {_fixed(seen.position_age_s, 's', 2)} old"),
        ("velocity", f"{signed_enu(seen.v_enu)} m/s, {_speed(seen.v_enu)}"),
        ("heading", "-" if seen.yaw_deg is None else f"{whole_degrees(seen.yaw_deg)} deg"),
        ("home", f"{signed_enu(seen.home_enu)} m"),
        ("gps", f"{seen.gps or '-'}, estimator {seen.estimator or '-'}"),
        ("battery", f"{_fixed(seen.battery_pct, '%', 0)}, {_fixed(seen.battery_v, 'V', 1)}"),
        ("failsafes", "\n".join(seen.failsafes) or "not read yet"),
        *([("what mends them", "\n".join(mends))] if mends else []),
        ("link", _link(seen)),
        ("heartbeat", f"{_fixed(seen.heartbeat_age_s, 's', 1)} ago"),
        ("log", seen.log_path or "not recorded"),
        *((f"vehicle {x.vehicle}", _other(x)) for x in flown.values() if x.name != seen.vehicle),
        *([("not verified", "\n".join(map(_unverified, unverified)))] if unverified else []),
    ]


def _unverified(each: ipc.BridgeClient) -> str:
    """A client of a port with a key that has not signed anything yet, and what came of it."""
    return f"client {each.name}: {each.signed or 'nothing came yet'}"


def _other(each: ipc.BridgeVehicle) -> str:
    """A vehicle of a bridge that is not the first, in three lines."""
    conditions = f" ({', '.join(each.conditions)})" if each.conditions else ""
    armed = {None: "-", True: "armed", False: "disarmed"}[each.armed]
    return (
        f"{each.name}: {each.state}, control {each.control}, {each.severity}{conditions}\n"
        f"{each.mode or '-'}, {armed}, battery {_fixed(each.battery_pct, '%', 0)}, "
        f"heard {each.silent_s:.1f} s ago, {each.lost_pct:.1f} % lost\n"
        f"{signed_enu(each.pos_enu)} m, {_speed(each.v_enu)}"
    )


def _link(seen: ipc.Snapshot) -> str:
    """The rate is measured over two seconds; before that there is none."""
    rate = f"{seen.rx_hz:.0f} messages/s, " if seen.rx_hz else ""
    return f"{rate}{seen.lost_pct:.1f} % lost"


def _fixed(value: float | None, unit: str, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f} {unit}"


def _speed(v_enu: ipc.Vec3 | None) -> str:
    return "-" if v_enu is None else f"{math.hypot(*v_enu):.2f} m/s"
