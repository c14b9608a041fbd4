"""What the commands about mission files share: the file that is read, the one that is written."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gcs.cli.completers import missions
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from gcs.plan.model import AutopilotName, Geodetic, Plan

AUTOPILOT = click.Option(
    ["--autopilot"],
    type=click.Choice(["px4", "ardupilot"]),
    help="Whose rules to read it by.  [default: what the file says, else px4]",
)
FORCE = click.Option(["--force"], is_flag=True, help="Write over a file that exists.")
_NAMED_IN_A_FOLDER = 5


def parse_home(ctx: click.Context, param: click.Parameter, value: str | None) -> Geodetic | None:
    """`LAT,LON,ALT`: degrees, and metres above mean sea level."""
    from gcs.plan.model import Geodetic

    if value is None:
        return None
    try:
        lat_deg, lon_deg, alt_amsl_m = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(f"{value!r} is not three numbers LAT,LON,ALT") from None
    if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0 and abs(alt_amsl_m) <= 1.0e4):
        raise click.BadParameter(f"{value!r} is no place on Earth")
    return Geodetic(lat_deg, lon_deg, alt_amsl_m)


HOME = click.Option(
    ["--home"],
    callback=parse_home,
    metavar="LAT,LON,ALT",
    help="Where it will take off.  [default: the file's home, else the simulated vehicle's]",
)


class MissionFile(click.ParamType[str]):
    """The path of a file, or the name of a shipped mission; both are completed."""

    name = "FILE"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        return str(value)

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        return missions(ctx, param, incomplete)


MISSION_FILE = MissionFile()


def read_plan(file: str, autopilot: AutopilotName | None) -> Plan:
    """The plan behind a path or the name of a shipped mission.

    Raises ExitError with BAD_FILE.
    """
    from gcs import resources
    from gcs.plan.errors import PlanError
    from gcs.plan.formats.reader import read

    try:
        path = resources.find(file)
        return read(str(path), path.read_bytes(), autopilot)
    except resources.MissionNotFoundError as error:
        if Path(file).is_dir():
            raise ExitError(
                ExitCode.BAD_FILE, f"{file}: is a folder", _files_in(Path(file))
            ) from None
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{file}: {error.strerror}") from None
    except PlanError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None


def _files_in(folder: Path) -> str:
    """A hint that names some mission files in it."""
    from gcs.resources import SUFFIXES

    try:
        names = sorted(path.name for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)
    except OSError:
        names = []
    if not names:
        return "name a mission file; none is directly in it"
    shown = ", ".join(names[:_NAMED_IN_A_FOLDER])
    return f"name a file in it: {shown}" + (", ..." if len(names) > _NAMED_IN_A_FOLDER else "")


def write_file(path_text: str, data: bytes, force: bool) -> None:
    """UTF-8 text, to standard output for `-`.

    Raises ExitError: USAGE where a file is there already, BAD_FILE where it cannot be written.
    """
    if path_text == "-":
        click.echo(data.decode(), nl=False)
        return
    path = Path(path_text)
    if path.exists() and not force:
        raise ExitError(ExitCode.USAGE, f"{path_text}: exists already", "--force writes over it")
    try:
        path.write_bytes(data)
    except OSError as error:
        raise ExitError(ExitCode.BAD_FILE, f"{path_text}: {error.strerror}") from None
