"""`gcs fence` and `gcs rally`: what a file holds of them, and what a vehicle has on board."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal, TypeAlias, Unpack

import click

from gcs.cli.common_options import MeetsVehicle, ToVehicle
from gcs.cli.mission.files import AUTOPILOT, FORCE, HOME, MISSION_FILE, read_plan
from gcs.cli.mission.live import EXITS, LINK_OPTIONS, check_output, readable, run_word
from gcs.cli.options import AS_JSON, POLICY, with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.plan.errors import Finding
    from gcs.plan.model import AutopilotName, Geodetic, Plan

Part: TypeAlias = Literal["fence", "rally"]

FILES = (
    "FILE is a QGroundControl .plan, a QGC WPL table, TOML, KML, fence.txt or rally.txt; what else "
    "is in it is left out."
)
WORDS: dict[Part, str] = {"fence": "fence", "rally": "rally points"}


def _group(part: Part, example: str) -> click.Group:
    """check, show, upload, download and clear, of a fence or of rally points."""
    what = WORDS[part]

    @click.group(part, help=f"The {what} of a file, and those on board of a vehicle.\n\n{FILES}")
    def group() -> None: ...

    @group.command(
        epilog=f"Example: gcs {part} check {example}\n\n"
        "Exit codes: 0 nothing is wrong, 4 the file is wrong, 6 the policy refuses it.",
        help=f"Check the {what} of a file, without a vehicle."
        + (" Without FILE the policy's own fence." if part == "fence" else ""),
    )
    @click.argument("file", type=MISSION_FILE, required=part == "rally")
    @with_options(AUTOPILOT, POLICY, HOME, AS_JSON)
    def check(
        file: str | None,
        autopilot: AutopilotName | None,
        policy: str,
        home: Geodetic | None,
        as_json: bool,
    ) -> int:
        from dataclasses import replace

        from gcs.cli.mission.check import check_plan
        from gcs.cli.mission.report import part_json, part_lines
        from gcs.plan.model import Plan

        plan = Plan("", None, home) if file is None else _only(part, file, autopilot)
        checked = check_plan(plan, autopilot, policy, home)
        found = () if file is None else (*checked.findings, *_heights(checked.plan))
        checked = replace(checked, findings=found)
        click.echo(part_json(checked) if as_json else "\n".join(part_lines(checked)))
        return checked.exit_code

    @group.command(
        epilog=f"Example: gcs {part} show {example}", help=f"Print the {what} of a file."
    )
    @click.argument("file", type=MISSION_FILE, required=False)
    @with_options(AUTOPILOT, AS_JSON)
    def show(file: str | None, autopilot: AutopilotName | None, as_json: bool) -> int:
        from gcs.cli.mission.mission import has_braille
        from gcs.cli.mission.report import plan_json, print_plan
        from gcs.cli.mission.route import route_of

        if file is None:
            on_board = f"what is on board, `gcs {part} download FILE` brings"
            raise click.UsageError(f"Missing argument 'FILE'; {on_board}.")
        plan = _only(part, file, autopilot)
        route = route_of(plan, autopilot, "default", None)
        if as_json:
            click.echo(plan_json(plan, route))
        else:
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            print_plan(plan, route, ascii_only=not has_braille(encoding))
        return ExitCode.DONE

    @group.command(
        cls=MeetsVehicle,
        epilog=f"Example: gcs {part} upload {example}\n\n{EXITS}",
        help=f"Send the {what} of a file to the vehicle, in place of those on board, and read back."
        + (" On the ground, or where it has none." if part == "fence" else ""),
    )
    @click.argument("file", type=MISSION_FILE)
    @with_options(*LINK_OPTIONS)
    def upload(file: str, **to: Unpack[ToVehicle]) -> None:
        _only(part, file, None)
        run_word(f"{part} upload", readable(file), **to)

    @group.command(
        cls=MeetsVehicle,
        epilog=f"Example: gcs {part} download on_board.plan\n\n{EXITS}",
        help=f"Read the {what} on board into FILE, and where home is.",
    )
    @click.argument("file")
    @with_options(FORCE, *LINK_OPTIONS)
    def download(file: str, force: bool, **to: Unpack[ToVehicle]) -> None:
        check_output(file, force)
        run_word(f"{part} download", file, **to)

    @group.command(
        cls=MeetsVehicle,
        epilog=f"Example: gcs {part} clear\n\n{EXITS}",
        help=f"Remove the {what} on board." + (" On the ground only." if part == "fence" else ""),
    )
    @with_options(*LINK_OPTIONS)
    def clear(**to: Unpack[ToVehicle]) -> None:
        run_word(f"{part} clear", **to)

    return group


def _only(part: Part, file: str, autopilot: AutopilotName | None) -> Plan:
    """The part of the plan behind `file`.  Raises ExitError with BAD_FILE where it has none."""
    from gcs.plan.parts import apart, held
    from gcs.wire.ids import MissionType

    kind = MissionType.FENCE if part == "fence" else MissionType.RALLY
    plan = read_plan(file, autopilot)
    found, rest = apart(kind, plan)
    if not held(found):
        hint = f"it has {', '.join(held(rest)) or 'nothing'}"
        text = f"{plan.source}: {WORDS[part]}: none is in this file"
        raise ExitError(ExitCode.BAD_FILE, text, hint)
    return found


def _heights(plan: Plan) -> Iterator[Finding]:
    """Zones that no vehicle can be sent."""
    from gcs.plan.errors import Finding, Level

    hint = "`gcs fence put` puts the policy's fence on board, its ceiling as a parameter"
    what = "has heights, which the zones of a vehicle have not"
    for number, zone in enumerate(plan.fence.zones, start=1):
        if (zone.floor_above_home_m, zone.ceiling_above_home_m) != (None, None):
            yield Finding(Level.ERROR, zone.where, f"fence zone {number}", what, hint)


fence = _group("fence", "missions/fence.plan")
rally = _group("rally", "missions/rally.plan")


@fence.command(cls=MeetsVehicle, epilog=f"Example: gcs fence put --policy lab\n\n{EXITS}")
@with_options(*LINK_OPTIONS)
def put(**to: Unpack[ToVehicle]) -> None:
    """Put the policy's own fence on board, so that the vehicle keeps it when the link is down.

    Its zones are uploaded in place of the fence on board; its size, what a breach leads to, and for
    how long the vehicle flies on without setpoints are set as parameters and read back. On the
    ground only. What the autopilot cannot keep is said.
    """
    run_word("fence put", **to)
