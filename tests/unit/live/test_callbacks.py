"""What the server's library calls: nothing is decided there, and nothing large is kept."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from gcs.live.clicked_goals import MAX_MESSAGE_BYTES
from gcs.live.inbox import Inbox
from gcs.live.inputs import Gone, Published
from gcs.live.server import MAX_VIEWER_TOPICS, Callbacks

pytestmark = pytest.mark.slow  # a socket

POINT = "geometry_msgs/PointStamped"
CLIENT: Any = SimpleNamespace(id=3)


@pytest.fixture
def inbox() -> Iterator[Inbox]:
    made = Inbox()
    yield made
    made.close()


def topic(number: int, schema_name: str = POINT, encoding: str = "json") -> Any:
    """A topic of a viewer's, or of ours."""
    return SimpleNamespace(
        id=number, topic=f"/{number}", encoding=encoding, schema_name=schema_name
    )


def test_what_is_published_on_a_topic_of_goals_is_handed_on(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    callbacks.on_client_advertise(CLIENT, topic(1, encoding="ros1"))
    callbacks.on_message_data(CLIENT, 1, b"goal")
    assert inbox.take() == [Published(3, "ros1", POINT, b"goal")]


def test_of_what_is_too_large_to_be_a_goal_no_more_is_kept_than_shows_it(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    callbacks.on_client_advertise(CLIENT, topic(1))
    callbacks.on_message_data(CLIENT, 1, bytes(1 << 20))
    (kept,) = inbox.take()
    assert isinstance(kept, Published)
    assert len(kept.data) == MAX_MESSAGE_BYTES + 1


@pytest.mark.parametrize(
    "advertised",
    [
        topic(1, "sensor_msgs/Image"),
        topic(1, "x" * 1_000 + "/PointStamped"),
        topic(1, POINT, "j" * 200),
    ],
)
def test_other_topics_of_viewers_are_passed_over(inbox: Inbox, advertised: Any) -> None:
    callbacks = Callbacks(inbox)
    callbacks.on_client_advertise(CLIENT, advertised)
    callbacks.on_message_data(CLIENT, 1, b"{}")
    callbacks.on_message_data(CLIENT, 2, b"{}")
    assert inbox.take() == []


def test_one_viewer_has_so_many_topics_and_no_more(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    for number in range(1_000):
        callbacks.on_client_advertise(CLIENT, topic(number))
    callbacks.on_message_data(CLIENT, MAX_VIEWER_TOPICS - 1, b"{}")
    callbacks.on_message_data(CLIENT, MAX_VIEWER_TOPICS, b"{}")
    assert len(inbox.take()) == 1


def test_a_viewer_has_gone_with_the_last_of_its_subscriptions_and_topics(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    callbacks.on_subscribe(CLIENT, topic(10))
    callbacks.on_subscribe(CLIENT, topic(11))
    callbacks.on_client_advertise(CLIENT, topic(1))
    callbacks.on_unsubscribe(CLIENT, topic(10))
    callbacks.on_unsubscribe(CLIENT, topic(11))
    assert inbox.take() == []
    callbacks.on_client_unadvertise(CLIENT, 1)
    assert inbox.take() == [Gone(3)]
    callbacks.on_client_unadvertise(CLIENT, 1)
    assert inbox.take() == []


def test_only_a_trusted_viewer_sets_parameters(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    step: Any = SimpleNamespace(name="step_m", get_value=lambda: 2.5)
    (told,) = callbacks.on_set_parameters(CLIENT, [step])
    assert (told.name, told.get_value()) == ("step_m", 1.0)
    callbacks.trusted = frozenset({3})
    (told,) = callbacks.on_set_parameters(CLIENT, [step])
    assert told.get_value() == 2.5
    assert {each.name for each in callbacks.on_get_parameters(CLIENT, [])} == {
        "goal_height_m",
        "step_m",
    }


def test_topics_that_were_subscribed_to_are_told_once(inbox: Inbox) -> None:
    callbacks = Callbacks(inbox)
    callbacks.on_subscribe(CLIENT, topic(10))
    assert callbacks.take_subscribed() == {"/10"}
    assert callbacks.take_subscribed() == set()
