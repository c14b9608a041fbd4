"""`vehicle-sim`: vehicles on the MAVLink.  Heavy imports wait until there is work for them."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Final, Literal

import click

from vehicle_sim.autopilot.firmware import FIRMWARES, Firmware, FirmwareError, firmware_of
from vehicle_sim.options import AssignmentType, HomeType, SeedType, SpeedType, WindType

if TYPE_CHECKING:
    from vehicle_sim.autopilot.boot import Boot
    from vehicle_sim.reporting import Launch, Reporter
    from vehicle_sim.shell.pacer import Redraw
    from vehicle_sim.shell.runtime import Opened, Plan, StreamChoice
    from vehicle_sim.simulation.fault_script import Timed

EXIT_USAGE: Final = 2
EXIT_FILE: Final = 4
EXIT_ADDRESS: Final = 9

HOMES: Final = {
    "px4": (47.397742, 8.545594, 488.0),
    "ardupilot": (-35.363262, 149.165237, 584.0),
}
APART_M: Final = 10.0
"""Vehicles of a fleet stand in rows, so far from each other: more than the 5 m that ground stations
keep between two, with what the estimates of both wander by."""
METRES_PER_DEGREE: Final = 111_319.49
SYSTEMS_MAX: Final = 250
"""Vehicles that can be told apart on one link; ids above are ground stations'."""
NAME_MAX: Final = 16
"""Letters of a parameter's name."""
STATION: Final = "udpout://127.0.0.1:14550"
AIRFRAMES: Final = ("s500", "racer250", "sih")


@dataclass(frozen=True, slots=True)
class Options:
    autopilot: Literal["px4", "ardupilot"]
    firmware: Firmware
    boot: Boot
    camera: Literal["still", "none"]
    operator_control: bool
    count: int
    airframe: str
    sensors: Literal["good", "real"]
    home: tuple[float, float, float]
    seed: int
    speedup: Fraction
    links: tuple[str, ...]
    params: tuple[tuple[str, float], ...]
    param_file: str | None
    wind: tuple[float, float, float]
    fault: str | None
    signing_key: str | None
    files: str | None
    sysid: int
    streams: StreamChoice
    view: str | None
    lifeline: bool
    control: bool
    plain: bool
    verbose: bool


class _TooManyError(Exception):
    """A shared link cannot tell so many vehicles apart."""


class _BadFileError(Exception):
    """A file that was named cannot be used; the message says why."""


@click.command(
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Examples: vehicle-sim --autopilot ardupilot --wind 8,270,1.5  |  "
    "vehicle-sim --count 20 --port 14550  |  vehicle-sim --speedup 10 --fault bad_day.toml",
)
@click.option(
    "--autopilot",
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="Whose MAVLink it speaks, and how it flies.",
)
@click.option(
    "--firmware",
    type=click.Choice([each for firmwares in FIRMWARES.values() for each in firmwares]),
    help="Which generation of it: its version and the names of its parameters.  px4 has 1.14 (the "
    "default) and 1.15, ardupilot 4.5 (the default) and 4.7.",
)
@click.option(
    "--boot",
    type=click.Choice(["quick", "real"]),
    default="quick",
    show_default=True,
    help="How long it takes to start up: ready to arm after half a second, or as the real one "
    "(px4 9 s, ardupilot 41 s), with its refusals and texts meanwhile.",
)
@click.option(
    "--camera",
    type=click.Choice(["still", "none"]),
    default="still",
    show_default=True,
    help="One that takes pictures, or none, as on a bare autopilot.",
)
@click.option(
    "--operator-control",
    is_flag=True,
    help="One ground station at a time commands it, by MAVLink's operator control protocol.",
)
@click.option(
    "--count",
    type=click.IntRange(1, 10_000),
    default=1,
    show_default=True,
    help="How many vehicles, with system ids that follow each other.  MAVLink has ids for 250 on "
    "one link: a larger fleet has links of its own only, and its ids begin anew.",
)
@click.option(
    "--airframe",
    type=click.Choice(AIRFRAMES),
    default="s500",
    show_default=True,
    help="What it is built of.",
)
@click.option(
    "--sensors",
    type=click.Choice(["good", "real"]),
    default="good",
    show_default=True,
    help="How true its sensors are: good ones, with which a flight stays where its plan says, or "
    "as measured in life (GPS wanders by a metre, the barometer drifts, the rotors shake).",
)
@click.option("--home", type=HomeType(), help="Where it stands; the autopilot's usual place.")
@click.option("--seed", type=SeedType(), default=1, show_default=True, help="Of all noise.")
@click.option(
    "--speedup", type=SpeedType(), default="1", show_default=True, help="Times real time."
)
@click.option("--wind", type=WindType(), default="0", help="In m/s and degrees, with gusts.")
@click.option(
    "--fault",
    type=click.Path(dir_okay=False),
    help="TOML file of what goes wrong, and when; bad_day.toml is shipped.",
)
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    help="One UDP endpoint for all vehicles that waits here (0: any free one), in place of the "
    "usual ones.",
)
@click.option(
    "--link",
    "links",
    metavar="URL[,MODE]",
    multiple=True,
    help="Replaces the usual links, for all.  MODE is normal or onboard, for --streams real.",
)
@click.option(
    "--param", "params", type=AssignmentType(), multiple=True, help="Sets a parameter at start."
)
@click.option(
    "--param-file",
    type=click.Path(dir_okay=False),
    help="Starts with the parameters of this file, a line `NAME value` or `NAME,value` each.  "
    "Those that it does not have are served as floats, and nothing depends on them.",
)
@click.option(
    "--streams",
    type=click.Choice(["full", "real", "position"]),
    default="full",
    show_default=True,
    help="What is sent unasked.  full: all that clients look for, on every link.  real: what the "
    "real autopilot sends; px4 has one set for ground stations and one for programs on board "
    "(UDP ports 14540 to 14549, or ,onboard behind the URL of a link), ardupilot sends HEARTBEAT "
    "and TIMESYNC.  position: the position at 10 Hz and a heartbeat, which is what 1,000 vehicles "
    "have time for.",
)
@click.option(
    "--view",
    metavar="URL",
    help="Sends the true state to a 3-D viewer: HIL_STATE_QUATERNION at 50 Hz and HEARTBEAT, for "
    "PX4's Hawkeye to udp://127.0.0.1:19410.",
)
@click.option("--sysid", type=click.IntRange(1, 250), default=1, show_default=True)
@click.option(
    "--files",
    type=click.Path(exists=True, file_okay=False),
    help="Directory for its files (MAVLink FTP, logs) instead of memory.",
)
@click.option(
    "--signing-key",
    type=click.Path(dir_okay=False),
    help="File with the MAVLink 2 signing key: 32 bytes, 64 hex digits or a passphrase.",
)
@click.option("--lifeline", is_flag=True, help="Ends when standard input does; Ctrl-C is ignored.")
@click.option("--control", is_flag=True, help="JSON lines on standard input and output, for tests.")
@click.option("--plain", is_flag=True, help="Plain lines on a terminal too.")
@click.option("-v", "--verbose", is_flag=True, help="Debug lines as well.")
@click.version_option(
    package_name="mavgate", prog_name="vehicle-sim", message="%(prog)s %(version)s"
)
def main(
    autopilot: Literal["px4", "ardupilot"],
    firmware: str | None,
    boot: Boot,
    camera: Literal["still", "none"],
    operator_control: bool,
    count: int,
    airframe: str,
    sensors: Literal["good", "real"],
    home: tuple[float, float, float] | None,
    seed: int,
    speedup: Fraction,
    wind: tuple[float, float, float],
    fault: str | None,
    port: int | None,
    links: tuple[str, ...],
    params: tuple[tuple[str, float], ...],
    param_file: str | None,
    streams: StreamChoice,
    view: str | None,
    sysid: int,
    files: str | None,
    signing_key: str | None,
    lifeline: bool,
    control: bool,
    plain: bool,
    verbose: bool,
) -> None:
    """Simulated quadrotors that speak MAVLink like PX4 or ArduPilot.

    On a terminal it shows a live line per vehicle, while it is in the foreground; on a pipe and in
    the background it prints what to connect to, then a line for everything that happens.
    """
    try:
        played = firmware_of(autopilot, firmware)
    except FirmwareError as wrong:
        raise click.BadParameter(str(wrong), param_hint="--firmware") from None
    if port is not None:
        links = (*links, f"udpin://127.0.0.1:{port}")
    sys.exit(
        run(
            Options(
                autopilot=autopilot,
                firmware=played,
                boot=boot,
                camera=camera,
                operator_control=operator_control,
                count=count,
                airframe=airframe,
                sensors=sensors,
                home=home or HOMES[autopilot],
                seed=seed,
                speedup=speedup,
                links=links,
                params=params,
                param_file=param_file,
                wind=wind,
                fault=fault,
                signing_key=signing_key,
                files=files,
                sysid=sysid,
                streams=streams,
                view=view,
                lifeline=lifeline or control,
                control=control,
                plain=plain,
                verbose=verbose,
            )
        )
    )


OWN_LINKS: Final[dict[str, Callable[[int], str]]] = {
    "px4": lambda index: f"udpout://127.0.0.1:{14540 + index + (index >= 10)}",
    "ardupilot": lambda index: f"tcpin://127.0.0.1:{5760 + 10 * index}",
}
"""px4: its API port, leaving out the ground station's 14550; ardupilot: its TCP port."""


def own_link(autopilot: str, index: int) -> str:
    """The URL of a vehicle's own link, by its place in the fleet."""
    return OWN_LINKS[autopilot](index)


def place(home: tuple[float, float, float], index: int, count: int) -> tuple[float, float, float]:
    """In rows to the north and east of the first."""
    lat_deg, lon_deg, alt_m = home
    side = 1
    while side * side < count:
        side += 1
    north_m, east_m = APART_M * (index // side), APART_M * (index % side)
    from math import cos, radians

    return (
        lat_deg + north_m / METRES_PER_DEGREE,
        lon_deg + east_m / (METRES_PER_DEGREE * cos(radians(lat_deg))),
        alt_m,
    )


def plan_of(options: Options) -> Plan:
    """Raises UrlError, FaultFileError, SigningKeyError, _BadFileError and _TooManyError."""
    from pathlib import Path

    from vehicle_sim.autopilot.interface import Geodetic
    from vehicle_sim.plant.faults import WindChange
    from vehicle_sim.plant.sensors import GRADES
    from vehicle_sim.shell.runtime import Plan, VehicleSetup
    from vehicle_sim.shell.urls import parse, parse_view
    from vehicle_sim.simulation.fault_script import parse as parse_faults
    from vehicle_sim.wire.signing import parse_key

    count = options.count
    usual = not options.links
    if count > SYSTEMS_MAX and not usual:
        raise _TooManyError(
            f"{count} vehicles cannot share a link: MAVLink has system ids for {SYSTEMS_MAX}.  "
            "Without --port and --link each has a link of its own."
        )
    together = (STATION,) if count <= SYSTEMS_MAX else ()
    vehicles = tuple(
        VehicleSetup(
            system=1 + (options.sysid - 1 + index) % SYSTEMS_MAX,
            home=Geodetic(*place(options.home, index, count)),
            urls=(parse(f"{own_link(options.autopilot, index)},onboard"),) if usual else (),
        )
        for index in range(count)
    )
    faults: tuple[Timed, ...] = ()
    if options.fault is not None:
        text = _fault_file(options.fault).decode("utf-8", "replace")
        faults = parse_faults(text, options.fault)
    north, east, gust = options.wind
    return Plan(
        personality=options.autopilot,
        firmware=options.firmware,
        boot=options.boot,
        camera=options.camera == "still",
        operator_control=options.operator_control,
        airframe=options.airframe,
        vehicles=vehicles,
        shared=tuple(map(parse, together if usual else options.links)),
        seed=options.seed,
        speedup=options.speedup,
        params=options.params,
        param_file=() if options.param_file is None else _assignments(options.param_file),
        wind=WindChange((north, east, 0.0), gust),
        faults=faults,
        signing=None if options.signing_key is None else parse_key(_read(options.signing_key)),
        files=None if options.files is None else Path(options.files),
        streams=options.streams,
        view=None if options.view is None else parse_view(options.view),
        grade=GRADES[options.sensors],
    )


def _assignments(path: str) -> tuple[tuple[str, float], ...]:
    """The parameters of a file.  Raises _BadFileError."""
    found: list[tuple[str, float]] = []
    for number, line in enumerate(_read(path).decode("utf-8", "replace").splitlines(), start=1):
        parts = line.split("#", 1)[0].replace(",", " ").split()
        if not parts:
            continue
        try:
            name, value = parts
            if len(name) > NAME_MAX or not name.isascii():
                raise ValueError(name)
            found.append((name, float(value)))
        except ValueError:
            wrong = f"{path}:{number}: {line.strip()!r} is not `NAME value`"
            raise _BadFileError(wrong) from None
    return tuple(found)


def _read(path: str) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise _BadFileError(f"{path}: {error.strerror}") from error


def _fault_file(name: str) -> bytes:
    """The file as typed, else the shipped one of that name."""
    from pathlib import Path

    shipped = Path(__file__).with_name("examples") / name
    if not Path(name).exists() and shipped.is_file():
        return _read(str(shipped))
    try:
        return _read(name)
    except _BadFileError as error:
        hint = "Write one like bad_day.toml, which is shipped: vehicle-sim --fault bad_day.toml"
        raise _BadFileError(f"{error}\nHint: {hint}") from error


def run(options: Options) -> int:
    """The exit code."""
    gc.disable()  # what is loaded and built from here on stays: there is nothing to collect
    from vehicle_sim.autopilot.parameters.parameters import ParameterError
    from vehicle_sim.shell.endpoints import EndpointError
    from vehicle_sim.shell.runtime import launch
    from vehicle_sim.shell.urls import UrlError
    from vehicle_sim.simulation.fault_script import FaultFileError
    from vehicle_sim.wire.signing import SigningKeyError

    try:
        opened = launch(plan := plan_of(options))
    except (UrlError, ParameterError, _TooManyError) as wrong:
        return _fail(str(wrong), EXIT_USAGE)
    except (FaultFileError, SigningKeyError, _BadFileError) as wrong:
        return _fail(str(wrong), EXIT_FILE)
    except EndpointError as wrong:
        return _fail(f"{wrong}\n{_hint(wrong.cause)}", EXIT_ADDRESS)
    outlet = _outlet(options)
    gc.freeze()
    gc.enable()
    try:
        return _fly(options, opened, _launched(options, plan, opened), outlet)
    finally:
        outlet.close()


def _fly(options: Options, opened: Opened, launch: Launch, outlet: Reporter) -> int:
    from vehicle_sim.shell.runtime import run as run_world

    heard = _hearing(opened, outlet) if options.control else None
    redraw = _redraw(options, opened, outlet) if outlet.redraw_ns else None
    return run_world(
        opened, lambda: outlet.ready(launch), outlet.log, options.lifeline, heard, redraw
    )


def _hearing(opened: Opened, outlet: Reporter) -> Callable[[bytes], None]:
    """What is done with standard input under --control."""
    from vehicle_sim.simulation.control_line import Lines, answer

    lines = Lines()

    def hear(data: bytes) -> None:
        for line in lines.feed(data):
            outlet.answer(answer(line, opened.world))

    return hear


def _redraw(options: Options, opened: Opened, outlet: Reporter) -> Redraw:
    """The live page, drawn again and again."""
    from vehicle_sim.live_page import Rhythm, statuses
    from vehicle_sim.shell.pacer import Pace, Redraw

    def show(pace: Pace) -> None:
        world = opened.world
        rhythm = Rhythm(world.time_ns / 1e9, float(options.speedup), pace.reached)
        outlet.show(statuses(world.servers, world.links), rhythm)

    return Redraw(outlet.redraw_ns, show)


def _outlet(options: Options) -> Reporter:
    from importlib.util import find_spec

    from vehicle_sim.reporting import Json, Live, Plain

    threshold = "debug" if options.verbose else "info"
    if options.control:
        return Json(threshold)
    if sys.stdout.isatty() and not options.plain and not options.lifeline and find_spec("rich"):
        return Live(threshold)  # an installation of the vehicle alone has no rich
    return Plain(threshold)


def _launched(options: Options, plan: Plan, opened: Opened) -> Launch:
    from vehicle_sim.reporting import Contact, Launch

    lat_deg, lon_deg, alt_m = options.home
    many = f"{options.count} " if options.count > 1 else ""
    plural = "s" if options.count > 1 else ""
    what = (
        f"{many}{options.autopilot} quadrotor{plural} at {lat_deg:.6f}, {lon_deg:.6f}, "
        f"{alt_m:g} m, seed {options.seed}, speed {float(options.speedup):g}"
    )
    contacts = [
        Contact(vehicle.system, urls)
        for vehicle, urls in zip(plan.vehicles, opened.urls, strict=True)
    ]
    return Launch(what, tuple(contacts))


def _hint(cause: OSError) -> str:
    import errno

    if cause.errno == errno.EADDRINUSE:
        return "Hint: another program has this port; end it, or choose one with --port or --link."
    if cause.errno in (errno.EACCES, errno.EPERM):
        return "Hint: ports below 1024 are for the system; choose a higher one."
    if cause.errno == errno.EMFILE:
        return (
            "Hint: too many open files; raise the hard limit (ulimit -Hn), or let up to "
            f"{SYSTEMS_MAX} vehicles share one link with --port."
        )
    return "Hint: is the address one of this machine's?"


def _fail(text: str, code: int) -> int:
    click.echo(f"vehicle-sim: {text}", err=True)
    return code
