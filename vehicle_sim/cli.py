"""`vehicle-sim`: a vehicle on the MAVLink.  Heavy imports wait until there is work for them."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Literal

import click

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vehicle_sim.autopilot.interface import Geodetic
    from vehicle_sim.shell.urls import Url

EXIT_USAGE = 2
EXIT_ADDRESS = 9
EXIT_INTERRUPTED = 130
EXIT_TERMINATED = 0

HOMES = {
    "px4": (47.397742, 8.545594, 488.0),
    "ardupilot": (-35.363262, 149.165237, 584.0),
}
SYSTEM_ID = {"px4": "MAV_SYS_ID", "ardupilot": "SYSID_THISMAV"}
LEVELS = {"debug": 0, "info": 1, "warning": 2, "error": 3, "fatal": 4}
SPEEDUP_MAX = 200


@dataclass(frozen=True, slots=True)
class Options:
    autopilot: Literal["px4", "ardupilot"]
    home: tuple[float, float, float]
    seed: int
    speedup: Fraction
    links: tuple[str, ...]
    params: tuple[tuple[str, float], ...]
    lifeline: bool
    sysid: int
    verbose: bool


class HomeType(click.ParamType[tuple[float, float, float]]):
    """LAT,LON,ALT: degrees, degrees, metres above mean sea level."""

    name = "LAT,LON,ALT"

    def convert(
        self,
        value: str | tuple[float, float, float],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[float, float, float]:
        if not isinstance(value, str):
            return value
        try:
            lat_deg, lon_deg, alt_m = (float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r} is not LAT,LON,ALT, as in 47.397742,8.545594,488", param, ctx)
        if not (abs(lat_deg) < 90.0 and abs(lon_deg) <= 180.0 and -500.0 <= alt_m <= 9000.0):
            self.fail(
                f"{value!r} is not on Earth: latitude within 90, longitude within 180 degrees, "
                "height from -500 to 9000 m",
                param,
                ctx,
            )
        return (lat_deg, lon_deg, alt_m)


class AssignmentType(click.ParamType[tuple[str, float]]):
    """NAME=VALUE."""

    name = "NAME=VALUE"

    def convert(
        self,
        value: str | tuple[str, float],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> tuple[str, float]:
        if not isinstance(value, str):
            return value
        name, _, number = value.partition("=")
        try:
            return (name, float(number))
        except ValueError:
            self.fail(f"{value!r} is not NAME=VALUE, as in MIS_TAKEOFF_ALT=5", param, ctx)


class SpeedType(click.ParamType[Fraction]):
    """How many simulated seconds make a second."""

    name = "FACTOR"

    def convert(
        self, value: str | Fraction, param: click.Parameter | None, ctx: click.Context | None
    ) -> Fraction:
        if not isinstance(value, str):
            return value
        try:
            factor = Fraction(value).limit_denominator(1000)
        except (ValueError, ZeroDivisionError):
            self.fail(f"{value!r} is no number", param, ctx)
        if not 0 < factor <= SPEEDUP_MAX:
            self.fail(f"{value} is not in 0.001 to {SPEEDUP_MAX}", param, ctx)
        return factor


@click.command(
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Example: vehicle-sim --autopilot px4 --seed 7 --link udpout://127.0.0.1:14540",
)
@click.option(
    "--autopilot",
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="Whose MAVLink it speaks, and how it flies.",
)
@click.option("--home", type=HomeType(), help="Where it stands; the autopilot's usual place.")
@click.option("--seed", type=int, default=1, show_default=True, help="Of all noise.")
@click.option(
    "--speedup", type=SpeedType(), default="1", show_default=True, help="Times real time."
)
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    help="One UDP endpoint that waits here, in place of the usual ones.",
)
@click.option("--link", "links", metavar="URL", multiple=True, help="Replaces the usual links.")
@click.option(
    "--param", "params", type=AssignmentType(), multiple=True, help="Sets a parameter at start."
)
@click.option("--lifeline", is_flag=True, help="Ends when standard input does; Ctrl-C is ignored.")
@click.option("--sysid", type=click.IntRange(1, 250), default=1, show_default=True)
@click.option("-v", "--verbose", is_flag=True, help="Debug lines as well.")
def main(
    autopilot: Literal["px4", "ardupilot"],
    home: tuple[float, float, float] | None,
    seed: int,
    speedup: Fraction,
    port: int | None,
    links: tuple[str, ...],
    params: tuple[tuple[str, float], ...],
    lifeline: bool,
    sysid: int,
    verbose: bool,
) -> None:
    """A simulated quadrotor that speaks MAVLink like PX4 or ArduPilot.

    It prints what to connect to, then a line for everything that happens.
    """
    if port is not None:
        links = (*links, f"udpin://127.0.0.1:{port}")
    sys.exit(
        run(
            Options(
                autopilot=autopilot,
                home=home or HOMES[autopilot],
                seed=seed,
                speedup=speedup,
                links=links or default_links(autopilot, 0),
                params=params,
                lifeline=lifeline,
                sysid=sysid,
                verbose=verbose,
            )
        )
    )


def default_links(autopilot: str, index: int) -> tuple[str, ...]:
    """px4: API and ground station; ardupilot: its TCP port and the ground station."""
    station = "udpout://127.0.0.1:14550"
    if autopilot == "px4":
        return (f"udpout://127.0.0.1:{14540 + index}", station)
    return (f"tcpin://127.0.0.1:{5760 + 10 * index}", station)


def run(options: Options) -> int:
    """The exit code."""
    import signal
    import time

    from vehicle_sim.autopilot.autopilot import Autopilot
    from vehicle_sim.autopilot.interface import Geodetic
    from vehicle_sim.autopilot.parameters import ParameterError, Parameters
    from vehicle_sim.services.profile import PROFILES
    from vehicle_sim.services.server import VehicleServer
    from vehicle_sim.shell.endpoints import EndpointError, Udp, open_endpoint
    from vehicle_sim.shell.lifeline import standard_input
    from vehicle_sim.shell.pacer import Pacer, Stop, monotonic_ns
    from vehicle_sim.shell.urls import UrlError, parse
    from vehicle_sim.world import LinkSpec, Log, World

    parameters = Parameters(options.autopilot)
    try:
        urls = [parse(link) for link in options.links]
        parameters.set(SYSTEM_ID[options.autopilot], options.sysid)
        for name, value in options.params:
            parameters.set(name, value)
    except (UrlError, ParameterError) as wrong:
        return _fail(str(wrong), EXIT_USAGE)

    endpoints = []
    for number, url in enumerate(urls):
        try:
            endpoints.append(open_endpoint(number, url))
        except EndpointError as wrong:
            for endpoint in endpoints:
                endpoint.close()
            return _fail(f"{wrong}\n{_hint(wrong.cause)}", EXIT_ADDRESS)

    home = Geodetic(*options.home)
    vehicle = Autopilot(options.autopilot, home, options.seed, params=parameters)
    server = VehicleServer(
        vehicle,
        PROFILES[options.autopilot],
        parameters,
        options.sysid,
        options.speedup,
        time.time_ns(),
    )
    start_ns = monotonic_ns()
    world = World(
        [server], [LinkSpec(endpoint.peers) for endpoint in endpoints], options.speedup, start_ns
    )

    stop = Stop()

    def ask_to_stop(signum: int, frame: object) -> None:
        stop.code = EXIT_INTERRUPTED if signum == signal.SIGINT else EXIT_TERMINATED

    signal.set_wakeup_fd(stop.waker.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, signal.SIG_IGN if options.lifeline else ask_to_stop)
    signal.signal(signal.SIGTERM, ask_to_stop)

    threshold = LEVELS["debug" if options.verbose else "info"]

    def write(line: Log) -> None:
        if LEVELS[line.level] >= threshold:
            _print(f"{line.level.upper()} {line.node}: {line.text}")

    _announce(options, home, urls)
    for endpoint in endpoints:
        if isinstance(endpoint, Udp):
            granted = f"receive buffer of {endpoint.granted_bytes} bytes granted"
            write(Log("debug", f"link{endpoint.link}", granted))
    try:
        return Pacer(
            world,
            endpoints,
            start_ns,
            write,
            stop,
            standard_input() if options.lifeline else None,
        ).run()
    finally:
        signal.set_wakeup_fd(-1)
        for endpoint in endpoints:
            endpoint.close()
        stop.close()


def _announce(options: Options, home: Geodetic, urls: Sequence[Url]) -> None:
    place = f"{home.lat_deg:.6f}, {home.lon_deg:.6f}, {home.alt_amsl_m:g} m"
    _print(
        f"INFO vehicle{options.sysid}: {options.autopilot} quadrotor at {place}, "
        f"seed {options.seed}, speed {float(options.speedup):g}"
    )
    for url in urls:
        _print(f"INFO vehicle{options.sysid}: {_CONNECT[url.kind.value].format(url=url)}")


_CONNECT = {
    "udpout": "sends to {url.host}:{url.port}; connect with udpin://{url.host}:{url.port}",
    "udpin": "listens on UDP port {url.port}; connect with udpout://{url.host}:{url.port}",
    "tcpin": "listens on TCP port {url.port}; connect with tcpout://{url.host}:{url.port}",
    "tcpout": "connects to TCP port {url.port} of {url.host}; wait for it with "
    "tcpin://{url.host}:{url.port}",
}


def _print(line: str) -> None:
    """To whoever still reads."""
    try:
        click.echo(line)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader is gone; the vehicle flies on, as its own failsafes have it.
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def _hint(cause: OSError) -> str:
    import errno

    if cause.errno == errno.EADDRINUSE:
        return "Hint: another program has this port; end it, or choose one with --port or --link."
    if cause.errno in (errno.EACCES, errno.EPERM):
        return "Hint: ports below 1024 are for the system; choose a higher one."
    return "Hint: is the address one of this machine's?"


def _fail(text: str, code: int) -> int:
    click.echo(f"vehicle-sim: {text}", err=True)
    return code
