"""A class whose methods wait, as one of the same shape whose methods are awaited.

Each call that may wait runs in a thread of its own, so that an abort never waits for a free one.
"""

from __future__ import annotations

import asyncio
import functools
import threading
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from enum import Enum
from types import FunctionType, TracebackType
from typing import Final, Generic, TypeVar

T = TypeVar("T")

NOT_AWAITED: Final = frozenset({"tell", "wait_until"})
"""Methods that are there for streams and operations, not for programs."""


class Kind(Enum):
    """What a member becomes."""

    PROPERTY = "a property"
    AT_ONCE = "a method that is not awaited: it returns a stream, or an iterator"
    AWAITED = "a coroutine"


def members_of(kind: type) -> Iterator[tuple[str, Kind, FunctionType]]:
    """The public members of a class and of what it inherits from, by name, once each."""
    for name in dict.fromkeys(name for each in kind.__mro__ for name in vars(each)):
        member = getattr(kind, name)
        if name.startswith("_") or name in NOT_AWAITED:
            continue
        if isinstance(member, property) and isinstance(member.fget, FunctionType):
            yield name, Kind.PROPERTY, member.fget
        elif isinstance(member, FunctionType):
            returned = str(member.__annotations__.get("return"))
            at_once = returned == "Stream" or returned.startswith("Iterator")
            yield name, Kind.AT_ONCE if at_once else Kind.AWAITED, member


async def in_thread(call: Callable[[], T], unwanted: Callable[[T], object] = lambda _: None) -> T:
    """What `call` returns or raises.  Cancelling stops the waiting and not the call; `unwanted` is
    given what comes of it then."""
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[T] = loop.create_future()

    def fail(error: BaseException) -> None:
        if not ended.done():
            ended.set_exception(error)

    def succeed(result: T) -> None:
        if ended.done():
            threading.Thread(target=unwanted, args=(result,)).start()
        else:
            ended.set_result(result)

    def run() -> None:
        try:
            result = call()
        except BaseException as error:  # noqa: BLE001  raised again where it is awaited
            _in_loop(loop, fail, error)
        else:
            if not _in_loop(loop, succeed, result):
                unwanted(result)

    threading.Thread(target=run, daemon=True).start()
    return await ended


def _in_loop(loop: asyncio.AbstractEventLoop, settle: Callable[[T], None], with_: T) -> bool:
    """False if the loop has ended meanwhile."""
    try:
        loop.call_soon_threadsafe(settle, with_)
    except RuntimeError:
        return False
    return True


class AsyncIterated(AsyncIterator[T]):
    """An iterator that waits; what comes while nobody awaits it is not lost."""

    def __init__(self, iterator: Iterator[T]) -> None:
        self._iterator = iterator
        self._coming: asyncio.Task[list[T]] | None = None

    async def __anext__(self) -> T:
        if self._coming is None:
            self._coming = asyncio.ensure_future(in_thread(self._next))
        came = await asyncio.shield(self._coming)
        self._coming = None
        if not came:
            raise StopAsyncIteration
        return came[0]

    def _next(self) -> list[T]:
        """One, or none at the end."""
        return [each for _, each in zip((0,), self._iterator, strict=False)]


class Proxy(Generic[T]):
    """Around one object of the class that waits; what it returns is wrapped as well."""

    OF: Mapping[type, type[Proxy[object]]] = {}
    """What is wrapped, and as what."""

    def __init__(self, wrapped: T) -> None:
        self._wrapped = wrapped

    def __repr__(self) -> str:
        return repr(self._wrapped)


def wrapped(result: object) -> object:
    """What a program is given of it."""
    if isinstance(result, Iterator):
        return AsyncIterated(result)
    kind = Proxy.OF.get(type(result))
    return result if kind is None else kind(result)


def asynchronous(kind: type, name: str, doc: str) -> type[Proxy[object]]:
    """A class `name` of the same shape as `kind`."""
    made: dict[str, object] = {"__doc__": doc, "__module__": "gcs.operator.async_station"}
    for member, shape, function in members_of(kind):
        made[member] = _member(function, shape)
    if hasattr(kind, "__enter__"):
        made["__aenter__"], made["__aexit__"] = _enter, _leave
    proxy = type(name, (Proxy,), made)
    Proxy.OF = {**Proxy.OF, kind: proxy}
    return proxy


def _member(function: FunctionType, shape: Kind) -> object:
    if shape is Kind.AWAITED:

        @functools.wraps(function)
        async def awaited(self: Proxy[object], *args: object, **named: object) -> object:
            call = functools.partial(function, self._wrapped, *args, **named)
            return wrapped(await in_thread(call))

        return awaited

    @functools.wraps(function)
    def at_once(self: Proxy[object], *args: object, **named: object) -> object:
        return wrapped(function(self._wrapped, *args, **named))

    return property(at_once) if shape is Kind.PROPERTY else at_once


async def _enter(self: Proxy[object]) -> object:
    await in_thread(self._wrapped.__enter__)  # type: ignore[attr-defined]
    return self


async def _leave(
    self: Proxy[object],
    kind: type[BaseException] | None,
    error: BaseException | None,
    trace: TracebackType | None,
) -> None:
    await in_thread(lambda: self._wrapped.__exit__(kind, error, trace))  # type: ignore[attr-defined]
