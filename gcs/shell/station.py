"""The station process: `python -m gcs.shell.station '<StationConfig as JSON>'`.

Opens what the configuration names, runs the one loop, closes in order: first the vehicle is seen
safe (the session sees to that), then the log is closed, then a vehicle of our own is stopped.
Speaks JSON lines with its operator (`gcs.ipc`) and writes nothing else to standard output.
"""

from __future__ import annotations

import gc
import socket
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import msgspec

from gcs import __version__, config, ipc
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.gate.policy.policy import Policy
from gcs.policy_digest import policy_digest
from gcs.policy_file import PolicyFileError, load_policy
from gcs.record.compact import compact_in_background
from gcs.record.parts import Rotation
from gcs.record.writer import Recorder, RecorderError
from gcs.session.effects import EVERYONE
from gcs.session.setup import Setup
from gcs.shell import sockets
from gcs.shell.client_ports import ClientPorts
from gcs.shell.client_table import ClientLimits
from gcs.shell.clock import Clock
from gcs.shell.disk_watch import DiskWatch, free_in
from gcs.shell.endpoints import EndpointError, parse_endpoint
from gcs.shell.environment import environment
from gcs.shell.key_files import KeyFileError, read_key
from gcs.shell.local_socket import LocalSocket
from gcs.shell.loop import Loop
from gcs.shell.operator_sockets import OperatorSockets
from gcs.shell.pipes import LineSink, LineSource
from gcs.shell.recording import Recording
from gcs.shell.rule_process import RuleError, RuleProcess
from gcs.shell.signals import SignalSource
from gcs.shell.sim import SimProcess
from gcs.shell.stations import Unsafe
from gcs.station.session import Session
from gcs.station.signatures import Keys

DRAIN_WAIT_S = 5.0
"""How long the last events wait for an operator's program that does not read them at once."""


@dataclass(frozen=True, slots=True)
class CannotStartError(Exception):
    """What keeps the station from starting, as the operator is told it."""

    exit_code: int
    text: str
    hint: str


def main(argument: str) -> int:
    """Run one session; returns the process's exit code."""
    signals = SignalSource()
    screen = LineSink(sys.stdout.fileno())
    try:
        return _run(config.decode(argument), screen, signals)
    except CannotStartError as error:
        screen.put(ipc.encode(ipc.Trouble(error.text, error.hint, error.exit_code)))
        screen.put(ipc.encode(ipc.Bye(error.exit_code, "", error.text)))
        return error.exit_code
    finally:
        screen.drain(DRAIN_WAIT_S)


def _run(setup: StationConfig, screen: LineSink, signals: SignalSource) -> int:
    policy, policy_text = _read_policy(setup)
    keys = _read_keys(setup)
    clock = Clock(setup.speedup)
    with ExitStack() as opened:
        rule, rule_text = _start_rule(setup, policy, opened)
        links = _open_links(setup, opened)
        client_ports = _open_client_ports(setup, policy, links, opened)
        recording = _open_recording(setup, clock)
        opened.callback(lambda: recording.close(clock.now_ns()))
        sim = None
        if setup.sim is not None:
            sim = SimProcess(setup.sim, links[0].port)
            opened.callback(sim.stop)
        local, operators = _open_local_socket(setup, policy, links, recording, screen, opened)
        session = Session(
            Setup(
                config=setup,
                version=__version__,
                policy=policy,
                policy_text=policy_text,
                endpoints=tuple(link.describe() for link in links),
                log_path=recording.path,
                streams=frozenset(n for n, link in enumerate(links) if link.stream),
                waiting=frozenset(n for n, link in enumerate(links) if link.endpoint.listens),
                environment=environment(),
                client_ports=client_ports.describe() if client_ports else (),
                rule_text=rule_text,
            ),
            clock.now_ns(),
            keys,
        )
        operator = LineSource(sys.stdin.fileno())
        # All that is there lives as long as the process.  Looking through it again at every full
        # collection would stop the loop (153 ms were seen on a loaded machine).
        gc.collect()
        gc.freeze()
        finish = Loop(
            session,
            clock,
            links,
            operator,
            screen,
            recording,
            signals,
            sim,
            operators,
            local.describe if local else lambda _: None,
            client_ports,
            rule,
        ).run()
        if session.nothing_heard:
            recording.discard(clock.now_ns())
        whole = recording.close(clock.now_ns())
        exit_code = finish.exit_code or (0 if whole else ExitCode.RECORDER)
        bye = ipc.encode(ipc.Bye(exit_code, recording.path, finish.sentence))
        if operators is not None:
            operators.tell(bye, EVERYONE, droppable=False, last=True)
    screen.put(bye)
    if setup.compact:
        compact_in_background(recording.parts)
    return exit_code


def _read_policy(setup: StationConfig) -> tuple[Policy, str]:
    """The policy as it holds in this station, and its text for the record."""
    try:
        policy, text = load_policy(setup.policy_path or "default")
    except PolicyFileError as error:
        raise CannotStartError(ExitCode.BAD_FILE, str(error), error.hint) from error
    if policy.retarget == "clients":
        retarget: Literal["refuse", "replace"] = "replace" if setup.clients else "refuse"
        policy = msgspec.structs.replace(policy, retarget=retarget)
    return policy, text


def _start_rule(
    setup: StationConfig, policy: Policy, opened: ExitStack
) -> tuple[RuleProcess | None, str | msgspec.UnsetType]:
    """The operator's own rule, and its source for the record."""
    path = setup.rule_path
    if isinstance(path, msgspec.UnsetType):
        return None, msgspec.UNSET
    try:
        source = Path(path).read_text(encoding="utf-8")
        rule = RuleProcess(path, source, policy)
    except (OSError, UnicodeDecodeError) as error:
        text = f"{path}: {getattr(error, 'strerror', None) or error}"
        hint = "--verifier names a Python file with verify(start, goal, policy)"
        raise CannotStartError(ExitCode.BAD_FILE, text, hint) from error
    except RuleError as error:
        hint = "missions/lab3/solutions/my_rule.py is one that works"
        raise CannotStartError(ExitCode.BAD_FILE, str(error), hint) from error
    opened.callback(rule.stop)
    return rule, source


def _read_keys(setup: StationConfig) -> Keys:
    try:
        vehicle, client = (
            read_key(path) if path else None
            for path in (setup.vehicle_key_path, setup.client_key_path)
        )
    except KeyFileError as error:
        raise CannotStartError(ExitCode.BAD_FILE, str(error), error.hint) from error
    return Keys(vehicle, client)


def _open_links(setup: StationConfig, opened: ExitStack) -> list[sockets.Link]:
    urls = setup.endpoints or ["udpin://127.0.0.1:0"]
    option = "--vehicle" if setup.bridge else "--link"
    hint_in_use = f"another ground station may be running; choose another port with {option}"
    links = []
    for url in urls:
        with _opening(url, hint_in_use):
            link = sockets.open_link(parse_endpoint(url))
        opened.callback(link.close)
        links.append(link)
    return links


def _open_client_ports(
    setup: StationConfig, policy: Policy, links: Sequence[sockets.Link], opened: ExitStack
) -> ClientPorts | None:
    if not setup.clients:
        return None
    rules = policy.bridge
    verifies = bool(setup.client_key_path) and policy.signing.unsigned != "warn"
    limits = ClientLimits(rules.max_clients, rules.client_rate_hz, rules.client_gone_s, verifies)
    ports = ClientPorts(len(links), limits)
    opened.callback(ports.close)
    for url in setup.clients:
        with _opening(url, "another program has that port; choose another one with --client"):
            ports.open(parse_endpoint(url))
    return ports


@contextmanager
def _opening(url: str, hint_in_use: str) -> Iterator[None]:
    """What keeps an endpoint from being opened, as the user is told it."""
    try:
        yield
    except EndpointError as error:
        raise CannotStartError(ExitCode.USAGE, str(error), error.hint) from error
    except sockets.AddressInUse as error:
        raise CannotStartError(ExitCode.ADDRESS_IN_USE, str(error), hint_in_use) from error
    except sockets.SerialUnavailable as error:
        raise CannotStartError(ExitCode.USAGE, f"{url}: {error}", error.hint) from error
    except socket.gaierror as error:
        hint = "is the name of the host spelled right?"
        raise CannotStartError(ExitCode.USAGE, f"{url}: {error.strerror}", hint) from error
    except OSError as error:
        hint = "is the address one of this machine's?"
        raise CannotStartError(ExitCode.USAGE, f"{url}: {error.strerror or error}", hint) from error


def _open_local_socket(
    setup: StationConfig,
    policy: Policy,
    links: Sequence[sockets.Link],
    recording: Recording,
    screen: LineSink,
    opened: ExitStack,
) -> tuple[LocalSocket | None, OperatorSockets | None]:
    """The way in for other operators.  A station that cannot have one flies without it."""
    endpoints = [str(replace(link.endpoint, port=link.port)) for link in links]
    try:
        local = LocalSocket(
            endpoints,
            recording.path,
            keep=setup.keep,
            policy=policy.name,
            policy_digest=policy_digest(setup.policy_path or "default"),
            speedup=setup.speedup,
            several=setup.several,
        )
    except (OSError, Unsafe) as error:
        text = f"no other terminal can reach this station: {error}"
        screen.put(ipc.encode(ipc.Trouble(text, "")))
        return None, None
    operators = OperatorSockets(local.listener, local.description.token)
    opened.callback(operators.close)
    opened.callback(local.close)
    return local, operators


def _open_recording(setup: StationConfig, clock: Clock) -> Recording:
    if not setup.record:
        return Recording(None)
    try:
        folder, stamp, now_ns = Path(setup.log_dir), clock.stamp(), clock.now_ns()
        rotation = Rotation(setup.rotate_bytes, round(setup.rotate_s * 1e9))
        recorder = Recorder.open(folder, setup.name, stamp, now_ns, sealed=True, rotation=rotation)
    except RecorderError as error:
        hint = "choose a folder that can be written with --log-dir"
        raise CannotStartError(ExitCode.RECORDER, str(error), hint) from error
    return Recording(recorder, DiskWatch(free_in(folder), now_ns))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
