"""A campaign on Dask: whoever flies it, and whoever dies meanwhile, the rows are the same."""

from __future__ import annotations

import os
import signal
import time
from functools import partial
from pathlib import Path

import pytest
from distributed import Client

from gcs.campaign import engine
from gcs.campaign.campaign import Campaign
from gcs.campaign.case import LANDED
from gcs.campaign.flight import fly
from gcs.campaign.plan import Plan
from gcs.campaign.sampling import places_of
from gcs.campaign.spec import read_plan
from gcs.campaign.store import Store, rows_digest

TEXT = """\
name = "short flights"
sample = "latin"
flights = 8
timeout_s = 60
[[task]]
name = "up"
lines = ["arm", "takeoff 2", "land"]
[vary]
wind_m_s = { from = 0, to = 6 }
autopilot = ["px4", "ardupilot"]
"""


def flown(plan: Plan, folder: Path, client: Client, kill: int) -> Campaign:
    """`kill` is the process of a worker that dies once two flights have ended; 0: none does."""

    def tell(done: int) -> None:
        if done == 2 and kill:
            os.kill(kill, signal.SIGKILL)

    store = Store(folder)
    store.begin(plan)
    return Campaign(plan, store, partial(engine.flown, client, plan), time.monotonic, tell)


@pytest.mark.thorough
def test_a_worker_that_dies_changes_no_row(tmp_path: Path) -> None:
    file = tmp_path / "campaign.toml"
    file.write_text(TEXT, encoding="utf-8")
    plan = read_plan(file)
    places = places_of(plan)
    alone = [fly(plan.case(n, plan.inputs(places(n)))) for n in range(plan.flights)]
    assert {row.outcome for row in alone} == {LANDED}
    with engine.workers(2, "") as client:
        processes = list(client.run(os.getpid).values())
        campaign = flown(plan, tmp_path / "two", client, processes[0])
        rows = campaign.run()
        assert campaign.keep(rows[:1]) == []
    assert rows_digest(rows) == rows_digest(alone)
    assert campaign.store.record(0).stat().st_size > 100_000
    assert Store(tmp_path / "two").rows() == alone


@pytest.mark.thorough
def test_a_scheduler_that_is_not_there_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "CONNECT_WAIT_S", 0.2)
    with pytest.raises(engine.NoWorkersError), engine.workers(1, "tcp://127.0.0.1:9"):
        pass
