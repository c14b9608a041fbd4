"""Opens what was asked for and runs it: vehicles, links, clock, signals."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.life import phase_ns
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters import Parameters
from vehicle_sim.faults import Timed
from vehicle_sim.fleet import Seat, Spec, engine_for
from vehicle_sim.model.airframe import load
from vehicle_sim.model.faults import WindChange
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.services.store import MemoryStore, Store
from vehicle_sim.services.streams import POSITION_ONLY
from vehicle_sim.shell.endpoints import Endpoint, EndpointError, Udp, open_endpoint
from vehicle_sim.shell.files import DiskStore
from vehicle_sim.shell.lifeline import standard_input
from vehicle_sim.shell.limits import allow_sockets
from vehicle_sim.shell.pacer import Pacer, Redraw, Stop, monotonic_ns
from vehicle_sim.shell.urls import Url
from vehicle_sim.wire.signing import SigningKey
from vehicle_sim.world import LinkSpec, Log, World

EXIT_INTERRUPTED: Final = 130
EXIT_TERMINATED: Final = 0

SYSTEM_ID: Final[dict[Personality, str]] = {"px4": "MAV_SYS_ID", "ardupilot": "SYSID_THISMAV"}
LOGGED_MOST: Final = 50
"""Larger fleets keep no flight logs: they would fill the memory."""


@dataclass(frozen=True, slots=True)
class Berth:
    """One vehicle's place: its system id, where it stands, and the links of its own."""

    system: int
    home: Geodetic
    urls: tuple[Url, ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything that is decided before anything is opened."""

    personality: Personality
    airframe: str
    berths: tuple[Berth, ...]
    shared: tuple[Url, ...]  # links on which all vehicles speak
    seed: int
    speedup: Fraction
    params: tuple[tuple[str, float], ...]
    wind: WindChange
    faults: tuple[Timed, ...]
    signing: SigningKey | None
    files: Path | None  # a directory to serve by FTP instead of memory
    sparse: bool = False  # only the position is streamed unasked


@dataclass(frozen=True, slots=True)
class Opened:
    """What stands: the world and its links in the order of their numbers."""

    world: World
    endpoints: tuple[Endpoint, ...]
    urls: tuple[tuple[Url, ...], ...]  # by vehicle, as they were opened
    start_ns: int


def launch(plan: Plan) -> Opened:
    """Raises ParameterError, EndpointError and OSError, with nothing left open."""
    parameters = [_parameters(plan, berth) for berth in plan.berths]
    stores = [_store(plan, berth) for berth in plan.berths]
    endpoints, links, urls = _open_links(plan)
    specs = [Spec(plan.seed, index, berth.home.lat_deg) for index, berth in enumerate(plan.berths)]
    engine = engine_for(specs, load(plan.airframe))
    unix_ns = time.time_ns()
    profile = PROFILES[plan.personality]
    if plan.sparse:
        profile = replace(profile, intervals_ns=POSITION_ONLY)
    servers: list[VehicleServer] = []
    for lane, berth in enumerate(plan.berths):
        vehicle = Autopilot(
            plan.personality, berth.home, plan.seed, lane, parameters[lane], Seat(engine, lane)
        )
        vehicle.inject(plan.wind)
        servers.append(
            VehicleServer(
                vehicle,
                profile,
                parameters[lane],
                berth.system,
                plan.speedup,
                unix_ns,
                store=stores[lane],
                logging=len(plan.berths) <= LOGGED_MOST,
                phase_ns=phase_ns(lane),
            )
        )
    start_ns = monotonic_ns()
    world = World(
        servers,
        links,
        plan.speedup,
        start_ns,
        signing=plan.signing,
        unix_start_ns=unix_ns,
        seed=plan.seed,
        faults=plan.faults,
    )
    return Opened(world, tuple(endpoints), tuple(map(tuple, urls)), start_ns)


def _parameters(plan: Plan, berth: Berth) -> Parameters:
    parameters = Parameters(plan.personality)
    parameters.set(SYSTEM_ID[plan.personality], berth.system)
    for name, value in plan.params:
        parameters.set(name, value)
    return parameters


def _store(plan: Plan, berth: Berth) -> Store:
    if plan.files is None:
        return MemoryStore()
    alone = len(plan.berths) == 1
    return DiskStore(plan.files if alone else plan.files / str(berth.system))


def _open_links(plan: Plan) -> tuple[list[Endpoint], list[LinkSpec], list[list[Url]]]:
    """The vehicles' own links first, then the shared ones."""
    own = [(index, url) for index, berth in enumerate(plan.berths) for url in berth.urls]
    wanted: list[tuple[int | None, Url]] = [*own, *((None, url) for url in plan.shared)]
    allow_sockets(len(wanted))
    endpoints: list[Endpoint] = []
    links: list[LinkSpec] = []
    urls: list[list[Url]] = [[] for _ in plan.berths]
    try:
        for vehicle, url in wanted:
            endpoint: Endpoint = open_endpoint(len(endpoints), url)
            endpoints.append(endpoint)
            links.append(LinkSpec(endpoint.peers, vehicle, not isinstance(endpoint, Udp)))
            for index in range(len(urls)) if vehicle is None else (vehicle,):
                urls[index].append(endpoint.url)
    except EndpointError:
        for endpoint in endpoints:
            endpoint.close()
        raise
    return endpoints, links, urls


def run(
    opened: Opened,
    announce: Callable[[], None],
    log: Callable[[Log], None],
    lifeline: bool,
    hear: Callable[[bytes], None] | None = None,
    redraw: Redraw | None = None,
) -> int:
    """Until a signal, or the lifeline's end; the exit code.  Says at the end how fast it was.

    What is announced can be relied on: signals have their meaning by then.  With a `lifeline`
    standard input's end ends the run, and Ctrl-C is the parent's affair.
    """
    stop = Stop()

    def ask_to_stop(signum: int, frame: object) -> None:
        stop.code = EXIT_INTERRUPTED if signum == signal.SIGINT else EXIT_TERMINATED

    signal.set_wakeup_fd(stop.waker.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, signal.SIG_IGN if lifeline else ask_to_stop)
    signal.signal(signal.SIGTERM, ask_to_stop)
    announce()
    for endpoint in opened.endpoints:
        if isinstance(endpoint, Udp):
            granted = f"receive buffer of {endpoint.granted_bytes} bytes granted"
            log(Log("debug", f"link{endpoint.link}", granted))
    pacer = Pacer(
        opened.world,
        opened.endpoints,
        opened.start_ns,
        log,
        stop,
        standard_input() if lifeline else None,
        hear,
        redraw,
    )
    try:
        return pacer.run()
    finally:
        lived = f"{opened.world.time_ns / 1e9:.1f} simulated seconds"
        log(Log("info", "pacer", f"{lived}, {pacer.mean_pace:.3g} times real time"))
        signal.set_wakeup_fd(-1)
        for endpoint in opened.endpoints:
            endpoint.close()
        stop.close()
