"""From the client's first word to its last: a station joined or started, served, and left."""

from __future__ import annotations

import os
import secrets
import time
from pathlib import Path

import msgspec

from gcs.agents.agent import Agent, Around
from gcs.cli.mcp.plans import Plans
from gcs.cli.mcp.server import server_of
from gcs.cli.options import asked_for
from gcs.cli.running import joined_station, refuse_differences, station_for
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.operator.chosen_vehicle import ListenedVehicle
from gcs.operator.client import Listened, StationClient
from gcs.operator.errors import ExitError
from gcs.operator.failures import Disconnected
from gcs.operator.station import Station
from gcs.policy_digest import policy_digest
from gcs.resources import policy_path

START_WAIT_S = 30.0


def run(
    config: StationConfig, policy: str, name: str, missions: Path | None, *, take: bool
) -> ExitCode:
    """Until the client closes its end.  Raises ExitError where there is no station."""
    found = None if config.sim is not None else station_for(config.endpoints)
    speedup = config.speedup
    way: Listened
    if found is None:
        config = msgspec.structs.replace(config, operator=f"agent {name}, pid {os.getpid()}")
        way, digest = StationClient.start(config), policy_digest(policy)
    else:
        refuse_differences(found, asked_for())
        way = joined_station(found, f"agent {name}")
        policy, digest, speedup = found.policy, found.policy_digest, found.speedup
        if config.target_sysid and found.vehicles:
            way = ListenedVehicle(way, config.target_sysid)
    station = Station(way)
    try:
        station.wait_until(lambda: station.talk.hello is not None, START_WAIT_S)
        if take:
            station.take_control()
        plans = Plans(station, policy, missions)
        around = Around(
            session=secrets.token_hex(4),
            same_clock=speedup == 1.0,
            policy=policy,
            policy_digest=digest,
            policy_text=_text(policy, digest),
            now_ns=time.time_ns,
            read_plan=plans.read,
        )
        server_of(Agent(station, around), plans.on_board).run("stdio")
    except Disconnected as error:
        trouble = station.talk.trouble
        if trouble is None:
            raise ExitError(ExitCode.BUG, str(error)) from error
        raise ExitError(trouble.exit_code or ExitCode.BUG, trouble.text, trouble.hint) from error
    except KeyboardInterrupt:
        return ExitCode.INTERRUPTED
    finally:
        station.close()
    return ExitCode.DONE


def _text(policy: str, digest: str) -> str:
    """The policy's file, if it still is the one that the station has read; else empty."""
    try:
        if policy_digest(policy) == digest:
            return policy_path(policy).read_text(encoding="utf-8")
    except OSError:
        pass
    return ""
