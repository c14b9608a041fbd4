"""What `gcs fly` and `gcs bridge` share: options, typed, and the station that they mean."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import click

from gcs.cli.options import CLIENT_KEY, LOG_DIR, POLICY, SIGN_KEY
from gcs.cli.record_options import COMPACT, ROTATE_AGE, ROTATE_SIZE, with_files
from gcs.cli.sim_options import CLIENT, SIM_OPTIONS, refuse_options_of_the_sim

if TYPE_CHECKING:
    from gcs.config import StationConfig

STATION_OPTIONS = (
    *(CLIENT, CLIENT_KEY, SIGN_KEY, POLICY, LOG_DIR),
    *SIM_OPTIONS,
    *(ROTATE_SIZE, ROTATE_AGE, COMPACT),
)


class OfStation(TypedDict):
    """What `STATION_OPTIONS` come to."""

    clients: tuple[str, ...]
    client_key: str
    sign_key: str
    policy: str
    log_dir: str
    sim: bool
    autopilot: str
    home: str
    seed: int
    speedup: float
    rotate_size: int
    rotate_age: float
    compact: bool


def new_station(
    ctx: click.Context,
    links: tuple[str, ...],
    of: OfStation,
    *,
    link_option: str,
    name: str,
    timeout_s: float,
    vehicle: int | None,
) -> StationConfig:
    """A station that flies a vehicle of its own (`--sim`) or those on `links`.

    `link_option` is how the command calls `links`.  Raises click.UsageError for options that do not
    go together, ExitError for a policy or an address that is none.
    """
    import os

    import msgspec

    from gcs.cli.bridge_places import refuse_shared_places
    from gcs.cli.options import DEFAULT_LINK, station_config
    from gcs.config import SimConfig

    if of["sim"] and links:
        raise click.UsageError(f"--sim starts a vehicle of its own: leave out {link_option}")
    if of["sim"] and of["sign_key"]:
        raise click.UsageError("--sim starts a vehicle without a key: leave out --sign-key")
    if not of["sim"]:
        refuse_options_of_the_sim(ctx)
    if of["clients"]:
        vehicles = [] if of["sim"] else links or [DEFAULT_LINK]
        refuse_shared_places(vehicles, of["clients"], vehicle_option=link_option)
    config = station_config(
        links,
        of["policy"],
        of["log_dir"],
        name=name,
        timeout_s=timeout_s,
        vehicle=vehicle,
        sign_key=of["sign_key"],
        client_key=of["client_key"],
    )
    if of["sim"]:
        simulated = SimConfig(
            autopilot=of["autopilot"], home=of["home"], seed=of["seed"], speedup=of["speedup"]
        )
        config = msgspec.structs.replace(config, sim=simulated, endpoints=[])
    config = msgspec.structs.replace(
        config,
        clients=list(of["clients"]),
        speedup=of["speedup"],
        operator=f"gcs {ctx.info_name}, pid {os.getpid()}",
    )
    return with_files(config, of["rotate_size"], of["rotate_age"], of["compact"])
