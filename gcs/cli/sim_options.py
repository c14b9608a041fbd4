"""Options for a vehicle of the command's own (`--sim`), and for MAVLink clients beside it."""

from __future__ import annotations

import click
from click.core import ParameterSource

from gcs.cli.options import UTF8, FiniteRange, Seed
from gcs.operator.number_text import read_number

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


SIM = click.Option(["--sim"], is_flag=True, help="Start a vehicle of our own, on a private port.")
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


def refuse_options_of_the_sim(ctx: click.Context) -> None:
    """They say what our own vehicle is to be; another one is as it is."""
    for name in OF_THE_SIM:
        if ctx.get_parameter_source(name) is not ParameterSource.DEFAULT:
            raise click.UsageError(f"--{name} is for the vehicle of --sim: add --sim, or leave it")
