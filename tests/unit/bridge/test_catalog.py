"""Every message and every command of the dialect has one kind, and the right one."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import pytest

from gcs.bridge.catalog import Kind, Row, command_row, explain, explanation, message_row
from gcs.bridge.catalog.row import Group, table_of
from gcs.bridge.catalog.tables import command_rows, message_rows
from gcs.wire import dialect
from tests.unit.bridge import client_traffic

MESSAGES = {message.msgid: message.name for message in dialect.MESSAGES.values()}
COMMANDS = {
    entry.value: entry.name.removeprefix("MAV_CMD_") for entry in dialect.ENUMS["MAV_CMD"].entries
}


def differences(names: Mapping[int, str], rows: Mapping[int, Row]) -> list[str]:
    """What has no row, what has one and is not there, what has another name."""
    return [
        *(
            f"{names[number]} ({number}) has no row"
            for number in sorted(names.keys() - rows.keys())
        ),
        *(
            f"{rows[number].name} ({number}) is not in the dialect"
            for number in rows.keys() - names.keys()
        ),
        *(
            f"{number} is {names[number]}, not {rows[number].name}"
            for number in names.keys() & rows.keys()
            if names[number] != rows[number].name
        ),
    ]


def kinds(names: Iterable[str], rows: Mapping[int, Row]) -> dict[str, Kind]:
    by_name = {row.name: row.kind for row in rows.values()}
    return {name: by_name[name] for name in names}


GOLDEN = Path(__file__).parent / "golden" / "kinds.txt"


def all_kinds() -> str:
    """A line for each message and each command: what it is, its number, its name, its kind."""
    tables = (("message", message_rows()), ("command", command_rows()))
    return "".join(
        f"{word} {number} {row.name} {row.kind}\n"
        for word, rows in tables
        for number, row in sorted(rows.items())
    )


def test_no_entry_changes_its_kind_unseen() -> None:
    """The file is read by people when it changes; `python -m tests.unit.bridge.test_catalog` writes
    it anew."""
    assert all_kinds() == GOLDEN.read_text(encoding="utf-8")


class TestTheTableIsTotal:
    def test_every_message_has_a_row_and_nothing_else_has(self) -> None:
        assert differences(MESSAGES, message_rows()) == []

    def test_every_command_has_a_row_and_nothing_else_has(self) -> None:
        assert differences(COMMANDS, command_rows()) == []

    def test_the_supplement_is_part_of_it(self) -> None:
        assert {8, 299, 336, 361, 371, 372, 380} <= message_rows().keys()  # of supplement.py

    def test_an_entry_that_the_dialect_gains_is_seen(self) -> None:
        assert differences(MESSAGES | {54321: "NEW"}, message_rows()) == ["NEW (54321) has no row"]
        assert differences(COMMANDS | {54321: "NEW"}, command_rows()) == ["NEW (54321) has no row"]

    def test_an_entry_that_the_dialect_loses_or_renames_is_seen(self) -> None:
        fewer = {number: name for number, name in MESSAGES.items() if number != 33}
        assert differences(fewer, message_rows()) == [
            "GLOBAL_POSITION_INT (33) is not in the dialect"
        ]
        assert differences(MESSAGES | {33: "NEW"}, message_rows()) == [
            "33 is NEW, not GLOBAL_POSITION_INT"
        ]

    def test_nothing_can_have_two_kinds(self) -> None:
        twice = (Group(Kind.HARMLESS, "", {4: "PING"}), Group(Kind.DENIED, "", {4: "PING"}))
        with pytest.raises(ValueError, match="PING has a row already"):
            table_of(twice)

    def test_every_row_says_why_in_one_sentence(self) -> None:
        for row in (*message_rows().values(), *command_rows().values()):
            assert row.why.endswith("."), row
            assert row.why[0].isupper(), row
            assert ". " not in row.why, row

    def test_what_the_dialect_lacks_is_denied(self) -> None:
        unknown = (message_row(54321), command_row(54321), message_row(-1), command_row(-1))
        assert {row.kind for row in unknown} == {Kind.DENIED}
        assert message_row(54321).name == command_row(54321).name == "UNKNOWN_54321"

    def test_the_page_has_these_figures(self) -> None:
        page = (Path(__file__).parents[3] / "docs" / "bridge.md").read_text(encoding="utf-8")
        of_messages = Counter(row.kind for row in message_rows().values())
        of_commands = Counter(row.kind for row in command_rows().values())
        for kind in Kind:
            commands = f"{of_commands[kind]} " if of_commands[kind] else ""
            assert f"| {kind} | {of_messages[kind]} | {commands}| " in page


RULES = [
    (
        message_rows,
        Kind.DENIED,
        """
        GPS_INPUT GPS_INJECT_DATA ODOMETRY ATT_POS_MOCAP ADSB_VEHICLE COLLISION
        UTM_GLOBAL_POSITION AIS_VESSEL SERIAL_CONTROL TUNNEL SET_ACTUATOR_CONTROL_TARGET
        FOLLOW_TARGET LANDING_TARGET PARAM_MAP_RC
    """,
    ),
    # Actuators.
    (
        command_rows,
        Kind.DENIED,
        """
        DO_MOTOR_TEST ACTUATOR_TEST DO_SET_ACTUATOR DO_SET_SERVO DO_REPEAT_SERVO DO_SET_RELAY
        DO_REPEAT_RELAY CONFIGURE_ACTUATOR DO_AUX_FUNCTION
    """,
    ),
    # Reports of a vehicle: ArduPilot follows other vehicles' positions; all believe them.
    (
        message_rows,
        Kind.DENIED,
        """
        ATTITUDE GLOBAL_POSITION_INT LOCAL_POSITION_NED SYS_STATUS GPS_RAW_INT HOME_POSITION
        BATTERY_STATUS PARAM_VALUE COMMAND_ACK
    """,
    ),
    # The last two are refused by default, and the policy has a key for each.
    (
        message_rows,
        Kind.CONFIGURATION,
        """
        PARAM_SET PARAM_EXT_SET MISSION_COUNT MISSION_ITEM MISSION_ITEM_INT MISSION_CLEAR_ALL
        FENCE_POINT RALLY_POINT SET_HOME_POSITION SETUP_SIGNING FILE_TRANSFER_PROTOCOL
        SET_GPS_GLOBAL_ORIGIN GPS_RTCM_DATA
    """,
    ),
    (
        command_rows,
        Kind.CONFIGURATION,
        """
        DO_SET_HOME DO_FENCE_ENABLE DO_FLIGHTTERMINATION PREFLIGHT_REBOOT_SHUTDOWN
        PREFLIGHT_CALIBRATION PREFLIGHT_STORAGE INJECT_FAILURE DO_SET_GLOBAL_ORIGIN
    """,
    ),
    # Whatever flies at once.
    (
        message_rows,
        Kind.MOTION,
        """
        SET_POSITION_TARGET_LOCAL_NED SET_POSITION_TARGET_GLOBAL_INT SET_ATTITUDE_TARGET
        MANUAL_CONTROL RC_CHANNELS_OVERRIDE MISSION_SET_CURRENT SET_MODE
    """,
    ),
    (
        command_rows,
        Kind.MOTION,
        """
        DO_REPOSITION NAV_TAKEOFF DO_ORBIT MISSION_START NAV_LAND DO_SET_MISSION_CURRENT
        DO_CHANGE_SPEED DO_CHANGE_ALTITUDE DO_SET_MODE COMPONENT_ARM_DISARM
        NAV_RETURN_TO_LAUNCH
    """,
    ),
    # What clients ask when they connect goes through as it is.
    (
        message_rows,
        Kind.HARMLESS,
        """
        PARAM_REQUEST_LIST PARAM_REQUEST_READ MISSION_REQUEST_LIST MISSION_REQUEST_INT
        MISSION_ACK REQUEST_DATA_STREAM PING TIMESYNC LOG_REQUEST_LIST LOG_REQUEST_END
    """,
    ),
    (
        command_rows,
        Kind.HARMLESS,
        """
        REQUEST_MESSAGE SET_MESSAGE_INTERVAL GET_HOME_POSITION IMAGE_START_CAPTURE
        SET_CAMERA_MODE REQUEST_AUTOPILOT_CAPABILITIES
    """,
    ),
    # A client's heartbeat stays at the gate.
    (
        message_rows,
        Kind.LOCAL,
        """
        HEARTBEAT
    """,
    ),
]


class TestTheDesignsRules:
    """What moves a vehicle goes through the gate."""

    @pytest.mark.parametrize(("rows", "kind", "names"), RULES)
    def test_each_is_of_its_kind(
        self, rows: Callable[[], Mapping[int, Row]], kind: Kind, names: str
    ) -> None:
        found = kinds(names.split(), rows())
        assert set(found.values()) == {kind}, found

    def test_what_feeds_the_estimator_is_denied(self) -> None:
        feeds = [name for name in MESSAGES.values() if name.startswith(("HIL_", "VISION_"))]
        assert set(kinds(feeds, message_rows()).values()) == {Kind.DENIED}

    def test_what_carries_a_command_now_is_a_carrier_and_what_carries_one_for_later_is_not(
        self,
    ) -> None:
        carriers = [row.name for row in message_rows().values() if row.kind is Kind.CARRIER]
        assert carriers == ["COMMAND_INT", "COMMAND_LONG"]
        assert message_row(223).kind is message_row(224).kind is Kind.DENIED  # _STAMPED


class TestTargets:
    """A message that names a target is for the vehicle; the dialect says which do."""

    def test_nothing_harmless_or_local_is_a_setpoint(self) -> None:
        setpoints = ("SET_POSITION", "SET_ATTITUDE", "SET_ACTUATOR", "HIL_", "MANUAL_SETPOINT")
        for row in message_rows().values():
            if row.name.startswith(setpoints):
                assert row.kind in (Kind.MOTION, Kind.DENIED), row


class TestWhatRealClientsSend:
    """client_traffic.py is what they were seen to send; only what is dangerous is lost."""

    DENIED_MESSAGES = frozenset({"FOLLOW_TARGET"})
    DENIED_COMMANDS = frozenset(
        {"DO_SET_ACTUATOR", "DO_SET_RELAY", "DO_SET_SERVO", "DO_VTOL_TRANSITION"}
    )

    @pytest.mark.parametrize("client", sorted(client_traffic.MESSAGES))
    def test_no_message_is_denied_but_the_ones_that_move_it_past_the_gate(
        self, client: str
    ) -> None:
        found = kinds(
            client_traffic.MESSAGES[client] - {"COMMAND_INT", "COMMAND_LONG"}, message_rows()
        )
        denied = {name for name, kind in found.items() if kind is Kind.DENIED}
        assert denied == self.DENIED_MESSAGES & client_traffic.MESSAGES[client]

    @pytest.mark.parametrize("client", sorted(client_traffic.COMMANDS))
    def test_no_command_is_denied_but_actuators(self, client: str) -> None:
        found = kinds(client_traffic.COMMANDS[client], command_rows())
        denied = {name for name, kind in found.items() if kind is Kind.DENIED}
        assert denied == self.DENIED_COMMANDS & client_traffic.COMMANDS[client]


class TestExplain:
    @pytest.mark.parametrize(
        "name", ["DO_REPOSITION", "MAV_CMD_DO_REPOSITION", "mav_cmd_do_reposition", " 192 "]
    )
    def test_a_command_by_any_of_its_names(self, name: str) -> None:
        assert explain(name) == command_row(192)

    def test_a_message_by_its_name_or_a_number_that_no_command_has(self) -> None:
        assert explain("param_set") == message_row(23) == explain("PARAM_SET")
        assert explain("110") == message_row(110)

    def test_a_number_of_both_is_the_command(self) -> None:
        assert explain("22").name == "NAV_TAKEOFF"  # and PARAM_VALUE

    def test_close_names_for_a_wrong_one(self) -> None:
        with pytest.raises(KeyError, match="close to it: DO_REPOSITION") as caught:
            explain("DO_REPOSITON")
        assert "denied" in str(caught.value)

    def test_a_messages_name_is_none_of_a_command(self) -> None:
        with pytest.raises(KeyError):
            explain("MAV_CMD_PARAM_SET")

    @pytest.mark.parametrize("name", ["", "999999", "-1", "²"])
    def test_what_nothing_is_called(self, name: str) -> None:
        with pytest.raises(KeyError):
            explain(name)

    def test_the_text_says_what_it_is_what_is_done_and_why(self) -> None:
        assert explanation("do_reposition").splitlines() == [
            "MAV_CMD_DO_REPOSITION, command 192: motion",
            "  from a client: a request of the client, which the gate decides as it does every"
            " operator's",
            "  why: It flies to a position or a height.",
        ]
        assert explanation("GPS_INPUT").startswith("GPS_INPUT, message 232: denied\n")


@pytest.mark.slow
def test_the_table_loads_neither_pymavlink_nor_the_dialect() -> None:
    """A station starts often, and `--explain` answers at once."""
    code = (
        "import sys, gcs.bridge.catalog\n"
        "heavy = {'pymavlink', 'gcs.wire', 'difflib', 'msgspec'} & sys.modules.keys()\n"
        "print(*sorted(heavy))"
    )
    done = subprocess.run(
        [sys.executable, "-S", "-c", code], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.stderr) == ("\n", "")


if __name__ == "__main__":
    GOLDEN.write_text(all_kinds(), encoding="utf-8")
