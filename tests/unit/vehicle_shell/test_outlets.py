"""What `vehicle-sim` says, and the face that it shows."""

from __future__ import annotations

import json
from collections.abc import Sequence

import pytest

from vehicle_sim import reporting
from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.live_page import Rhythm, VehicleLine, cells, footer, table
from vehicle_sim.plant.faults import GpsLost, MotorFault
from vehicle_sim.reporting import Contact, Json, Launch, announcement, spelled
from vehicle_sim.shell.urls import parse
from vehicle_sim.simulation.control_line import Lines, answer
from vehicle_sim.simulation.fault_script import AnyFault, LinkFault

OWN = [parse(f"udpout://127.0.0.1:{port}") for port in range(14540, 14560)]
STATION = parse("udpout://127.0.0.1:14550")


def launch(count: int) -> Launch:
    return Launch("px4", tuple(Contact(i + 1, (OWN[i], STATION)) for i in range(count)))


def test_one_vehicle_says_where_it_is_and_how_to_connect() -> None:
    assert [spelled(line) for line in announcement(launch(1))] == [
        "INFO vehicle1: px4",
        "INFO vehicle1: sends to 127.0.0.1:14540; connect with udpin://127.0.0.1:14540",
        "INFO vehicle1: sends to 127.0.0.1:14550; connect with udpin://127.0.0.1:14550",
    ]


def test_a_fleet_says_a_shared_link_once_and_a_large_one_only_its_ends() -> None:
    said = [spelled(line) for line in announcement(launch(2))]
    assert said[0] == "INFO vehicles 1 to 2: px4"
    assert said[-1].startswith("INFO vehicles 1 to 2: sends to 127.0.0.1:14550")
    assert len(said) == 4
    assert len(announcement(launch(20))) == 4


def test_the_json_outlet_says_one_object_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    outlet = Json("info")
    outlet.ready(launch(1))
    outlet.log(announcement(launch(1))[0])
    ready, log = capsys.readouterr().out.splitlines()
    assert json.loads(ready) == {
        "ready": [
            {"system": 1, "urls": ["udpin://127.0.0.1:14540", "udpin://127.0.0.1:14550"]},
        ]
    }
    assert json.loads(log) == {"log": "INFO vehicle1: px4"}


# ------------------------------------------------------------------------------- the face


def status(system: int, flying: bool = False, clients: int = 0) -> VehicleLine:
    return VehicleLine(system, "AUTO.LOITER", flying, flying, False, 12.34, 4.56, 0.873, clients)


RHYTHM = Rhythm(75.0, 10.0, 9.98)


def test_a_line_has_all_that_one_wants_to_know() -> None:
    assert cells(status(3, flying=True, clients=2)) == (
        "3",
        "AUTO.LOITER",
        "flying",
        "12.3 m",
        "4.6 m/s",
        "87 %",
        "2 clients",
    )
    assert cells(status(3))[2] == "disarmed"
    assert cells(status(3))[6] == "nobody"
    failing = VehicleLine(1, "AUTO.RTL", True, True, True, 0.0, 0.0, 0.1, 1)
    assert cells(failing)[2] == "flying, FAILSAFE"


def test_a_vehicle_on_the_ground_is_never_at_minus_zero() -> None:
    assert cells(VehicleLine(1, "X", False, False, False, -0.04, 0.0, 1.0, 0))[3] == "0.0 m"


def test_the_live_page_gives_way_to_plain_lines_in_the_background(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []

    class Page:
        """In place of the one that draws."""

        def show(self, statuses: Sequence[VehicleLine], rhythm: Rhythm) -> None:
            told.append("shown")

        def say(self, line: str, warning: bool) -> None:
            told.append(line)

        def close(self) -> None:
            told.append("closed")

    monkeypatch.setattr("vehicle_sim.live_page.LivePage", Page)
    outlet = reporting.Live("info")
    for foreground in (False, True, True, False):
        monkeypatch.setattr(reporting, "in_foreground", lambda now=foreground: now)
        outlet.show([status(1)], RHYTHM)
        outlet.log(announcement(launch(1))[0])
    outlet.close()
    line = "INFO vehicle1: px4"
    assert told == ["shown", line, "shown", line, "closed"]
    assert capsys.readouterr().out == f"{line}\n{line}\n"


def test_what_has_no_room_is_summed_up() -> None:
    rows = table([status(n, flying=n > 2) for n in range(1, 11)], room=4)
    assert [row[0] for row in rows] == ["vehicle", "1", "2", "3", "+7"]
    assert rows[-1][2] == "7 flying"
    assert len(table([status(n) for n in range(4)], room=4)) == 5


def test_the_footer_tells_the_factor_reached_beside_the_one_wanted() -> None:
    assert footer(RHYTHM) == "1:15 simulated, 9.98 of 10 times real time"


# ------------------------------------------------------------------------- the control line


class Stage:
    """Remembers what befell whom."""

    def __init__(self) -> None:
        self.befell: list[tuple[AnyFault, int | None]] = []

    def truth(self, system: int) -> Truth | None:
        zero = (0.0, 0.0, 0.0)
        if system != 1:
            return None
        return Truth(1.5, zero, zero, (1.0, 0.0, 0.0, 0.0), zero, 47.0, 8.0, 488.0, False, "X",
                     True, 1.0)  # fmt: skip

    def inject(self, fault: AnyFault, system: int | None) -> bool:
        self.befell.append((fault, system))
        return system in (None, 1)

    def faults(self, system: int | None) -> list[AnyFault]:
        return [fault for fault, whom in self.befell if whom == system]


def ask(stage: Stage, line: str) -> dict[str, object]:
    told = json.loads(answer(line.encode(), stage))
    assert isinstance(told, dict)
    return told


def test_faults_come_by_kind_and_keys() -> None:
    stage = Stage()
    assert ask(stage, '{"id": 1, "do": "fault", "kind": "gps_lost"}') == {"id": 1}
    line = '{"id": 2, "do": "fault", "kind": "motor", "keys": {"motor": 2}, "vehicle": 1}'
    assert ask(stage, line) == {"id": 2}
    assert ask(stage, '{"id": 3, "do": "fault", "kind": "link", "keys": {"loss": 1}}') == {"id": 3}
    assert stage.befell == [
        (GpsLost(), None),
        (MotorFault(2, 0.0), 1),
        (LinkFault(loss=1.0), None),
    ]


def test_the_truth_is_told_as_it_is() -> None:
    told = ask(Stage(), '{"id": 4, "do": "truth"}')
    assert isinstance(told["truth"], dict)
    assert told["truth"]["lat_deg"] == 47.0
    assert told["truth"]["mode"] == "X"


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("nonsense", "no JSON"),
        ("[]", "one JSON object"),
        ("{}", "do: must be fault, mend or truth"),
        ('{"do": "truth", "vehicle": 9}', "no such vehicle"),
        ('{"do": "truth", "vehicle": true}', "must be a system id"),
        ('{"do": "fault", "kind": "gps_lost", "vehicle": 9}', "no such vehicle"),
        ('{"do": "fault", "kind": "gps_lost", "keys": 3}', "keys: must be an object"),
        ('{"do": "fault"}', "kind: must be one of"),
        ('{"do": "fault", "kind": "gps_lost", "keys": {"kind": "reboot", "at": 1}}', "at: "),
    ],
)
def test_what_cannot_be_done_is_answered_with_why(line: str, why: str) -> None:
    assert why in str(ask(Stage(), line)["error"])


def test_lines_are_cut_wherever_the_pipe_cuts_them() -> None:
    lines = Lines()
    assert lines.feed(b'{"a"') == []
    assert lines.feed(b': 1}\n\n{"b": 2}\n{"c"') == [b'{"a": 1}', b'{"b": 2}']
    assert lines.feed(b"x" * 100_000) == []
    assert lines.feed(b"\n{}\n") == [b"{}"]
