"""A live view flown from a page: Chromium, and the client of viewers, `@foxglove/ws-protocol`.

It speaks `foxglove.websocket.v1`.  That package comes from npm into `.clients/foxglove`.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from gcs.live.program import Opened, Wanted, opened_by
from tests.clients.client_script import CLIENTS
from tests.system.browser import Browser, Page, chromium, running
from tests.system.station import simulated

PROGRAM = chromium()
PACKAGE = CLIENTS / "foxglove"
PAGE = Path(__file__).with_name("foxglove_page.html")
pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(PROGRAM is None, reason="there is no Chromium on this machine"),
    pytest.mark.skipif(
        not (PACKAGE / "node_modules").exists(),
        reason="`make .clients/foxglove/.installed` gets the package from npm",
    ),
]
DECISIONS, STATE, FENCE = "/gate/decision", "/vehicle/1/state", "/gate/fence"


class Files(SimpleHTTPRequestHandler):
    """The page and the package; its modules name each other without `.js`."""

    def translate_path(self, path: str) -> str:
        if path == "/":
            return str(PAGE)
        found = super().translate_path(path)
        return found if Path(found).exists() else f"{found}.js"

    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def served() -> Iterator[int]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Files, directory=str(PACKAGE)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def opened_page(browser: Browser, url: str, name: str, live: Opened) -> Page:
    page = browser.page()
    page.go(url)
    page.evaluate(f"{name} = viewer({json.dumps(live.url)}), true")
    return page


def test_a_page_looks_takes_control_clicks_and_lands_and_a_foreign_page_does_nothing(
    tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))
    assert PROGRAM is not None
    with simulated(tmp_path) as operator, served() as port, running(PROGRAM) as browser:
        live = opened_by(Wanted(operator.client.pid, "127.0.0.1", 0))
        assert live is not None
        page = opened_page(browser, f"http://127.0.0.1:{port}/", "v", live)

        def told(script: str) -> Any:
            return page.evaluate(f"(async () => {{ {script} }})()")

        info = told("await v.until((v) => v.info); return v.info")
        assert info["metadata"]["ROS_DISTRO"]
        told(f"await v.subscribe({STATE!r}); await v.until((v) => v.heard[{STATE!r}])")
        refused = told("return v.call('takeoff', {up_m: 3})")
        assert refused["code"] == "OTHER_OPERATOR"
        assert "must be json" in told("return v.call('hold', {}, 'cdr')")["failed"]
        assert told(f"return v.call('take_control', {{code: {live.code!r}}})")["accepted"]
        assert told("return v.call('arm', {})")["accepted"]
        told(f"await v.until((v) => v.heard[{STATE!r}].at(-1).armed); v.subscribe({DECISIONS!r})")
        ended = f"""async (word, outcome) => v.until((v) => (v.heard[{DECISIONS!r}] ?? [])
            .find((d) => d.word === word && d.outcome === outcome))"""
        told(f"await v.call('takeoff', {{up_m: 3}}); await ({ended})('takeoff', 'complete')")

        told(f"v.click(4, 2); await ({ended})('goto', 'complete')")
        here = told(f"return v.heard[{STATE!r}].at(-1)")
        assert here["east_m"] == pytest.approx(4.0, abs=0.7)
        assert here["north_m"] == pytest.approx(2.0, abs=0.7)
        told("v.click(1, 0, 'base_link')")
        told("await v.until((v) => v.statuses.some((s) => s.includes(\"frame 'map'\")))")
        told("v.click(900, 0)")
        told("await v.until((v) => v.statuses.some((s) => s.includes('refused OUTSIDE_FENCE')))")

        told("v.client.setParameters([{name: 'step_m', value: 2}], 'set')")
        told("await v.until((v) => v.parameters.step_m === 2)")
        told("v.client.subscribeConnectionGraph()")
        told("await v.until((v) => v.graph.some((t) => t.name === 'vehicle 1/1/HEARTBEAT'))")

        late = opened_page(browser, f"http://127.0.0.1:{port}/", "v", live)
        for topic in (FENCE, DECISIONS, "/log", "/vehicle/1/path"):
            late.evaluate(f"v.subscribe({topic!r})")
        late.evaluate(f"v.until((v) => v.heard[{FENCE!r}] && v.heard['/vehicle/1/path'])")
        late.evaluate(f"v.until((v) => v.heard[{DECISIONS!r}]?.length >= 4 && v.heard['/log'])")

        foreign = opened_page(browser, f"http://evil.localhost:{port}/", "v", live)
        foreign.evaluate("v.until((v) => v.ended)")
        assert foreign.evaluate("v.info") is None
        told("await v.until((v) => v.statuses.some((s) => s.includes('evil.localhost')))")

        told(f"await v.call('land', {{}}); await ({ended})('land', 'complete')")
        latencies = sorted(told("return v.latencies"))
        share = {p: latencies[len(latencies) * p // 100] for p in (50, 95)}
        print(f"\nlatency in the page: p50 {share[50]:.1f} ms, p95 {share[95]:.1f} ms")
        operator.leave()
