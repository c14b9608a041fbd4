"""`gcs bridge`: what it takes, what it prints, what its page shows."""

from __future__ import annotations

import io
import json
from pathlib import Path

import msgspec
import pytest
from rich.console import Console

from gcs import ipc
from gcs.bridge.translate.explain import mode_explanation
from gcs.cli import main
from gcs.cli.bridge import text as bridge_text
from gcs.cli.bridge.lines import STATUS_EVERY_NS, BridgeLines
from gcs.cli.bridge.page import BridgePage
from gcs.cli.bridge.watch import watch
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.protocol.autopilot import ARDUPILOT, PX4
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts

VEHICLE = ("--vehicle", "udpin://127.0.0.1:14540")
CLIENT = ("--client", "udpout://127.0.0.1:14550")

HELLO = ipc.Hello(
    "1", "logs/a.mcap", ["udp 127.0.0.1:14540"], "lab", client_ports=["udp 127.0.0.1:14551"]
)
LINK = ipc.BridgeLink(0, "udp 127.0.0.1:14540", 212.4, 4.0, 0.05)
ONE = ipc.BridgeClient(1000, 1, "udp 127.0.0.1:5001", ["255/190"], 1.0, 212.0, in_control=True)
TWO = ipc.BridgeClient(1001, 2, "tcp 127.0.0.1:5002", [], 0.0, 212.0, 3, 40, silent_s=4.2)
STATUS = ipc.BridgeStatus(0, [LINK], [ONE, TWO])
REFUSED = ipc.BridgeDecision(
    0, 1000, "udp 127.0.0.1:5001", "DO_REPOSITION", "refused", "OUTSIDE_FENCE", "350 m outside"
)


def snapshot(vehicle: str = "1/1 px4 quadrotor") -> ipc.Snapshot:
    return ipc.Snapshot(
        0,
        "HOVERING",
        "OURS",
        "CAUTION",
        ["battery_low"],
        0.0,
        "logs/a.mcap",
        True,
        1.25,
        vehicle=vehicle,
        mode="OFFBOARD",
        armed=True,
        in_control=ipc.OperatorInfo(1000, "MAVLink 255/190"),
    )


# ------------------------------------------------------------------------- the command line


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (CLIENT, "where is the vehicle? such as --vehicle udpin://127.0.0.1:14540, or --sim"),
        (VEHICLE, "where do clients reach it? such as --client udpin://127.0.0.1:14551"),
        (("--sim", *VEHICLE, *CLIENT), "--sim starts a vehicle of its own: leave out --vehicle"),
        ((*VEHICLE, "--client", "udq://x:1"), "--client udq://x:1: no known kind of endpoint"),
        (("--vehicle", "udpin://x", *CLIENT), "--vehicle udpin://x: expected HOST:PORT"),
        ((*VEHICLE, *VEHICLE, *CLIENT), "--vehicle udpin://127.0.0.1:14540 is given twice"),
        ((*VEHICLE, *CLIENT, *CLIENT), "--client udpout://127.0.0.1:14550 is given twice"),
        (
            (*VEHICLE, "--client", "udpout://localhost:14540"),
            "--vehicle udpin://127.0.0.1:14540 and --client udpout://localhost:14540 are the same "
            "place: frames would go round in a loop",
        ),
        ((*VEHICLE, "--client", "udp:0.0.0.0:14540"), "are the same place"),
        (
            ("--vehicle", "/dev/ttyUSB0", "--client", "serial:///dev/ttyUSB0:9600"),
            "are the same place",
        ),
        ((*VEHICLE, *CLIENT, "--speedup", "2"), "--speedup is for the vehicle of --sim"),
        ((*VEHICLE, *CLIENT, "--compid", "0"), "--compid"),
    ],
)
def test_usage_errors(args: tuple[str, ...], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main.run(["bridge", *args]) == ExitCode.USAGE
    said = " ".join(capsys.readouterr().err.split())
    assert told in said


def test_the_same_port_by_udp_and_by_tcp_are_two_places() -> None:
    from gcs.cli.bridge_places import refuse_shared_places

    refuse_shared_places(
        ["udpin://127.0.0.1:14550"],
        ["tcpin://127.0.0.1:14550", "udpin://127.0.0.1:0", "udpin://127.0.0.1:0"],
    )
    refuse_shared_places(["udpin://127.0.0.1:14550"], ["udpout://10.0.0.7:14550"])


def test_fly_refuses_a_client_at_its_own_link(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["fly", "--plain", "--client", "udpin://127.0.0.1:14550"]
    assert main.run(args) == ExitCode.USAGE
    assert "are the same place" in " ".join(capsys.readouterr().err.split())


def test_a_missing_policy_is_a_bad_file(capsys: pytest.CaptureFixture[str]) -> None:
    args = ["bridge", *VEHICLE, *CLIENT, "--policy", "nowhere.toml"]
    assert main.run(args) == ExitCode.BAD_FILE
    assert "nowhere.toml: no such policy file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("do_reposition", ("MAV_CMD_DO_REPOSITION, command 192: motion", "  why: ")),
        ("22", ("MAV_CMD_NAV_TAKEOFF, command 22: motion", "  why: ")),
        ("MANUAL_CONTROL", ("MANUAL_CONTROL, message 69: motion", "samples of a velocity stream")),
        (
            "MAV_CMD_DO_CHANGE_ALTITUDE",
            ("command 186: motion", "  the gate makes of it: PX4: goto straight up or down"),
        ),
        ("SET_MODE", ("message 11: motion", "  the gate makes of it: as DO_SET_MODE")),
        ("SDLOG_MODE", ("that safety does not stand on", "  px4, from a client: written")),
        (
            "DO_FLIGHTTERMINATION",
            (
                "command 185: configuration",
                'policy: `termination` of [bridge] is "refuse"',
            ),
        ),
        ("INJECT_FAILURE", ("policy: no key of [bridge] lets it through",)),
        ("PARAM_SET", ("PARAM_SET, message 23: configuration", "  why: ")),
        (
            "gf_action",
            (
                "GF_ACTION, a parameter that safety",
                "px4, from a client: not written: GF_ACTION is guarded: it is of",
            ),
        ),
    ],
)
def test_explain_needs_nothing_else(
    name: str, told: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main.run(["bridge", "--explain", name]) == ExitCode.DONE
    said = capsys.readouterr().out
    assert all(each in said for each in told), said


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        (
            "posctl",
            (
                "POSCTL, a mode of px4: a pilot flies it with sticks",
                "    hovering, the client sends sticks: nothing, it is so already",
                "refused POLICY: POSCTL: no MANUAL_CONTROL comes from this client",
            ),
        ),
        (
            "LOITER",
            (
                "AUTO.LOITER, a mode of px4: it holds its place",
                "LOITER, a mode of ardupilot: it holds its place",
                "hold (LOITER: held in BRAKE instead, as LOITER obeys the sticks)",
            ),
        ),
        ("GUIDED", ("    on hold: resume", "    returning: hold, then resume")),
        ("AUTO", ("AUTO, a mode of ardupilot", "    on hold: resume, then mission start")),
    ],
)
def test_explain_knows_the_modes_of_both_autopilots(
    name: str, lines: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main.run(["bridge", "--explain", name]) == ExitCode.DONE
    told = capsys.readouterr().out
    for line in lines:
        assert line in told


def test_every_mode_of_both_autopilots_can_be_explained() -> None:
    for autopilot in (PX4, ARDUPILOT):
        for mode in autopilot.modes:
            assert f"{mode.name}, a mode of {autopilot.name}" in (
                mode_explanation(mode.name, ()) or ""
            )
    assert mode_explanation("NO_SUCH", ()) is None


def test_explain_of_what_there_is_not_names_what_is_close(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main.run(["bridge", "--explain", "DO_REPOSITON"]) == ExitCode.USAGE
    assert "DO_REPOSITION" in capsys.readouterr().err


def test_explain_goes_by_the_policy(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    policy = tmp_path / "my.toml"
    text = '[bridge]\nparameters_allowed = ["GF_*"]\nmanual_modes = ["POSCTL"]\n'
    policy.write_text(text, encoding="utf-8")
    for name, told in (("GF_ACTION", "px4, from a client: written"), ("POSCTL", "forwarded to")):
        assert main.run(["bridge", "--explain", name, "--policy", str(policy)]) == ExitCode.DONE
        assert told in capsys.readouterr().out
    policy.write_text("[bridge]\nfenc = 1\n", encoding="utf-8")
    assert main.run(["bridge", "--explain", "POSCTL", "--policy", str(policy)]) == ExitCode.BAD_FILE
    assert "my.toml:2: bridge.fenc" in capsys.readouterr().err


def test_explain_tells_that_an_unknown_parameter_is_guarded(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main.run(["bridge", "--explain", "NEW_IN_5_0"]) == ExitCode.USAGE
    said = capsys.readouterr().err
    assert "'NEW_IN_5_0' is no message and no command of the dialect" in said
    assert "hint: if it is a parameter: no table here knows it" in said


# ------------------------------------------------------------------------------------ words


def test_the_vehicle_in_a_line() -> None:
    assert bridge_text.vehicle_line(snapshot()).startswith(
        "1/1 px4 quadrotor, HOVERING, control OURS, severity CAUTION, at E - N - U - m, "
        "mode OFFBOARD, armed, "
    )
    assert bridge_text.vehicle_line(None) == "no vehicle heard yet"
    assert bridge_text.conditions_line(snapshot()) == "battery_low"


def test_links_and_clients_in_rows() -> None:
    assert bridge_text.link_rows(STATUS)[1:] == [("udp 127.0.0.1:14540", "212", "4", "0.1 %", "")]
    assert bridge_text.client_rows(STATUS)[1:] == [
        ("1000", "udp 127.0.0.1:5001", "255/190", "1", "212", "0", "0", "IN CONTROL"),
        ("1001", "tcp 127.0.0.1:5002", "-", "0", "212", "3", "40", "silent for 4 s"),
    ]
    assert len(bridge_text.client_rows(None)) == 1


def test_a_client_that_is_not_verified_is_named_so() -> None:
    stranger = ipc.BridgeClient(0, 3, "udp 127.0.0.1:5003", signed="2 unsigned", verified=False)
    status = ipc.BridgeStatus(0, [LINK], [ONE, stranger])
    assert bridge_text.client_rows(status)[2][-1] == "not verified, 2 unsigned"
    assert "2 clients (1 not verified), 0 refused;" in bridge_text.status_line(status, snapshot())


def test_a_place_where_nobody_is_heard_is_no_client() -> None:
    named = ipc.BridgeClient(0, 3, "udp 127.0.0.1:14550")
    status = ipc.BridgeStatus(0, [LINK], [named])
    assert bridge_text.client_rows(status)[1][-1] == "not heard"
    assert "0 clients (1 not heard), 0 refused;" in bridge_text.status_line(status, snapshot())


# ------------------------------------------------------------------------------------ lines


class Printed:
    def __init__(self, *, as_json: bool = False) -> None:
        self.out: list[str] = []
        self.err: list[str] = []
        self.lines = BridgeLines(self.out.append, self.err.append, min_level=2, as_json=as_json)

    def __call__(self, *events: ipc.Event) -> Printed:
        for event in events:
            self.lines.event(event)
        self.lines.draw()
        return self


def test_a_refusal_is_a_line_with_its_reason() -> None:
    assert Printed()(REFUSED).out == [
        "1000 (udp 127.0.0.1:5001) DO_REPOSITION: refused OUTSIDE_FENCE: 350 m outside"
    ]


def test_the_status_comes_every_ten_seconds_and_when_clients_change() -> None:
    printed = Printed()(snapshot(), STATUS)
    line = (
        "bridge: 212/s in, 4/s out, 0.1 % lost; 2 clients, 3 refused, 40 dropped; "
        "in control: 1000 (MAVLink 255/190)"
    )
    assert printed.out[1:] == [line]
    printed(ipc.BridgeStatus(STATUS_EVERY_NS - 1, [LINK], [ONE, TWO]))
    assert len(printed.out) == 2
    printed(ipc.BridgeStatus(STATUS_EVERY_NS, [LINK], [ONE, TWO]))
    assert printed.out[2:] == [line]
    printed(ipc.BridgeStatus(STATUS_EVERY_NS + 1, [LINK], [ONE]))
    assert "1 client, 0 refused" in printed.out[3]


def test_the_log_goes_to_standard_error_from_its_level_up() -> None:
    printed = Printed()(HELLO, ipc.LogEvent(0, 1, "link", "detail"), ipc.LogEvent(0, 3, "x", "y"))
    assert printed.err == [
        "vehicle: udp 127.0.0.1:14540",
        "clients: udp 127.0.0.1:14551",
        "policy: lab; log: logs/a.mcap",
        "WARN  x: y",
    ]
    assert printed.out == []


def test_json_is_every_event_as_it_came() -> None:
    printed = Printed(as_json=True)(HELLO, STATUS, REFUSED)
    assert [json.loads(line)["type"] for line in printed.out] == [
        "hello",
        "bridge",
        "bridge_decision",
    ]
    assert [ipc.decode_event(line.encode()) for line in printed.out] == [HELLO, STATUS, REFUSED]


# ------------------------------------------------------------------------------------- page


def drawn(*events: ipc.Event, height: int = 40, width: int = 150) -> str:
    with BridgePage(2) as page:
        for event in (HELLO, *events):
            page.event(event)
    out = io.StringIO()
    Console(file=out, width=width).print(page.page(height, width))
    return out.getvalue()


def test_the_page_shows_vehicle_control_links_clients_and_decisions() -> None:
    text = drawn(snapshot(), STATUS, REFUSED)
    assert "1/1 px4 quadrotor, HOVERING" in text
    assert "in control: 1000 (MAVLink 255/190)" in text
    assert "wrong: battery_low" in text
    assert "212.4" not in text
    for row in (*bridge_text.link_rows(STATUS), *bridge_text.client_rows(STATUS)):
        assert all(word in text for word in row)
    assert "DO_REPOSITION: refused OUTSIDE_FENCE: 350 m outside" in text
    assert "log: logs/a.mcap, 1.2 MB" in text


def test_an_empty_page_says_where_clients_may_come() -> None:
    text = drawn()
    assert "no vehicle heard yet" in text
    assert "nobody yet; udp 127.0.0.1:14551" in text


FLEET = [
    ipc.BridgeVehicle(1, "1/1 px4 quadrotor", "HOVERING", "OURS", "NOMINAL", [], "OFFBOARD", True),
    ipc.BridgeVehicle(
        2, "2/1 ardupilot quadrotor", "STALE", "OURS", "CAUTION", ["too_close"], "GUIDED", True,
        lost_pct=1.25, silent_s=4.1, pos_enu=(1.04, -20.0, 10.06), v_enu=(3.0, 4.0, 0.0),
        battery_pct=71.4,
    ),
]  # fmt: skip


def test_the_page_shows_several_vehicles_in_rows() -> None:
    text = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], [ONE], FLEET))
    for row in bridge_text.vehicle_rows(ipc.BridgeStatus(0, [LINK], [ONE], FLEET)):
        assert all(word in text for word in row)
    assert "armed, silent for 4 s, too_close" in text
    assert bridge_text.vehicle_rows(ipc.BridgeStatus(0, [LINK], [ONE], FLEET))[2][5:8] == (
        *("1.0 -20.0 10.1", "5.0", "71 %"),
    )
    assert bridge_text.vehicle_rows(ipc.BridgeStatus(0, [LINK], [ONE], FLEET[:1])) == []


def test_one_vehicle_is_shown_once() -> None:
    text = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], [ONE], FLEET[:1]))
    assert text.count("1/1 px4 quadrotor") == 1
    assert text.count("in control") == 1


def test_of_several_vehicles_each_is_shown_once() -> None:
    for width in (80, 150):
        text = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], [ONE], FLEET), width=width)
        assert [text.count(each.name) for each in FLEET] == [1, 1], text


def test_on_80_columns_the_notes_of_several_vehicles_stand_below_them() -> None:
    lines = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], [ONE], FLEET), width=80).splitlines()
    assert lines[3:5] == ["vehicle 1: armed", "vehicle 2: armed, silent for 4 s, too_close"]


LOST = msgspec.structs.replace(FLEET[1], state="NO_VEHICLE", silent_s=72.4, conditions=[])


def test_a_lost_vehicle_of_several_is_lost_for_so_long_and_in_no_mode() -> None:
    status = ipc.BridgeStatus(0, [LINK], [ONE], [FLEET[0], LOST])
    row = dict(zip(bridge_text.VEHICLES_HEAD, bridge_text.vehicle_rows(status)[2], strict=True))
    assert (row["mode"], row["m/s"], row["east north up"]) == ("-", "-", "1.0 -20.0 10.1")
    assert row[""] == "armed, lost for 72 s"
    text = drawn(snapshot(), status)
    assert "GUIDED" not in text
    assert "lost for 72 s" in text
    assert "vehicle 2: armed, lost for 72 s" in drawn(snapshot(), status, width=80)


def test_one_lost_vehicle_is_lost_for_so_long_and_in_no_mode() -> None:
    text = drawn(msgspec.structs.replace(snapshot(), state="NO_VEHICLE", heartbeat_age_s=72.4))
    assert "1/1 px4 quadrotor, NO_VEHICLE, control OURS, severity CAUTION, lost for 72 s" in text
    assert "last at E - N - U - m, armed" in text
    assert "OFFBOARD" not in text


def test_a_battery_that_is_not_known_has_no_per_cent() -> None:
    assert bridge_text.vehicle_line(snapshot()).endswith("armed, battery -")
    known = msgspec.structs.replace(snapshot(), battery_pct=71.4)
    assert bridge_text.vehicle_line(known).endswith("armed, battery 71 %")


def test_a_link_on_which_nothing_is_heard_says_so() -> None:
    """It may be one of several, or one that only sends: a vehicle is answered where it is heard."""
    silent = ipc.BridgeLink(1, "listening on udp 127.0.0.1:14541", 0.0, 1.0, 0.0)
    rows = bridge_text.link_rows(ipc.BridgeStatus(0, [LINK, silent], []))
    assert [row[-1] for row in rows[1:]] == ["", "nothing is heard here"]


def test_on_80_columns_where_each_vehicle_is_can_be_read() -> None:
    lines = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], [ONE], FLEET), width=80).splitlines()
    head, _, second = lines[lines.index(next(x for x in lines if x.startswith("vehicle  "))) :][:3]
    assert head.split() == ["vehicle", "state", "mode", "east", "north", "up", "m/s", "battery"]
    for word in ("2/1 ardupilot quadrotor", "STALE", "GUIDED", "1.0 -20.0 10.1", "5.0", "71 %"):
        assert word in second


def test_a_decision_names_its_vehicle_where_there_are_several() -> None:
    decision = ipc.BridgeDecision(0, 1000, "udp", "goto", "accepted", vehicle=2)
    out: list[str] = []
    lines = BridgeLines(out.append, out.append, min_level=2, as_json=False)
    lines.event(ipc.BridgeStatus(0, [LINK], [ONE], FLEET[:1]))
    lines.event(decision)
    assert out[-1] == "1000 (udp) goto: accepted"
    lines.event(ipc.BridgeStatus(1, [LINK], [ONE], FLEET))
    assert out[-1] == "vehicle 2: NO_VEHICLE -> STALE, control OURS, severity CAUTION"
    lines.event(decision)
    assert out[-1] == "1000 (udp) goto of vehicle 2: accepted"


def test_a_low_terminal_shows_as_many_clients_as_fit() -> None:
    crowd = [ipc.BridgeClient(1000 + n, n, f"udp 127.0.0.1:{6000 + n}") for n in range(32)]
    events = [REFUSED] * 20
    text = drawn(snapshot(), ipc.BridgeStatus(0, [LINK], crowd), *events, height=24)
    assert len(text.splitlines()) <= 24
    assert "and 28 more" in text


# ---------------------------------------------------------------------------------- watching


class Told:
    def __init__(self) -> None:
        self.events: list[ipc.Event] = []
        self.draws = 0

    def event(self, event: ipc.Event) -> None:
        self.events.append(event)

    def draw(self) -> None:
        self.draws += 1


class DrawnFiveTimes(Told):
    """After that, there is a SIGTERM."""

    def __init__(self, interrupts: NoInterrupts) -> None:
        super().__init__()
        self._interrupts = interrupts

    def draw(self) -> None:
        super().draw()
        if self.draws == 5:
            self._interrupts.name = "SIGTERM"


def test_a_signal_ends_it_in_good_order() -> None:
    interrupts, connection = NoInterrupts(), FakeConnection(FakeStation("airborne"))
    told = DrawnFiveTimes(interrupts)
    ended = watch(connection, interrupts, told, None)
    assert ended.bye is not None
    assert ended.bye.exit_code == 0
    assert connection.sent == [ipc.Leave("SIGTERM")]
    assert isinstance(told.events[0], ipc.Hello)


def test_a_port_in_use_is_the_exit_code_of_the_station() -> None:
    with pytest.raises(ExitError) as caught:
        watch(FakeConnection(FakeStation("port in use")), NoInterrupts(), Told(), None)
    assert caught.value.exit_code == ExitCode.ADDRESS_IN_USE


def test_with_a_time_out_no_vehicle_is_an_exit_code() -> None:
    connection = FakeConnection(FakeStation("silent"))
    with pytest.raises(ExitError) as caught:
        watch(connection, NoInterrupts(), Told(), 3.0)
    assert caught.value.exit_code == ExitCode.NO_VEHICLE
    assert caught.value.hint.endswith("use --sim, or say with --vehicle where it is")
    assert connection.sent == [ipc.Leave("no vehicle was heard")]
