"""Who may ask for what, over which connection, and what becomes of the answers."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc
from gcs.live.effects import Close, Effect, Join, Notice, Reply, Send, Values
from gcs.live.inputs import (
    Call,
    Called,
    Ended,
    Gone,
    Input,
    ParametersAsked,
    Published,
    Tick,
    Told,
)
from gcs.live.services import SERVICES, Answer
from gcs.live.viewers import (
    BURST_CALLS,
    CALL_WAIT_NS,
    LOOKING,
    MAX_TRUSTED,
    MAX_WAITING,
    NEEDS_CONTROL,
    TOO_MANY_CODES,
    Viewers,
)

CODE = "abcd1234"
SECOND_NS = 1_000_000_000
REQUESTS = {
    "takeoff": {"up_m": 2.0},
    "goto": {"east_m": 1.0, "north_m": 2.0, "up_m": 3.0},
    "step": {"direction": "up"},
    "take_control": {"code": CODE},
}
HERE = ipc.Snapshot(
    0, "HOVERING", "OURS", "NOMINAL", [], 0.0, "", True, 0.0, pos_enu=(0.0, 0.0, 3.0)
)
CLICK = b'{"header":{"frame_id":"map"},"point":{"x":4.0,"y":5.0,"z":0.0}}'


class Script:
    """Viewers on a clock of the test's own."""

    def __init__(self) -> None:
        self.now_ns = 100 * SECOND_NS
        self.viewers = Viewers(CODE, self.now_ns)
        self.calls = 0
        self.feed(Told(LOOKING, HERE))

    def feed(self, given: Input) -> list[Effect]:
        return self.viewers.handle(given, self.now_ns)

    def call(self, viewer: int, service: str, **request: object) -> list[Effect]:
        self.calls += 1
        self.now_ns += SECOND_NS
        payload = json.dumps(request or REQUESTS.get(service, {})).encode()
        return self.feed(Called(call(viewer, self.calls), service, payload))

    def set(self, viewer: int, **values: object) -> list[Effect]:
        return self.feed(ParametersAsked(viewer, tuple(values), "set", values))

    def click(self, viewer: int, data: bytes = CLICK) -> list[Effect]:
        self.now_ns += SECOND_NS
        return self.feed(Published(viewer, "json", "geometry_msgs/PointStamped", data))

    def trusted(self, viewer: int) -> Script:
        """It has brought the code, and the station has said yes."""
        join, send = self.call(viewer, "take_control")
        assert join == Join(viewer)
        assert send == Send(viewer, ipc.Ask(1, "station_take"))
        self.feed(Told(viewer, ipc.VerdictEvent(1, "station_take", "accepted", operation=9)))
        return self


def call(viewer: int, number: int) -> Call:
    return Call(viewer, 1, number)


def answer(effects: list[Effect]) -> Answer:
    (reply,) = effects
    assert isinstance(reply, Reply)
    return reply.answer


# ------------------------------------------------------------------------- without the code


@pytest.mark.parametrize("service", ["abort", "hold"])
def test_who_looks_may_stop_over_the_connection_of_all_who_look(service: str) -> None:
    script = Script()
    assert script.call(7, service) == [Send(LOOKING, ipc.Ask(1, service))]
    verdict = ipc.VerdictEvent(1, service, "accepted", operation=4)
    assert script.feed(Told(LOOKING, verdict)) == [
        Reply(call(7, 1), Answer(True, "accepted", "", 4))
    ]


@pytest.mark.parametrize("service", ["arm", "takeoff", "goto", "step", "resume", "land", "rtl"])
def test_who_looks_moves_nothing(service: str) -> None:
    told = answer(Script().call(7, service))
    assert told == Answer(False, NEEDS_CONTROL, "OTHER_OPERATOR")


def test_a_click_of_who_looks_is_answered_with_a_sentence_to_it_a_few_times() -> None:
    script = Script()
    assert script.click(7) == [Notice(7, NEEDS_CONTROL, warning=True)]
    at_once = [script.feed(Published(7, "json", "PointStamped", CLICK)) for _ in range(99)]
    assert sum(map(len, at_once)) <= BURST_CALLS
    assert script.click(8) == [Notice(8, NEEDS_CONTROL, warning=True)]


@pytest.mark.slow
@given(st.lists(st.tuples(st.integers(1, 3), st.sampled_from([*SERVICES]), st.text(max_size=9))))
def test_without_the_code_only_stops_leave(calls: list[tuple[int, str, str]]) -> None:
    script = Script()
    for viewer, service, code in calls:
        if service == "take_control":
            effects = script.call(viewer, service, code=code)
        else:
            effects = script.call(viewer, service)
        for effect in effects + script.click(viewer):
            assert not isinstance(effect, Join)
            if isinstance(effect, Send):
                assert effect.viewer == LOOKING
                assert isinstance(effect.command, ipc.Ask)
                assert effect.command.word in {"abort", "hold"}
    assert script.viewers.trusted == frozenset()


# ---------------------------------------------------------------------------- with the code


@pytest.mark.parametrize("code", ["", "abcd123", "abcd12345", "ABCD1234", "abcd1235", "\u00e4"])
def test_another_code_is_refused(code: str) -> None:
    told = answer(Script().call(7, "take_control", code=code))
    assert (told.accepted, told.code) == (False, "OTHER_OPERATOR")
    assert "code" in told.sentence


def test_of_wrong_codes_a_few_are_looked_at_and_the_right_one_later() -> None:
    """Whoever connects anew for each try has no more of them."""
    script = Script()
    payloads = [json.dumps({"code": f"{n}"}).encode() for n in range(9)]
    tries = [
        script.feed(Called(call(10 + n, n), "take_control", p)) for n, p in enumerate(payloads)
    ]
    told = [effects[0].answer.sentence for effects in tries if isinstance(effects[0], Reply)]
    assert [text == TOO_MANY_CODES for text in told] == [False] * 5 + [True] * 4
    assert [effect for effects in tries for effect in effects[1:]] == [
        Notice(None, TOO_MANY_CODES, warning=True)
    ]
    right = json.dumps({"code": CODE}).encode()
    assert Join(7) not in script.feed(Called(call(7, 20), "take_control", right))
    script.now_ns += 5 * SECOND_NS
    assert script.call(8, "take_control", code=CODE)[0] == Join(8)


def test_the_code_gives_a_connection_of_its_own_over_which_it_flies() -> None:
    script = Script().trusted(7)
    assert script.viewers.trusted == {7}
    assert script.call(7, "arm") == [Send(7, ipc.Ask(2, "arm"))]
    assert script.call(7, "abort") == [Send(7, ipc.Ask(3, "abort"))]
    assert answer(script.call(8, "arm")).code == "OTHER_OPERATOR"


def test_control_that_another_operator_took_is_taken_again_without_the_code() -> None:
    script = Script().trusted(7)
    assert script.call(7, "take_control", code="") == [Send(7, ipc.Ask(2, "station_take"))]


def test_so_many_viewers_are_trusted_and_no_more() -> None:
    script = Script()
    for viewer in range(1, MAX_TRUSTED + 1):
        script.trusted(viewer)
    assert not answer(script.call(99, "take_control", code=CODE)).accepted
    script.feed(Gone(1))
    assert script.call(99, "take_control", code=CODE)[0] == Join(99)


def test_a_click_is_a_goal_at_the_height_that_the_vehicle_has() -> None:
    script = Script().trusted(7)
    ask = ipc.Ask(2, "goto", goal_enu=(4.0, 5.0, 3.0))
    assert script.click(7) == [Send(7, ask)]
    told = ipc.VerdictEvent(2, "goto", "refused", "OUTSIDE_FENCE", "goal is outside")
    sentence = "goto 4 5 3: refused OUTSIDE_FENCE: goal is outside"
    assert script.feed(Told(7, told)) == [Notice(7, sentence, warning=True)]


def test_the_ending_of_a_clicked_goal_is_told() -> None:
    script = Script().trusted(7)
    script.click(7)
    accepted = ipc.VerdictEvent(2, "goto", "accepted", operation=5)
    assert script.feed(Told(7, accepted)) == [Notice(7, "goto 4 5 3: accepted", warning=False)]
    complete = ipc.EndingEvent(2, "goto", "complete")
    assert script.feed(Told(7, complete)) == [Notice(7, "goto 4 5 3: complete", warning=False)]
    assert script.feed(Told(7, complete)) == []


def test_the_parameter_s_height_is_that_of_a_click() -> None:
    script = Script().trusted(7)
    script.set(7, goal_height_m=8.0)
    assert script.click(7) == [Send(7, ipc.Ask(2, "goto", goal_enu=(4.0, 5.0, 8.0)))]


def test_a_click_that_is_no_goal_is_told() -> None:
    script = Script().trusted(7)
    (notice,) = script.click(7, b"{}")
    assert isinstance(notice, Notice)
    assert "neither a point nor a pose" in notice.text


def test_a_refusal_comes_with_its_numbers() -> None:
    script = Script().trusted(7)
    script.call(7, "goto")
    told = ipc.VerdictEvent(
        2, "goto", "refused", "OUTSIDE_FENCE", "it is outside", numbers={"distance_m": 3.0}
    )
    reply = Reply(
        call(7, 2), Answer(False, "it is outside", "OUTSIDE_FENCE", 0, {"distance_m": 3.0})
    )
    assert script.feed(Told(7, told)) == [reply]


def test_parameters_are_set_by_the_trusted_alone_and_told_to_all_who_want_to_know() -> None:
    script = Script()
    looks = Notice(7, NEEDS_CONTROL, warning=True)
    assert script.set(7, step_m=2.5) == [Values(7, {"step_m": 1.0}, "set"), looks]
    script.trusted(7)
    changed = {"goal_height_m": 0.0, "step_m": 2.5}
    assert script.set(7, step_m=2.5) == [Values(7, {"step_m": 2.5}, "set"), Values(None, changed)]
    why = Notice(7, "step_m is a number from 0.01 to 100; it stays 2.5", warning=True)
    assert script.set(7, step_m=-4.0) == [Values(7, {"step_m": 2.5}, "set"), why]
    assert script.feed(ParametersAsked(8, (), None)) == [Values(8, changed)]


# ----------------------------------------------------------------------------- going, limits


def test_when_a_trusted_viewer_goes_its_connection_ends_and_its_number_is_worth_nothing() -> None:
    script = Script().trusted(7)
    assert script.feed(Gone(7)) == [Close(7)]
    assert script.viewers.trusted == frozenset()
    assert answer(script.call(7, "arm")).code == "OTHER_OPERATOR"
    assert script.feed(Gone(7)) == []
    assert script.feed(Gone(8)) == []


def test_when_the_station_ends_the_connection_waiting_calls_are_answered() -> None:
    script = Script().trusted(7)
    script.call(7, "arm")
    told = answer(script.feed(Ended(7)))
    assert (told.accepted, told.code) == (False, "OPERATOR_LOST")
    assert script.viewers.trusted == frozenset()


def test_a_call_that_the_station_does_not_answer_is_answered_in_time() -> None:
    script = Script()
    script.call(7, "hold")
    assert script.feed(Tick()) == []
    script.now_ns += CALL_WAIT_NS
    assert answer(script.feed(Tick())).code == "NO_ANSWER"
    assert script.feed(Tick()) == []
    assert script.feed(Told(LOOKING, ipc.VerdictEvent(1, "hold", "accepted"))) == []


def test_one_viewer_that_calls_too_often_does_not_keep_another_from_stopping() -> None:
    script = Script()
    sent = 0
    for number in range(200):
        effects = script.feed(Called(call(1, number), "hold", b""))
        sent += isinstance(effects[0], Send)
    assert sent <= BURST_CALLS
    script.feed(Tick())
    for number in range(1, sent + 1):
        script.feed(Told(LOOKING, ipc.VerdictEvent(number, "hold", "accepted")))
    (effect,) = script.feed(Called(call(2, 999), "abort", b""))
    assert isinstance(effect, Send)


def test_a_crowd_of_new_viewers_stays_under_what_the_station_takes_of_one_program() -> None:
    """50 lines a second, 100 at once (`operator_sockets`)."""
    script = Script()
    sent = 0
    for tenth in range(100):  # ten seconds
        script.now_ns += SECOND_NS // 10
        for number in range(100):
            (effect,) = script.feed(Called(call(1 + tenth * 100 + number, 1), "hold", b""))
            if isinstance(effect, Send):
                sent += 1
                script.feed(Told(LOOKING, ipc.VerdictEvent(sent, "hold", "accepted")))
    assert 100 <= sent <= 10 * 20 + 30


def test_so_many_calls_wait_and_no_more() -> None:
    script = Script()
    for viewer in range(MAX_WAITING):
        assert isinstance(script.call(viewer + 1, "hold")[0], Send)
    assert answer(script.call(50, "hold")).code == "BUSY"


def test_a_bad_request_is_refused() -> None:
    script = Script().trusted(7)
    assert answer(script.call(7, "goto", east_m="far")).code == "BAD_REQUEST"
