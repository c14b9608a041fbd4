"""The library for asyncio: of the same shape, over a scripted station; what cancelling does."""

from __future__ import annotations

import ast
import asyncio
import inspect
import threading
from collections.abc import Awaitable, Callable

import pytest

import gcs
from gcs import ipc
from gcs.operator import async_station
from gcs.operator.async_proxy import in_thread
from gcs.operator.async_station import AsyncStation
from gcs.operator.operation import Operation
from gcs.operator.station import Station
from gcs.operator.stream import Stream
from tests.unit import async_stub
from tests.unit.operator.test_station import FakeWay, flying

PATIENT_S = 60.0

Flight = Callable[[AsyncStation, FakeWay], Awaitable[None]]


def run(flight: Flight) -> FakeWay:
    """Over a scripted station that hovers; returns what was sent to it."""
    station, way = flying()

    async def main() -> None:
        made = AsyncStation(station)  # type: ignore[call-arg]
        await asyncio.wait_for(flight(made, way), PATIENT_S)

    asyncio.run(main())
    return way


def test_the_stub_is_as_it_is_made() -> None:
    """`ruff format` is left out: `make quick` does it."""
    kept = ast.parse(async_stub.STUB.read_text(encoding="utf-8"))
    made = ast.parse(async_stub.text())
    assert [ast.unparse(each) for each in kept.body if not isinstance(each, ast.ImportFrom)] == [
        ast.unparse(each) for each in made.body if not isinstance(each, ast.ImportFrom)
    ]


@pytest.mark.parametrize("kind", [Operation, Stream, Station])
def test_every_public_member_is_there_with_its_text(kind: type) -> None:
    made = getattr(async_station, f"Async{kind.__name__}")
    for name, member in inspect.getmembers(kind):
        if not name.startswith("_") and name not in ("tell", "wait_until"):
            assert getattr(made, name).__doc__ == member.__doc__, name


def test_what_is_complete_returns_and_what_is_refused_raises() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        assert (await station.resume()).state == "complete"
        assert station.state == "HOVERING"
        with pytest.raises(gcs.Refused, match="OUTSIDE_FENCE"):
            await station.goto(500, 0, 2)
        with pytest.raises(gcs.BadArgument, match="yaw_deg must be from -360 to 360"):
            await station.goto(1, 0, 2, 999)
        goto = await station.goto(3, 0, 2, wait=False)
        assert isinstance(goto, gcs.AsyncOperation)
        way.tick(30)
        assert (await goto.wait()).state == "complete"

    run(flight)


def test_an_abort_ends_the_goto_that_another_task_awaits() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        way.was_sent.clear()
        goto = asyncio.create_task(station.goto(100, 0, 2))
        assert await asyncio.to_thread(way.was_sent.wait, PATIENT_S)
        assert (await station.abort()).state == "complete"
        with pytest.raises(gcs.NotCompleted, match="aborted OPERATOR"):
            await goto

    run(flight)


def test_cancelling_aborts_nothing() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        way.was_sent.clear()
        goto = asyncio.create_task(station.goto(3, 0, 2))
        assert await asyncio.to_thread(way.was_sent.wait, PATIENT_S)
        goto.cancel()
        with pytest.raises(asyncio.CancelledError):
            await goto
        assert station.state == "MOVING"
        way.tick(30)
        assert station.state == "HOVERING"

    way = run(flight)
    assert [sent.word for sent in way.sent if isinstance(sent, ipc.Ask)] == ["control", "goto"]


def test_an_event_that_comes_while_nobody_awaits_it_is_not_lost() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        events = station.events()
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(anext(events), 0.01)
        await station.resume()
        assert isinstance(await anext(events), ipc.VerdictEvent)
        assert isinstance(await anext(events), ipc.EndingEvent)
        await station.close()
        assert [type(event) async for event in events] == [ipc.Bye]

    run(flight)


def test_a_stream_is_an_async_with_block() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        async with station.stream() as stream:
            async for _ in stream.ticks(60.0):
                await stream.velocity(99.0, 0.0, 0.0)
                if stream.refusal is not None:
                    break

    way = run(flight)
    words = [sent.word for sent in way.sent if isinstance(sent, ipc.Ask)]
    assert words == ["control", "stream_begin", "stream_end"]


def test_leaving_the_block_leaves_the_station() -> None:
    async def flight(station: AsyncStation, way: FakeWay) -> None:
        async with station:
            pass

    assert run(flight).closed == 1


def test_what_comes_of_a_call_that_nobody_awaits_any_more_is_given_back() -> None:
    """As a station that is connected after `aconnect` was cancelled: it is left at once."""
    may_end, given_back = threading.Event(), threading.Event()
    came: list[int] = []

    def connect() -> int:
        assert may_end.wait(PATIENT_S)
        return 7

    def unwanted(result: int) -> None:
        came.append(result)
        given_back.set()

    async def main() -> None:
        task = asyncio.ensure_future(in_thread(connect, unwanted))
        await asyncio.sleep(0)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        may_end.set()
        assert await asyncio.to_thread(given_back.wait, PATIENT_S)

    asyncio.run(main())
    assert came == [7]
