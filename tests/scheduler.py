"""Gives each worker of a run (`-n`) the tests that are next, of those that it collected.

In place of xdist's own schedulers, which want that all workers collected the same, and search
through all tests for each that ends.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NoReturn, Protocol

from tests.lanes import share

AHEAD = 2
"""A worker begins a test when it knows the one after it, or that there is none."""


class Worker(Protocol):
    """As much of xdist's `WorkerController` as is used."""

    @property
    def shutting_down(self) -> bool: ...
    def send_runtest_some(self, indices: Sequence[int]) -> None: ...
    def shutdown(self) -> None: ...


class Scheduler:
    """What xdist asks of one (`xdist.scheduler.protocol`).  A worker begins when it has collected,
    whether or not the others have."""

    def __init__(self, workers: int, all_collected: Callable[[int], None]) -> None:
        """`all_collected` is told how many tests there are."""
        self._workers = workers
        self._all_collected = all_collected
        self._collected: dict[Worker, list[str]] = {}
        self._places: dict[Worker, dict[str, int]] = {}
        self._known: set[str] = set()
        self._left: dict[str, list[str]] = {}
        """By share, in the order in which they are given out."""
        self._given: dict[Worker, dict[str, None]] = {}
        """What each has not ended yet, in its order."""

    @property
    def nodes(self) -> list[Worker]:
        return list(self._given)

    @property
    def collection_is_completed(self) -> bool:
        return len(self._collected) >= self._workers

    @property
    def tests_finished(self) -> bool:
        few = all(len(tests) < AHEAD for tests in self._given.values())
        return self.collection_is_completed and not self._left and few

    @property
    def has_pending(self) -> bool:
        return bool(self._left) or any(self._given.values())

    def add_node(self, node: Worker) -> None:
        self._given[node] = {}

    def add_node_collection(self, node: Worker, collection: Sequence[str]) -> None:
        self._collected[node] = list(collection)
        self._places[node] = {nodeid: place for place, nodeid in enumerate(collection)}
        new = [nodeid for nodeid in collection if nodeid not in self._known]
        self._known.update(new)
        self._leave(new)
        self._give(node)

    def schedule(self) -> None:
        self._all_collected(len(self._known))

    def mark_test_complete(self, node: Worker, item_index: int, duration: float = 0) -> None:
        del self._given[node][self._collected[node][item_index]]
        self._give(node)

    def remove_node(self, node: Worker) -> str | None:
        """One that has ended, or died: the test in which it died, which no other does again."""
        given = list(self._given.pop(node))
        self._leave(given[1:])
        for other in self.nodes:
            self._give(other)
        return given[0] if given else None

    def mark_test_pending(self, item: str) -> NoReturn:
        raise NotImplementedError

    def remove_pending_tests_from_node(self, node: Worker, indices: Sequence[int]) -> NoReturn:
        raise NotImplementedError

    def _leave(self, tests: Sequence[str]) -> None:
        for nodeid in tests:
            self._left.setdefault(share(nodeid), []).append(nodeid)

    def _give(self, node: Worker) -> None:
        """Shares until it has enough to go on with, and its end when none is left for it."""
        places = self._places.get(node)
        while places is not None and not node.shutting_down and len(self._given[node]) <= AHEAD:
            own = next((name for name, tests in self._left.items() if tests[0] in places), None)
            if own is None:
                node.shutdown()
                return
            tests = self._left.pop(own)
            self._given[node] |= dict.fromkeys(tests)
            node.send_runtest_some([places[nodeid] for nodeid in tests])
