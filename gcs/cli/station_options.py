"""What `gcs fly` and `gcs bridge` share: options, typed, and the station that they mean; among them
those for a vehicle of the command's own (`--sim`), and for MAVLink clients beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import click
from click.core import ParameterSource

from gcs.cli.options import CLIENT_KEY, LOG_DIR, POLICY, SIGN_KEY, UTF8, FiniteRange, Seed
from gcs.cli.records.options import COMPACT, ROTATE_AGE, ROTATE_SIZE, with_files
from gcs.operator.text.number_text import read_number

if TYPE_CHECKING:
    from gcs.config import StationConfig

MOST_VEHICLES = 16
"""As the station meets (`gcs/station/vehicles.py`)."""
OF_THE_SIM = ("autopilot", "home", "seed", "speedup")


def _place(_ctx: click.Context, _param: click.Parameter, text: str) -> str:
    """LAT,LON,ALT, looked at before anything is started."""
    if not text:
        return text
    try:
        lat_deg, lon_deg, alt_m = (read_number(part) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is not as in 47.397742,8.545594,488") from None
    if not (abs(lat_deg) < 90.0 and abs(lon_deg) <= 180.0 and -500.0 <= alt_m <= 9000.0):
        raise click.BadParameter(
            f"{text!r} is not on Earth: latitude within 90, longitude within 180 degrees, "
            "height from -500 to 9000 m"
        )
    return text


SIM = click.Option(
    ["--sim"],
    type=click.IntRange(1, MOST_VEHICLES),
    is_flag=False,
    flag_value=1,
    metavar="[N]",
    help="Start a vehicle of our own, on a private port, or N of them beside each other.",
)
AUTOPILOT = click.Option(
    ["--autopilot"],
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="Which autopilot the --sim vehicle speaks like.",
)
HOME = click.Option(
    ["--home"],
    default="",
    callback=_place,
    metavar="LAT,LON,ALT",
    help="Where the --sim vehicle stands: degrees, degrees, metres above mean sea level.",
)
SEED = click.Option(
    ["--seed"], type=Seed(), default=1, show_default=True, help="Seed of the --sim vehicle."
)
SPEEDUP = click.Option(
    ["--speedup"],
    type=FiniteRange(min=0, max=200, min_open=True),
    default=1.0,
    show_default=True,
    help="Times real time, for the --sim vehicle and the ground station.",
)
SIM_OPTIONS = (SIM, AUTOPILOT, HOME, SEED, SPEEDUP)

CLIENT = click.Option(
    ["--client", "clients"],
    multiple=True,
    type=UTF8,
    metavar="URL",
    help="Where MAVLink clients (QGroundControl, MAVSDK, a script) reach the vehicle through the "
    "gate: udpin:// udpout:// tcpin:// tcpout:// serial://. May be given more than once.",
)


STATION_OPTIONS = (
    *(CLIENT, CLIENT_KEY, SIGN_KEY, POLICY, LOG_DIR),
    *SIM_OPTIONS,
    *(ROTATE_SIZE, ROTATE_AGE, COMPACT),
)


def refuse_options_of_the_sim(ctx: click.Context) -> None:
    """They say what our own vehicle is to be; another one is as it is."""
    for name in OF_THE_SIM:
        if ctx.get_parameter_source(name) is not ParameterSource.DEFAULT:
            raise click.UsageError(f"--{name} is for the vehicle of --sim: add --sim, or leave it")


class OfStation(TypedDict):
    """What `STATION_OPTIONS` come to."""

    clients: tuple[str, ...]
    client_key: str
    sign_key: str
    policy: str
    log_dir: str
    sim: int | None
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
    from gcs.cli.options import station_config
    from gcs.cli.settings import usual_links
    from gcs.config import SimConfig

    if of["sim"] and links:
        raise click.UsageError(f"--sim starts a vehicle of its own: leave out {link_option}")
    if of["sim"] and of["sign_key"]:
        raise click.UsageError("--sim starts a vehicle without a key: leave out --sign-key")
    if not of["sim"]:
        refuse_options_of_the_sim(ctx)
    if of["clients"]:
        vehicles = [] if of["sim"] else links or usual_links()
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
            autopilot=of["autopilot"],
            home=of["home"],
            seed=of["seed"],
            speedup=of["speedup"],
            count=of["sim"],
        )
        config = msgspec.structs.replace(config, sim=simulated, endpoints=[])
    config = msgspec.structs.replace(
        config,
        clients=list(of["clients"]),
        speedup=of["speedup"],
        operator=f"gcs {ctx.info_name}, pid {os.getpid()}",
    )
    return with_files(config, of["rotate_size"], of["rotate_age"], of["compact"])
