"""Who of the workers is given which tests, and when each ends."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.lanes import COMPUTING, WAITERS, WAITING, looks_into, part, waits
from tests.scheduler import Scheduler


class Played:
    """A worker: it runs a test only when it knows the next, or that there is none."""

    def __init__(self, scheduler: Scheduler, *collects: str) -> None:
        self.scheduler, self.collects = scheduler, collects
        self.waiting: list[int] = []
        self.ran: list[str] = []
        self.shutting_down = False
        scheduler.add_node(self)

    def send_runtest_some(self, indices: Sequence[int]) -> None:
        self.waiting += indices

    def shutdown(self) -> None:
        self.shutting_down = True

    def collected(self) -> None:
        self.scheduler.add_node_collection(self, self.collects)

    def step(self) -> bool:
        if len(self.waiting) < 1 + (not self.shutting_down):
            return False
        place = self.waiting.pop(0)
        self.ran.append(self.collects[place])
        self.scheduler.mark_test_complete(self, place)
        return True


def run(*workers: Played) -> None:
    while sum(worker.step() for worker in workers):
        pass


def names_in(file: str, count: int) -> list[str]:
    return [f"tests/unit/{file}.py::test_{number}" for number in range(count)]


def test_all_is_run_once_by_workers_that_collected_the_same() -> None:
    counts: list[int] = []
    scheduler = Scheduler(2, counts.append)
    files = [*names_in("a", 1), *names_in("b", 5), *names_in("c", 2), *names_in("d", 1)]
    workers = [Played(scheduler, *files) for _ in range(2)]
    for worker in workers:
        worker.collected()
    scheduler.schedule()
    run(*workers)
    assert sorted(workers[0].ran + workers[1].ran) == sorted(files)
    assert counts == [len(files)]
    assert all(worker.ran and worker.shutting_down for worker in workers)
    assert scheduler.tests_finished
    assert not scheduler.has_pending


def test_a_file_is_run_by_one_worker() -> None:
    scheduler = Scheduler(2, lambda _count: None)
    files = [*names_in("a", 9), *names_in("b", 9)]
    one, other = Played(scheduler, *files), Played(scheduler, *files)
    one.collected()
    other.collected()
    run(one, other)
    assert (one.ran, other.ran) == (files[:9], files[9:])


def test_each_is_given_only_what_it_collected_and_begins_before_others_have() -> None:
    scheduler = Scheduler(2, lambda _count: None)
    quick, late = Played(scheduler, *names_in("a", 3)), Played(scheduler, *names_in("b", 1))
    quick.collected()
    run(quick)
    assert quick.ran == names_in("a", 3)
    assert not scheduler.tests_finished
    late.collected()
    run(late)
    assert late.ran == names_in("b", 1)
    assert scheduler.tests_finished


def test_a_worker_with_nothing_to_do_ends_and_the_others_go_on() -> None:
    scheduler = Scheduler(2, lambda _count: None)
    idle, busy = Played(scheduler), Played(scheduler, *names_in("a", 3))
    busy.collected()
    idle.collected()
    assert idle.shutting_down
    run(idle, busy)
    assert busy.ran == names_in("a", 3)


def test_what_one_that_died_had_is_done_by_who_comes_in_its_place() -> None:
    scheduler = Scheduler(2, lambda _count: None)
    mine, others = names_in("a", 4), names_in("b", 2)
    dies, lives = Played(scheduler, *mine), Played(scheduler, *others)
    dies.collected()
    lives.collected()
    assert dies.step()
    assert scheduler.remove_node(dies) == mine[1]
    run(lives)
    assert not scheduler.tests_finished
    stand_in = Played(scheduler, *mine, *others)
    stand_in.collected()
    run(stand_in, lives)
    assert stand_in.ran == mine[2:]
    assert lives.ran == others
    assert scheduler.tests_finished


@pytest.mark.parametrize("count", [WAITERS + 2, WAITERS + 5])
@pytest.mark.parametrize(
    "path",
    [
        *(f"tests/system/test_{letter}.py" for letter in "akz"),
        "tests/clients/test_bridge_peers.py",
        "tests/clients/test_mavsdk.py",
        "tests/unit/test_lanes.py",
        "tests/loopback/test_demo.py",
    ],
)
def test_every_file_is_collected_by_those_that_wait_or_by_those_that_compute(
    path: str, count: int
) -> None:
    parts = [part(f"gw{number}", count) for number in range(count)]
    assert None not in parts
    folders = [f"{path[: path.index(name)]}{name}/" for name in path.split("/")[:-1]]
    finders = {
        own for own in parts if own and all(looks_into(where, own) for where in [*folders, path])
    }
    assert finders == {WAITING if waits(path) else COMPUTING}


def test_fewer_workers_and_one_in_the_place_of_another_collect_all() -> None:
    assert {part(f"gw{number}", 5) for number in range(5)} == {None}
    assert part("gw6", 6) is None
