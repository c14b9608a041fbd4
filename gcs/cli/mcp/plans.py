"""Mission files that an agent may name, and the mission on board, as it is told of them."""

from __future__ import annotations

import hashlib
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, cast

import msgspec

from gcs import ipc, resources
from gcs.agents.agent import MISSION_WAIT_S, Answer, PlanFile
from gcs.agents.verdicts import Denied
from gcs.cli.mission.check import Checked, check_plan
from gcs.cli.mission.report import finding_lines
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.operator.failures import GcsError
from gcs.operator.station import Station
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.model import AutopilotName, Geodetic

if TYPE_CHECKING:
    from gcs.gate.refusal import Refusal

HOME_WAIT_S = 2.0


class Plans:
    """Files of one folder, and the shipped missions; nothing else of this machine is read."""

    def __init__(self, station: Station, policy: str, folder: Path | None) -> None:
        self._station = station
        self._policy = policy
        self._folder = folder

    def read(self, name: str) -> PlanFile | Denied:
        """Read it and put it to the policy's fence, from the home that the vehicle tells."""
        path = self._find(name)
        if path is None:
            names = [*(self._names()), *resources.shipped()]
            return Denied("NO_SUCH_FILE", f"no such mission; there are: {', '.join(names)}")
        home = self._home()
        if home is None:
            return Denied("NO_HOME", "the vehicle has not told its home yet")
        try:
            data = path.read_bytes()
            digest = hashlib.sha256(data).hexdigest()[:16]
            checked = check_plan(read(str(path), data, None), self._autopilot(), self._policy, home)
        except (PlanError, ExitError, OSError) as error:
            return PlanFile(str(path), "", "BAD_MISSION", str(error))
        lines = [line for each in checked.findings for line in finding_lines(checked.plan, each)]
        code, sentence = _verdict(checked)
        return PlanFile(str(path), digest, code, sentence, tuple(lines))

    def _find(self, name: str) -> Path | None:
        for root in filter(None, (self._folder, _shipped_folder())):
            path = (root / name).resolve()
            if path.is_relative_to(root.resolve()) and path.is_file():
                return path
        return None

    def _names(self) -> list[str]:
        if self._folder is None:
            return []
        files = (path for path in self._folder.rglob("*") if path.suffix in resources.SUFFIXES)
        return sorted(path.relative_to(self._folder).as_posix() for path in files)

    def _home(self) -> Geodetic | None:
        try:
            told = self._station.telemetry("HOME_POSITION", HOME_WAIT_S)
        except (ValueError, TimeoutError):
            return None
        lat, lon, alt = (cast(int, told[name]) for name in ("latitude", "longitude", "altitude"))
        return Geodetic(lat / 1e7, lon / 1e7, alt / 1e3)

    def _autopilot(self) -> AutopilotName | None:
        words = self._station.snapshot.vehicle.split()
        return "ardupilot" if "ardupilot" in words else "px4" if "px4" in words else None

    def on_board(self) -> Answer:
        """The mission on board, read back; only for the operator in control, as it is a transfer
        over the link."""
        seen = self._station.snapshot
        answer: Answer = {"mission_seq": seen.mission_seq, "mission_total": seen.mission_total}
        if not self._station.in_control:
            return {**answer, "items": None, "why": "another operator is in control"}
        with tempfile.TemporaryDirectory(prefix="gcs-mcp-") as folder:
            path = Path(folder) / "on_board.plan"
            ask = ipc.Ask(0, "mission_download", path=str(path))
            try:
                self._station.request(ask, timeout_s=MISSION_WAIT_S)
                plan = read(str(path), path.read_bytes(), None)
            except (GcsError, PlanError, OSError) as error:
                return {**answer, "items": None, "why": str(error)}
        return {**answer, "items": msgspec.to_builtins(plan.items)}


def _shipped_folder() -> Path | None:
    try:
        return resources.missions_dir()
    except FileNotFoundError:
        return None


def _verdict(checked: Checked) -> tuple[str, str]:
    """A code and a sentence where it is refused; empty: it may be flown."""
    if checked.exit_code is ExitCode.BAD_FILE:
        return "BAD_MISSION", "not to be flown as it is: see the findings"
    flown = checked.verification
    if flown is None:
        return "BAD_MISSION", "there is no mission in it to fly"
    refusal: Refusal | None = checked.start_refusal or flown.refusal
    return ("", "") if refusal is None else (refusal.code.value, refusal.sentence)
