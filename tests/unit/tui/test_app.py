"""The keyboard station, driven by real key presses against a fake station."""

from __future__ import annotations

import asyncio

import msgspec
import pytest
from textual.events import Key, MouseScrollUp
from textual.geometry import Region
from textual.pilot import Pilot

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.client import StationEnded
from gcs.operator.conversation import Conversation
from gcs.operator.errors import ExitError, Interrupted
from gcs.tui.app import FlyApp
from gcs.tui.keymap import DEFAULT, keymap
from gcs.tui.panels.panel import Panel
from gcs.tui.result import SessionResult, print_result, until_hello
from tests.shares import one_in
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts
from tests.unit.tui.flown import drawn, flown, screen_text
from tests.unit.tui.listening_station import ListeningStation

pytestmark = pytest.mark.slow  # the screen's own timers


def test_moving_keys_send_no_request_and_one_keyboard_record_a_change() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("right", "up", "d", "w", "pageup", "r", "left", "s", "f", "]", "\\", "x")
        assert station.requests() == []
        assert all(isinstance(command, ipc.Pending) for command in station.sent)
        # Twelve keys, of which the step changes no goal.
        assert len(station.sent) == 11

    flown(script)


def test_enter_sends_the_pending_goal_once_and_keeps_it() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("right", "enter")
        goals = [command for command in station.sent if isinstance(command, ipc.Ask)]
        assert [goal.word for goal in goals] == ["goto"]
        assert goals[0].goal_enu == (1.0, 0.0, 0.5)
        assert goals[0].yaw_deg is None
        assert app.scene.pending.goal_enu == (1.0, 0.0, 0.5)

    flown(script)


def test_every_command_key_asks_for_its_word() -> None:
    async def script(_app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("c", "m", "t", "l", "b", "h", "e", "p", "i", "k", "M")
        assert station.requests() == [
            "control", "arm", "takeoff", "land", "rtl", "hold", "resume", "photo",
            "mission_start", "fence", "disarm",
        ]  # fmt: skip

    flown(script)


def test_keys_that_a_user_has_chosen_do_what_theirs_did_and_are_shown() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("h", "H", "space", "left_square_bracket")
        assert station.requests() == ["hold", "abort"]
        await drawn(app, pilot)
        assert "[ ABORT" in screen_text(app)

    flown(script, keys=keymap({"hold": ["H"], "abort": ["["], "yaw_left": ["{"]}))


def test_in_velocity_mode_a_direction_key_is_flown_while_it_is_held_down() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.state = "HOVERING"
        await pilot.press("y", "x", "right")
        assert station.requests() == ["stream_begin"]
        assert station.sent[-1] == ipc.Stream(v_enu=(5.0, 0.0, 0.0))
        assert app.scene.pending.goal_enu == (0.0, 0.0, 0.5)
        await asyncio.sleep(1.1)
        assert station.sent[-1] == ipc.Stream(v_enu=(0.0, 0.0, 0.0))
        await drawn(app, pilot)
        assert "velocity mode: keys fly 5 m/s" in screen_text(app)
        await pilot.press("y")
        assert station.requests()[-1] == "stream_end"
        assert app.scene.velocity is None
        await pilot.press("left")
        assert app.scene.pending.goal_enu == (-5.0, 0.0, 0.5)

    flown(script)


@pytest.mark.parametrize(
    "event",
    [
        ipc.VerdictEvent(1, "stream_begin", "refused", "NOT_FLYING", "it stands"),
        ipc.StateEvent("STREAMING", "HOLDING", "hold", "OURS", "NOMINAL"),
    ],
)
def test_velocity_mode_ends_with_its_stream(event: ipc.Event) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.state = "HOVERING"
        await pilot.press("y")
        assert app.scene.velocity is not None
        station.say(event)
        await pilot.pause()
        assert app.scene.velocity is None

    flown(script)


@pytest.mark.parametrize("key", ["space", "escape", "alt+m"])
def test_abort_is_one_key_and_is_on_its_way_before_anything_is_drawn(key: str) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        app.post_message(Key(key, "m"))  # Esc and m in one read come as Alt-m
        await pilot.pause()
        assert station.requests() == ["abort"]

    flown(script)


@pytest.mark.parametrize(
    "key", one_in(3, ["escape", "question_mark", "enter", "m", "right", "q", "ctrl+c", "y", "tab"])
)
def test_under_the_help_page_any_key_closes_it_and_does_nothing_else(key: str) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        assert app.query_one("#help").display
        await pilot.press(key)
        assert not app.query_one("#help").display
        assert station.sent == []
        await pilot.press("m")
        assert station.requests() == ["arm"]

    flown(script)


def test_the_help_page_has_every_key_on_a_small_terminal() -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        await drawn(app, pilot)
        shown = screen_text(app)
        assert [key.help for key in DEFAULT.keys if key.help not in shown] == []
        assert "any key closes this" in shown

    flown(script, (80, 24))


def test_under_the_help_page_space_aborts_and_closes_it() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark", "space")
        assert station.requests() == ["abort"]
        assert not app.query_one("#help").display

    flown(script)


def test_a_fence_that_is_off_is_on_the_screen_until_it_is_on_again() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("k")
        await drawn(app, pilot)
        assert "FENCE OFF" in screen_text(app)
        await pilot.press("k")
        await drawn(app, pilot)
        assert "FENCE OFF" not in screen_text(app)
        requests = [sent for sent in station.sent if isinstance(sent, ipc.Ask)]
        assert [request.on for request in requests] == [False, True]

    flown(script)


def test_after_a_take_off_a_goal_that_nobody_has_set_is_where_it_hovers() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.pos = (0.04, -0.03, 0.0)
        await pilot.press("m", "t")
        station.fly(1.5)
        await pilot.pause()
        assert app.scene.pending.goal_enu == (0.0, 0.0, 1.5)
        assert not any(isinstance(command, ipc.Pending) for command in station.sent)
        await pilot.press("right")
        station.fly(1.0)
        await pilot.pause()
        assert app.scene.pending.goal_enu == (1.0, 0.0, 1.5)

    flown(script)


@pytest.mark.parametrize("keys", ["m t right", "right m t"])
def test_a_goal_set_before_or_during_the_take_off_stays(keys: str) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press(*keys.split())
        station.fly(2.0)
        await pilot.pause()
        assert app.scene.pending.goal_enu == (1.0, 0.0, 0.5)

    flown(script)


def test_a_vehicle_that_is_lost_is_seen_to_be_lost() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        lost = msgspec.structs.replace(
            station.station.snapshot(), state="NO_VEHICLE", heartbeat_age_s=12.3
        )
        station.say(lost)
        await drawn(app, pilot)
        shown = screen_text(app)
        assert "LINK LOST 12 s" in shown
        assert "link 0 Hz" in shown

    flown(script)


@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
def test_a_long_log_line_is_wrapped_with_its_last_word_in_sight(size: tuple[int, int]) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        for number in range(20):
            station.say(ipc.LogEvent(0, 2, "gate", f"{number} " + "abcdefghi " * 12 + "THE-END"))
        await drawn(app, pilot)
        log = screen_text(app).splitlines()[:-2]
        assert "THE-END" in log[-1]
        assert (log[-2] + log[-1]).count("abcdefghi") == 12
        # The first row is as full as words of this length let it be.
        assert len(log[-2].rstrip()) > size[0] - 14

    flown(script, size)


def test_a_refusal_has_its_verdict_first_and_its_numbers_on_a_second_line() -> None:
    sentence = (
        "the goal (500.00 E, 0.00 N, 2.00 U) is outside inclusion circle 'default': 350.0 m too far"
    )

    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(ipc.VerdictEvent(1, "goto", "refused", "OUTSIDE_FENCE", sentence))
        await drawn(app, pilot)
        rows = screen_text(app).splitlines()
        (at,) = [number for number, row in enumerate(rows) if "OUTSIDE_FENCE" in row]
        assert rows[at].strip().startswith("refused OUTSIDE_FENCE goto: the goal (500.00 E")
        assert rows[at + 1].rstrip().endswith("350.0 m too far")

    flown(script, (80, 24))


def test_a_sentence_too_long_for_two_lines_ends_in_an_ellipsis() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(ipc.VerdictEvent(1, "goto", "refused", "OUTSIDE_FENCE", "far away " * 20))
        await drawn(app, pilot)
        rows = screen_text(app).splitlines()
        (at,) = [number for number, row in enumerate(rows) if "OUTSIDE_FENCE" in row]
        assert rows[at + 1].rstrip().endswith("…")

    flown(script, (80, 24))


def test_a_refusal_stays_until_the_next_key_whatever_else_ends() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.armed = True
        await pilot.press("t", "p")
        await drawn(app, pilot)
        assert "refused BUSY photo" in screen_text(app)
        station.fly(5.0)
        await drawn(app, pilot)
        assert "refused BUSY photo" in screen_text(app)
        await pilot.press("x", "p")
        await drawn(app, pilot)
        assert "photo: accepted" in screen_text(app)

    flown(script)


def test_a_stop_is_told_twice_its_mode_is_seen_and_the_vehicle_stands() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        fast = msgspec.structs.replace(
            station.station.snapshot(), state="HOLDING", v_enu=(4.5, 0.0, 0.0)
        )
        station.say(fast)
        await pilot.press("h")
        await drawn(app, pilot)
        assert "hold: complete: hold mode seen, still moving at 4.5 m/s" in screen_text(app)
        station.say(msgspec.structs.replace(fast, v_enu=(0.1, 0.0, 0.0)))
        await drawn(app, pilot)
        assert "hold: the vehicle stands" in screen_text(app)
        assert [each.text for each in app.scene.decisions][-1] == "hold: the vehicle stands"

    flown(script)


def test_whoever_joins_sees_what_was_decided_and_what_others_are_told() -> None:
    asked = ipc.Ask(3, "goto", goal_enu=(3.0, 0.0, 2.0))
    goto = ipc.Operation(7, asked, 4, "gcs fly, pid 1", 2 * 10**9)
    arm = ipc.Operation(6, ipc.Ask(2, "arm"), 4, "gcs fly, pid 1", 0, "complete", ended_ns=10**9)

    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        assert any(isinstance(each, ipc.ListOperations) for each in station.looked)
        station.say(ipc.OperationList(1, [arm, goto]))
        station.say(msgspec.structs.replace(goto, state="aborted", code="OPERATOR", ended_ns=3))
        await pilot.pause()
        assert [each.text for each in app.scene.decisions] == [
            "arm of operator 4: accepted",
            "arm of operator 4: complete",
            "goto 3 0 2 of operator 4: accepted",
            "goto 3 0 2 of operator 4: aborted OPERATOR",
        ]

    flown(script)


def test_a_transfer_is_shown_until_its_last_step() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(ipc.ProgressEvent(9, "reading back", 3, 7, "items"))
        await drawn(app, pilot)
        assert "reading back: 3 of 7 items" in screen_text(app)
        station.say(ipc.ProgressEvent(9, "reading back", 7, 7, "items"))
        await drawn(app, pilot)
        assert "reading back" not in screen_text(app)

    flown(script)


@pytest.mark.parametrize(
    ("size", "before", "after"),
    [((80, 24), "pos", "mission:"), ((120, 40), "TAKING_OFF", "mission:")],
)
def test_a_key_puts_the_mission_in_the_place_of_what_is_less_needed(
    size: tuple[int, int], before: str, after: str
) -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await drawn(app, pilot)
        assert (before in screen_text(app), after in screen_text(app)) == (True, False)
        await pilot.press("I")
        await drawn(app, pilot)
        assert (before in screen_text(app), after in screen_text(app)) == (False, True)
        await pilot.press("I")
        await drawn(app, pilot)
        assert (before in screen_text(app), after in screen_text(app)) == (True, False)

    flown(script, size)


def test_a_tall_screen_always_has_the_mission() -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await drawn(app, pilot)
        assert "mission: none" in screen_text(app)
        assert "HOVERING" in screen_text(app)

    flown(script, (200, 60))


def test_an_outcome_is_not_shown_for_ever() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("m")
        await drawn(app, pilot)
        assert "arm: complete" in screen_text(app)
        station.fly(10.5)
        await drawn(app, pilot)
        assert "arm: complete" not in screen_text(app)
        assert "nothing asked lately" in screen_text(app)

    flown(script)


def test_debug_lines_are_on_the_screen_only_when_asked_for() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(
            ipc.LogEvent(0, 4, "gate", "an error"),
            *(ipc.LogEvent(0, 1, "loop", f"a tick came {n} ms late") for n in range(20, 60)),
            ipc.LogEvent(0, 2, "gate", "a state"),
        )
        await drawn(app, pilot)
        assert "a tick came" not in screen_text(app)
        assert "an error" in screen_text(app)
        assert "a state" in screen_text(app)
        await pilot.press("g")
        await drawn(app, pilot)
        assert "an error" in screen_text(app)
        assert "a state" not in screen_text(app)
        await pilot.press("g")
        await drawn(app, pilot)
        shown = screen_text(app)
        assert shown.count("a tick came") == 1
        assert "a tick came 20 ms late" in shown
        assert "the like of it 39 times more" in shown
        assert "a state" in shown

    flown(script)


def test_lines_that_differ_in_a_number_are_folded_only_if_they_are_debug_lines() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        same = ipc.LogEvent(0, 3, "vehicle", "low battery")
        station.say(*(ipc.LogEvent(0, 2, "gate", f"item {n} reached") for n in (1, 2)), same, same)
        station.say(ipc.LogEvent(0, 2, "gate", "item 3 reached"))
        await drawn(app, pilot)
        shown = screen_text(app)
        assert [f"item {n} reached" in shown for n in (1, 2, 3)] == [True, True, True]
        assert shown.count("low battery") == 1
        assert "the like of it once more" in shown

    flown(script)


def test_the_log_is_wrapped_again_for_a_narrower_screen_and_stays_at_its_end() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        for letter in "abcdefghijklmnopqrst":
            station.say(ipc.LogEvent(0, 2, "gate", f"{letter} " + "abcdefghi " * 12 + "THE-END"))
        await drawn(app, pilot)
        await pilot.resize_terminal(80, 30)
        await drawn(app, pilot)
        log = screen_text(app).splitlines()[:-2]
        assert "THE-END" in log[-1]
        assert (log[-2] + log[-1]).count("abcdefghi") == 12
        assert " t " in log[-2]

    flown(script, (160, 40))


def test_the_wheel_looks_back_in_the_log_and_new_lines_leave_it_there() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        for n in range(40):
            station.say(ipc.LogEvent(0, 2, "gate", f"line {n}."))
        await drawn(app, pilot)
        assert "line 39." in screen_text(app)
        for _ in range(4):
            await pilot._post_mouse_events([MouseScrollUp], "#log", offset=(5, 1))
        station.say(ipc.LogEvent(0, 2, "gate", "the next line"))
        await drawn(app, pilot)
        shown = screen_text(app)
        assert "14 rows below" in shown  # 12 by the wheel, the next, and the row that says it
        assert "line 26." in shown
        assert "the next line" not in shown

    flown(script)


def test_only_the_rows_that_changed_are_painted() -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await drawn(app, pilot)
        painted: list[Region] = []
        panel = app.query_one("#vehicle", Panel)
        panel.refresh = lambda *regions, **_: painted.extend(regions)  # type: ignore[method-assign, assignment]
        seen = app.scene.snapshot
        assert seen is not None
        app.scene.update(msgspec.structs.replace(seen, battery_pct=50.0))
        panel.redraw()
        assert len(painted) == 1
        assert "batt" in "".join(s.text for s in panel.render_line(painted[0].y))

    flown(script)


def test_the_mission_key_uploads_the_mission_of_the_command_line_and_then_starts_it() -> None:
    async def run(*keys: str) -> ListeningStation:
        station = ListeningStation(FakeStation("slow upload"))
        app = FlyApp(station, mission_path="survey.plan")
        async with app.run_test() as pilot:
            await pilot.press("m", "t")
            station.fly(2.0)
            await pilot.pause()
            await pilot.press("i", *keys)
            station.fly(2.0)
            await pilot.pause()
        return station

    flew = asyncio.run(run())
    assert flew.requests() == ["arm", "takeoff", "mission_upload", "mission_start"]
    (upload,) = (c for c in flew.sent if isinstance(c, ipc.Ask) and c.word == "mission_upload")
    assert upload.path == "survey.plan"
    # Whoever aborts meanwhile does not want it started any more.
    aborted = asyncio.run(run("space"))
    assert aborted.requests() == ["arm", "takeoff", "mission_upload", "abort"]


def test_without_a_vehicle_it_says_what_to_do_and_leaves_when_the_time_is_over() -> None:
    async def run() -> tuple[FlyApp, ListeningStation]:
        station = ListeningStation(FakeStation("silent"))
        app = FlyApp(station, timeout_s=3.0)
        async with app.run_test() as pilot:
            await drawn(app, pilot)
            assert "start one: vehicle-sim" in screen_text(app)
            assert not any(isinstance(command, ipc.Leave) for command in station.sent)
            while not station.sent:
                await pilot.pause(0.1)
        return app, station

    app, station = asyncio.run(run())
    assert station.sent == [ipc.Leave("no vehicle heard")]
    assert not app.heard_vehicle


def test_a_simulated_vehicle_is_said_to_end_with_its_station() -> None:
    bye = ipc.Bye(0, "logs/x.mcap", "the vehicle is STILL FLYING in AUTO.LOITER")
    told: list[str] = []
    talk = Conversation()
    talk.told(StationEnded(bye, 0, ""))
    assert (
        print_result(SessionResult(talk, asked=True), told.append, simulated=True) == ExitCode.DONE
    )
    assert told[1] == "gcs: the simulation has ended with it, and its vehicle"


def test_a_ctrl_c_before_the_screen_is_taken_leaves_the_station() -> None:
    interrupts = NoInterrupts()
    interrupts.name = "SIGINT"
    client = FakeConnection(FakeStation())
    with pytest.raises(Interrupted):
        until_hello(client, interrupts)
    assert client.sent == [ipc.Leave("SIGINT")]
    assert client.closed


def test_a_flight_is_seen_with_pending_and_active_goal_apart() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("m", "t")
        station.fly(1.0)
        await pilot.pause()
        await pilot.press("right", "right", "right", "enter", "up")
        station.fly(0.5)
        await drawn(app, pilot)
        shown = screen_text(app)
        assert "pending E +3.00 N +1.00 U +1.50" in shown
        assert "active E +3.00 N +0.00 U +1.50" in shown
        assert "MOVING" in shown
        assert "goto 3 0 1.5: accepted" in shown

    flown(script)


def test_a_refusal_is_shown_with_its_reason() -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("t")
        await drawn(app, pilot)
        assert "refused NOT_ARMED takeoff 1.5: the vehicle is not armed" in screen_text(app)

    flown(script)


def test_everything_that_matters_fits_a_small_terminal() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.pos = (1.0, 1.0, 0.0)
        station.fly(0.2)
        await pilot.press("right")
        await drawn(app, pilot)
        shown = screen_text(app)
        for needed in ("1/1 px4", "GROUNDED", "pending", "active", "98 %", "ABORT", "quit", "⌂"):
            assert needed in shown, needed

    flown(script, size=(80, 24))


def test_v_puts_the_pending_goal_where_the_vehicle_is() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.station.pos = (4.04, -2.0, 3.0)
        station.fly(0.1)
        await pilot.press("v")
        assert app.scene.pending.goal_enu == (4.0, -2.0, 3.0)

    flown(script)


@pytest.mark.parametrize("key", ["q", "ctrl+c"])
def test_leaving_says_so_waits_for_the_station_and_gives_its_result(key: str) -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press(key)
        assert isinstance(station.sent[-1], ipc.Leave)
        assert "Waiting until the vehicle is seen holding" in screen_text(app)
        await pilot.press(key)
        assert sum(isinstance(command, ipc.Leave) for command in station.sent) == 1
        station.say(StationEnded(ipc.Bye(0, "logs/x.mcap", "held"), 0, ""))
        await pilot.pause()
        assert not app.is_running

    app, _ = flown(script)
    told: list[str] = []
    assert print_result(app.result, told.append) == ExitCode.DONE
    assert told == ["gcs: held", "log: logs/x.mcap"]


def test_a_station_that_dies_is_shown_and_is_an_error() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        station.say(StationEnded(None, -9, "last words"))
        await drawn(app, pilot)
        assert "THE LINK PROCESS HAS ENDED (EXIT CODE -9)" in screen_text(app)
        assert "last words" in screen_text(app)
        assert "the vehicle was disarmed" in screen_text(app)
        await pilot.press("q")

    app, station = flown(script)
    assert not any(isinstance(command, ipc.Leave) for command in station.sent)
    with pytest.raises(ExitError, match=r"died .*; the vehicle was disarmed") as failed:
        print_result(app.result, lambda _: None)
    assert failed.value.exit_code == ExitCode.BUG


def test_a_port_in_use_is_told_before_the_screen_is_taken() -> None:
    client = FakeConnection(FakeStation("port in use"))
    with pytest.raises(ExitError, match="address in use") as failed:
        until_hello(client)
    assert failed.value.exit_code == ExitCode.ADDRESS_IN_USE
    assert client.closed


def test_what_the_station_said_before_the_screen_is_on_it() -> None:
    events = until_hello(FakeConnection())
    assert isinstance(events[0], ipc.Hello)

    async def run() -> FlyApp:
        app = FlyApp(ListeningStation(FakeStation("silent")), events)
        async with app.run_test() as pilot:
            await pilot.pause()
        return app

    assert asyncio.run(run()).scene.zones


def test_a_click_on_the_map_sets_the_pending_goal_there_at_its_height() -> None:
    async def script(app: FlyApp, station: ListeningStation, pilot: Pilot[None]) -> None:
        await drawn(app, pilot)
        await pilot.click("#map", offset=(50, 5))
        await pilot.pause()
        east_m, north_m, up_m = app.scene.pending.goal_enu
        assert east_m > 0.0
        assert north_m > 0.0
        assert up_m == 0.5
        assert station.sent == [ipc.Pending((east_m, north_m, up_m))]

    flown(script)


def test_the_map_is_panned_and_z_shows_all_again() -> None:
    async def script(app: FlyApp, _station: ListeningStation, pilot: Pilot[None]) -> None:
        await pilot.press("shift+right", "shift+up")
        assert app.scene.pan_en[0] > 0.0
        assert app.scene.pan_en[1] > 0.0
        await pilot.press("z")
        assert app.scene.pan_en == (0.0, 0.0)

    flown(script)


@pytest.mark.parametrize("size", [(80, 24), (120, 40), (200, 60)])
def test_a_terminal_that_knows_only_ascii_is_sent_nothing_else(size: tuple[int, int]) -> None:
    async def run() -> str:
        station = ListeningStation()
        app = FlyApp(station, ascii_only=True)
        async with app.run_test(size=size) as pilot:
            station.station.refusals[1.0, 0.0, 0.5] = ("POLICY", "far away " * 40)
            app.scene.ahead.outdate()
            await pilot.press("right")
            await pilot.pause(0.6)
            await drawn(app, pilot)
            assert "Enter: refused POLICY: far away" in screen_text(app)
            assert screen_text(app).isascii()
            await pilot.press("left")
            station.say(ipc.LogEvent(0, 2, "gate", "HOVERING → MOVING"))
            await pilot.press("right", "question_mark")
            await drawn(app, pilot)
            shown = screen_text(app)
            await pilot.press("escape")
            await drawn(app, pilot)
            return shown + screen_text(app)

    shown = asyncio.run(run())
    assert {sign for sign in shown if not sign.isascii()} == set()
    assert "pending E +1.00" in shown
    assert "HOVERING > MOVING" in shown
