"""`gcs mission new survey | corridor | orbit`: missions made from a polygon, a line, a point."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import click

from gcs.cli.mission.files import AUTOPILOT, FORCE, MISSION_FILE, parse_home, read_plan, write_file
from gcs.cli.options import AS_JSON, POLICY, FiniteRange, with_options
from gcs.exit_codes import ExitCode
from gcs.flight_report.number_format import count
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.plan.model import AutopilotName, Geodetic, Plan
    from gcs.plan.survey.camera import Pictures
    from gcs.plan.survey.lines import Point, Run

_REFUSALS_SHOWN = 5
EXITS = (
    "Exit codes: 0 written, and it may be flown; 2 usage; 4 a file is wrong; 6 written, but the "
    "fence refuses it as it is."
)
_CAMERAS = (
    "canon-s100",
    "dji-fc6310",
    "sony-a6000-16mm",
    "sony-qx1-16mm",
    "sony-rx0",
    "sony-rx100ii",
)


def _pair(
    ctx: click.Context, param: click.Parameter, value: str | None
) -> tuple[float, float] | None:
    """`WxH`: two numbers more than 0."""
    if value is None:
        return None
    found = re.fullmatch(r"(\d+(?:\.\d*)?)x(\d+(?:\.\d*)?)", value, re.ASCII)
    if found is None or not (float(found[1]) > 0.0 and float(found[2]) > 0.0):
        raise click.BadParameter(f"{value!r} is not two numbers WxH, more than 0")
    return float(found[1]), float(found[2])


def _number(name: str, least: float, most: float, help_text: str, **more: Any) -> click.Option:
    kind = FiniteRange(least, most)
    return click.Option([f"--{name}"], type=kind, metavar="N", help=help_text, **more)


OUTPUT = click.Option(
    ["-o", "--output"],
    required=True,
    metavar="OUT",
    help="What to write: .plan, .waypoints, .txt or .csv.",
)
HOME = click.Option(
    ["--home"],
    callback=parse_home,
    metavar="LAT,LON,ALT",
    help="Where it takes off.  [default: the file's home, else the first point of its shape]",
)
HEIGHT = _number(
    "height",
    1.0,
    10_000.0,
    "Metres above home, for which the ground counts as flat.",
    required=True,
)
SPEED = _number("speed", 0.5, 50.0, "Metres a second.", default=5.0, show_default=True)
FLIGHT = (OUTPUT, HEIGHT, SPEED, AUTOPILOT, HOME, POLICY, FORCE, AS_JSON)
CAMERA = (
    click.Option(["--camera"], type=click.Choice(_CAMERAS), help="One of these, looking down; or:"),
    click.Option(["--sensor"], callback=_pair, metavar="WxH", help="Millimetres of the sensor."),
    _number("focal", 0.1, 2000.0, "Millimetres of the lens."),
    click.Option(
        ["--footprint"],
        callback=_pair,
        metavar="WxH",
        help="Metres on the ground at that height, across the way and along it.",
    ),
    _number(
        "front",
        0.0,
        95.0,
        "Percent of a picture that the next one has, too.",
        default=75.0,
        show_default=True,
    ),
    _number(
        "side",
        0.0,
        95.0,
        "Percent of a picture that the next line has, too.",
        default=65.0,
        show_default=True,
    ),
)


class HowToFly(TypedDict):
    """What `FLIGHT` comes to."""

    output: str
    height: float
    speed: float
    autopilot: AutopilotName | None
    home: Geodetic | None
    policy: str
    force: bool
    as_json: bool


class HowToSee(TypedDict):
    """What `CAMERA` comes to."""

    camera: str | None
    sensor: tuple[float, float] | None
    focal: float | None
    footprint: tuple[float, float] | None
    front: float
    side: float


class HowToSurvey(HowToFly, HowToSee):
    """Both."""


@click.group()
def new() -> None:
    """Make a mission from a polygon, a line or a point, and check it as it was made."""


@new.command(
    epilog="Example: gcs mission new survey lab3/square -o field.plan --camera sony-rx0 --height 3"
    f"\n\n{EXITS}"
)
@click.argument("file", type=MISSION_FILE)
@click.option("--zone", type=click.IntRange(1), help="Which polygon, where the file has several.")
@click.option(
    "--angle",
    type=FiniteRange(-360, 360),
    metavar="DEG",
    help="Of the lines, clockwise from north.  [default: with the fewest turns]",
)
@with_options(*CAMERA, *FLIGHT)
def survey(file: str, zone: int | None, angle: float | None, **how: Unpack[HowToSurvey]) -> int:
    """Lines over a polygon, with pictures that overlap.

    FILE has the polygon: the fence of a .plan, a KML polygon, a box of our TOML.
    """
    from gcs.plan.survey.lines import easiest_angle_deg, survey_runs

    seen = _pictures(how)

    def runs(polygon: list[Point]) -> list[Run]:
        along_deg = easiest_angle_deg(polygon) if angle is None else angle
        return survey_runs(polygon, seen.spacing_m, along_deg)

    plan = read_plan(file, how["autopilot"])
    corners = _polygon(plan, zone)
    return _make(plan, corners, runs, seen.trigger_m, how, seen)


@new.command(
    epilog="Example: gcs mission new corridor demo -o road.plan --width 6 --footprint 4x3 "
    f"--height 3\n\n{EXITS}"
)
@click.argument("file", type=MISSION_FILE)
@with_options(
    _number("width", 1.0, 10_000.0, "Metres of the corridor.", required=True), *CAMERA, *FLIGHT
)
def corridor(file: str, width: float, **how: Unpack[HowToSurvey]) -> int:
    """Lines beside each other along a line, with pictures that overlap.

    FILE has the line: a KML path, a GPX route or track, the route of any mission.
    """
    from gcs.plan.survey.lines import corridor_runs

    seen = _pictures(how)
    plan = read_plan(file, how["autopilot"])

    def runs(line: list[Point]) -> list[Run]:
        return corridor_runs(line, width, seen.spacing_m)

    return _make(plan, _line(plan), runs, seen.trigger_m, how, seen)


@new.command(
    epilog="Example: gcs mission new orbit 47.3980,8.5460 -o tower.plan --radius 20 --height 15 "
    f"--photos 24\n\n{EXITS}"
)
@click.argument("point", metavar="LAT,LON")
@with_options(
    _number("radius", 1.0, 10_000.0, "Metres.", required=True),
    _number("turns", 0.1, 20.0, "How often round it.", default=1.0, show_default=True),
    click.Option(
        ["--points"],
        type=click.IntRange(6, 360),
        default=24,
        show_default=True,
        help="Waypoints of a turn.",
    ),
    click.Option(
        ["--photos"],
        type=click.IntRange(0, 1000),
        default=0,
        show_default=True,
        help="Pictures of a turn.",
    ),
    *FLIGHT,
)
def orbit(
    point: str,
    radius: float,
    turns: float,
    points: int,
    photos: int,
    **how: Unpack[HowToFly],
) -> int:
    """Round a point, looking at it: waypoints, as not every autopilot flies circles."""
    import math

    from gcs.plan.model import LatLon, Plan
    from gcs.plan.survey.lines import ring

    found = parse_home(click.get_current_context(), orbit.params[0], f"{point},0")
    assert found is not None
    centre = LatLon(found.lat_deg, found.lon_deg)
    # The ring has straight sides: their sum, not the circle's length, is shared by the pictures.
    sides_m = 2.0 * radius * math.sin(math.pi / points) * points
    trigger_m = sides_m / photos if photos else 0.0

    def runs(at: list[Point]) -> list[Run]:
        return [ring(at[0], radius, points, turns, begin=(0.0, 0.0))]

    source = Plan("orbit", None, None, source=point)
    return _make(source, [centre], runs, trigger_m, how, look=True)


# ------------------------------------------------------------------------------ shapes


def _polygon(plan: Plan, number: int | None) -> list[Any]:
    from gcs.plan.model import Polygon

    shapes = [z.shape for z in plan.fence.zones if z.inclusion and isinstance(z.shape, Polygon)]
    if not shapes:
        raise ExitError(
            ExitCode.BAD_FILE,
            f"{plan.source}: has no polygon",
            "a survey needs one: a KML polygon, the fence of a .plan, a box in [fence] of a TOML",
        )
    if number is None and len(shapes) > 1:
        raise ExitError(
            ExitCode.USAGE,
            f"{plan.source}: has {count(len(shapes), 'polygon')}",
            "--zone N names one",
        )
    if (number or 1) > len(shapes):
        text = f"--zone {number}: {plan.source} has {count(len(shapes), 'polygon')}"
        raise ExitError(ExitCode.USAGE, text)
    return list(shapes[(number or 1) - 1].corners)


def _line(plan: Plan) -> list[Any]:
    """Where its items fly to, each place once."""
    from gcs.plan.commands import KINDS, Kind
    from gcs.plan.model import EastNorth, Geographic, LatLon, Local

    points: list[Any] = []
    for item in plan.items:
        place = item.place
        point: EastNorth | LatLon | None = None
        if KINDS.get(item.command) is not Kind.MOVE:
            continue
        if isinstance(place, Local):
            point = EastNorth(place.east_m, place.north_m)
        elif isinstance(place, Geographic) and not place.here:
            point = LatLon(place.lat_deg, place.lon_deg)
        if point is not None and point not in points[-1:]:
            points.append(point)
    if len(points) < 2:
        raise ExitError(
            ExitCode.BAD_FILE,
            f"{plan.source}: has no line of two points or more",
            "a corridor needs one: a KML path, a GPX route, a mission",
        )
    return points


def _pictures(how: HowToSurvey) -> Pictures:
    from gcs.plan.survey.camera import CAMERAS, Camera, pictures

    ways = [how["camera"], how["sensor"] or how["focal"], how["footprint"]]
    if sum(way is not None for way in ways) != 1:
        hint = "--camera NAME, or --sensor WxH and --focal MM, or --footprint WxH"
        raise ExitError(ExitCode.USAGE, "name the camera, in one way", hint)
    overlap = (how["front"], how["side"])
    if how["footprint"] is not None:
        return pictures(how["footprint"], *overlap)
    if how["camera"] is not None:
        camera = CAMERAS[how["camera"]]
    elif how["sensor"] is None or how["focal"] is None:
        raise ExitError(ExitCode.USAGE, "--sensor and --focal belong together")
    else:
        camera = Camera(*how["sensor"], how["focal"])
    return pictures(camera.footprint_m(how["height"]), *overlap, camera.width_px)


# -------------------------------------------------------------------------------- made


@dataclass(frozen=True, slots=True)
class _Made:
    plan: Plan
    home: Geodetic
    runs: list[Run]
    photos: int


def _make(
    source: Plan,
    shape: list[Any],
    runs_of: Callable[[list[Point]], list[Run]],
    trigger_m: float,
    how: HowToFly | HowToSurvey,
    seen: Pictures | None = None,
    *,
    look: bool = False,
) -> int:
    """Write it, read what was written, check that, and tell."""
    from gcs.cli.mission.check import check_plan
    from gcs.cli.mission.report import against_it, check_json, verdict
    from gcs.plan.errors import PlanError
    from gcs.plan.formats.reader import read
    from gcs.plan.formats.writer import SUFFIXES, write

    output = how["output"]
    if not output.lower().endswith(SUFFIXES):
        hint = f"one of: {', '.join(SUFFIXES)}"
        raise ExitError(ExitCode.USAGE, f"{output}: the suffix names no format for it", hint)
    autopilot: AutopilotName = how["autopilot"] or source.firmware or "px4"
    made = _planned(source, shape, runs_of, trigger_m, how, autopilot, look)
    try:
        data = write(output, made.plan, autopilot).data
        again = read(output, data, autopilot)
    except PlanError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    write_file(output, data, how["force"])
    checked = check_plan(
        replace(again, home=again.home or made.home), autopilot, how["policy"], None
    )
    if how["as_json"]:
        document = {
            "written": output,
            "runs": [[list(point) for point in run] for run in made.runs],
            "photos": made.photos,
            "trigger_m": trigger_m,
            "spacing_m": None if seen is None else seen.spacing_m,
            "footprint_m": None if seen is None else [seen.across_m, seen.along_m],
            "ground_cm_px": None if seen is None else seen.ground_cm_px,
            "check": json.loads(check_json(checked)),
        }
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return checked.exit_code
    click.echo(f"{output}: written, {_told(made, trigger_m, how['speed'], seen)}")
    if how["home"] is None and source.home is None:
        where = f"{made.home.lat_deg:.7f}, {made.home.lon_deg:.7f}"
        click.echo(f"  home: {where}, as nothing says where it takes off; give --home LAT,LON,ALT")
    against = list(against_it(checked))
    for line in against[:_REFUSALS_SHOWN]:
        click.echo(line)
    if len(against) > _REFUSALS_SHOWN:
        click.echo(f"  and {len(against) - _REFUSALS_SHOWN} more: gcs mission check {output}")
    click.echo(f"verdict: {verdict(checked)}")
    return checked.exit_code


def _planned(
    source: Plan,
    shape: list[Any],
    runs_of: Callable[[list[Point]], list[Run]],
    trigger_m: float,
    how: HowToFly | HowToSurvey,
    autopilot: AutopilotName,
    look: bool,
) -> _Made:
    from gcs.cli.mission.check import HOMES
    from gcs.gate.airspace.projection import Origin, Projection
    from gcs.plan.model import EastNorth, Fence, Geodetic
    from gcs.plan.survey.lines import nearest_first
    from gcs.plan.survey.mission import Flight, TooManyItemsError, mission_of, picture_count

    first = shape[0]
    usual = HOMES[autopilot]
    if not isinstance(first, EastNorth):
        usual = Geodetic(first.lat_deg, first.lon_deg, None)
    home = how["home"] or source.home or usual
    plane = Projection(Origin(home.lat_deg, home.lon_deg, 0.0), autopilot)

    def in_plane(point: Any) -> Point:
        if isinstance(point, EastNorth):
            return (point.east_m, point.north_m)
        north_m, east_m = plane.north_east(*point)
        return (east_m, north_m)

    points = [in_plane(point) for point in shape]
    runs = nearest_first(runs_of(points), (0.0, 0.0))
    flight = Flight(how["height"], how["speed"], trigger_m, points[0] if look else None)
    outside = Fence(tuple(zone for zone in source.fence.zones if not zone.inclusion))
    name = re.split(r"[/\\]", how["output"])[-1].rpartition(".")[0]
    try:
        plan = mission_of(name, runs, flight, home, autopilot, plane.lat_lon, outside)
    except TooManyItemsError as error:
        hint = "a smaller field, a greater height, or less overlap"
        raise ExitError(ExitCode.USAGE, f"it would have {error}", hint) from None
    return _Made(plan, home, runs, picture_count(runs, trigger_m) if trigger_m else 0)


def _told(made: _Made, trigger_m: float, speed_m_s: float, seen: Pictures | None) -> str:
    told = f"{len(made.plan.items)} items, {count(len(made.runs), 'line')}"
    if not trigger_m:
        return told
    told += (
        f", about {made.photos} pictures\n  one each {trigger_m:.1f} m, "
        f"{trigger_m / speed_m_s:.1f} s"
    )
    if seen is not None:
        told += (
            f"; lines at most {seen.spacing_m:.1f} m apart; a picture has "
            f"{seen.across_m:.1f} x {seen.along_m:.1f} m"
        )
        if seen.ground_cm_px is not None:
            told += f", {seen.ground_cm_px:.1f} cm a pixel"
    return told
