"""Opens what was asked for and runs it: vehicles, links, clock, signals."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Final, Literal, TypeAlias

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.decisions import phase_ns
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.choose_engine import engine_for
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.faults import WindChange
from vehicle_sim.plant.sensors import MEMS, SensorGrade
from vehicle_sim.services.profile import Profile, profile_of, without_camera
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.services.stream_sets import (
    POSITION_ONLY,
    REAL,
    StreamSets,
    mode_of_port,
    same_on_all,
    unasked,
)
from vehicle_sim.shell.endpoints import Endpoint, EndpointError, Udp, open_endpoint
from vehicle_sim.shell.files import DiskStore
from vehicle_sim.shell.limits import allow_sockets
from vehicle_sim.shell.pacer import Pacer, Redraw, Stop, monotonic_ns
from vehicle_sim.shell.parent import standard_input
from vehicle_sim.shell.urls import Url
from vehicle_sim.simulation.fault_script import Timed
from vehicle_sim.simulation.world import LinkSpec, Log, Peer, World
from vehicle_sim.storage.store import MemoryStore, Store
from vehicle_sim.wire.signing import SigningKey

StreamChoice: TypeAlias = Literal["full", "position", "real"]

EXIT_INTERRUPTED: Final = 130
EXIT_TERMINATED: Final = 0

LOGGED_MOST: Final = 50
"""Larger fleets keep no flight logs: they would fill the memory."""


@dataclass(frozen=True, slots=True)
class VehicleSetup:
    """One vehicle's place: its system id, where it stands, and the links of its own."""

    system: int
    home: Geodetic
    urls: tuple[Url, ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything that is decided before anything is opened."""

    personality: Personality
    firmware: Firmware
    airframe: str
    vehicles: tuple[VehicleSetup, ...]
    shared: tuple[Url, ...]  # links on which all vehicles speak
    seed: int
    speedup: Fraction
    params: tuple[tuple[str, float], ...]
    wind: WindChange
    faults: tuple[Timed, ...]
    signing: SigningKey | None
    files: Path | None  # a directory to serve by FTP instead of memory
    streams: StreamChoice = "full"  # what is sent unasked
    view: Url | None = None  # who is sent the truth
    boot: Boot = "quick"
    camera: bool = True
    operator_control: bool = False  # one station at a time commands
    grade: SensorGrade = MEMS
    param_file: tuple[tuple[str, float], ...] = ()  # names that are in no table are kept, too


@dataclass(frozen=True, slots=True)
class Opened:
    """What stands: the world and its links in the order of their numbers."""

    world: World
    endpoints: tuple[Endpoint, ...]
    urls: tuple[tuple[Url, ...], ...]  # by vehicle, as they were opened
    start_ns: int


def launch(plan: Plan) -> Opened:
    """Raises ParameterError, EndpointError and OSError, with nothing left open."""
    parameters = [parameters_of(plan, setup) for setup in plan.vehicles]
    stores = [_store(plan, setup) for setup in plan.vehicles]
    endpoints, links, urls = _open_links(plan)
    viewer = _open_view(plan, endpoints)
    specs = [
        VehicleSpec(plan.seed, index, setup.home.lat_deg)
        for index, setup in enumerate(plan.vehicles)
    ]
    engine = engine_for(specs, load(plan.airframe), plan.grade)
    unix_ns = time.time_ns()
    profile = profile_of(plan.personality, plan.firmware)
    if not plan.camera:
        profile = without_camera(profile)
    stream_sets = _stream_sets(plan, profile)
    servers: list[VehicleServer] = []
    for lane, setup in enumerate(plan.vehicles):
        vehicle = Autopilot(
            plan.personality,
            setup.home,
            plan.seed,
            lane,
            parameters[lane],
            Seat(engine, lane),
            plan.boot,
            plan.camera,
        )
        vehicle.inject(plan.wind)
        servers.append(
            VehicleServer(
                vehicle,
                profile,
                parameters[lane],
                setup.system,
                plan.speedup,
                unix_ns,
                store=stores[lane],
                logging=len(plan.vehicles) <= LOGGED_MOST,
                phase_ns=phase_ns(lane),
                stream_sets=stream_sets,
                operator_control=plan.operator_control,
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
        viewer=viewer,
    )
    return Opened(world, tuple(endpoints), tuple(map(tuple, urls)), start_ns)


def _stream_sets(plan: Plan, profile: Profile) -> StreamSets:
    match plan.streams:
        case "full":
            return unasked(profile)
        case "position":
            return same_on_all(POSITION_ONLY)
        case "real":
            return REAL[plan.personality]


def parameters_of(plan: Plan, setup: VehicleSetup) -> Parameters:
    """A reset keeps the system id and what was set at the start.  Raises ParameterError."""
    others = [name for name, _ in plan.param_file]
    parameters = Parameters(plan.personality, plan.firmware, others)
    for name, value in plan.param_file:
        parameters.start_with(name, value)
    parameters.start_as(setup.system)
    for name, value in plan.params:
        parameters.start_with(name, value)
    return parameters


def _store(plan: Plan, setup: VehicleSetup) -> Store:
    if plan.files is None:
        return MemoryStore()
    alone = len(plan.vehicles) == 1
    return DiskStore(plan.files if alone else plan.files / str(setup.system))


def _open_links(plan: Plan) -> tuple[list[Endpoint], list[LinkSpec], list[list[Url]]]:
    """The vehicles' own links first, then the shared ones."""
    own = [(index, url) for index, vehicle in enumerate(plan.vehicles) for url in vehicle.urls]
    wanted: list[tuple[int | None, Url]] = [*own, *((None, url) for url in plan.shared)]
    allow_sockets(len(wanted))
    endpoints: list[Endpoint] = []
    links: list[LinkSpec] = []
    urls: list[list[Url]] = [[] for _ in plan.vehicles]
    try:
        for vehicle, url in wanted:
            endpoint: Endpoint = open_endpoint(len(endpoints), url)
            endpoints.append(endpoint)
            mode = url.mode or mode_of_port(url.port)
            links.append(LinkSpec(endpoint.peers, vehicle, not isinstance(endpoint, Udp), mode))
            for index in range(len(urls)) if vehicle is None else (vehicle,):
                urls[index].append(endpoint.url)
    except EndpointError:
        for endpoint in endpoints:
            endpoint.close()
        raise
    return endpoints, links, urls


def _open_view(plan: Plan, endpoints: list[Endpoint]) -> Peer | None:
    """The viewer's address; its link comes after those of the vehicles."""
    if plan.view is None:
        return None
    try:
        endpoint = open_endpoint(len(endpoints), plan.view)
    except EndpointError:
        for each in endpoints:
            each.close()
        raise
    endpoints.append(endpoint)
    return endpoint.peers[0]


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
