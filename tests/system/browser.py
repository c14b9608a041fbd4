"""A headless Chromium, spoken to over two pipes by the Chrome DevTools Protocol.

https://chromedevtools.github.io/devtools-protocol/: with `--remote-debugging-pipe` the browser
reads JSON messages from descriptor 3 and writes them to descriptor 4, each ended by a NUL.
"""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
TIMEOUT_S = 60.0
_FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)


def chromium() -> str | None:
    """The program, None where there is none."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


@dataclass(slots=True)
class Page:
    """One tab.  `console` and `requests` are what happened since it was opened."""

    browser: Browser
    session: str
    console: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        return self.browser.call(method, self.session, **params)

    def open(self, path: Path) -> None:
        self.go(path.as_uri())

    def go(self, url: str) -> None:
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Page.navigate", url=url)
        self.browser.wait_for("Page.loadEventFired", self)

    def evaluate(self, script: str) -> Any:
        """The value of an expression in the page.  Raises AssertionError where it throws."""
        answer = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def size(self, width: int, height: int, *, phone: bool = False) -> None:
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=phone,
        )

    def scheme(self, name: str) -> None:
        """`light` or `dark`, as the reader's system prefers it."""
        feature = {"name": "prefers-color-scheme", "value": name}
        self.call("Emulation.setEmulatedMedia", features=[feature])

    def told(self, event: Mapping[str, Any]) -> None:
        params = event["params"]
        match event["method"]:
            case "Runtime.consoleAPICalled":
                self.console.append(str(params["args"]))
            case "Runtime.exceptionThrown":
                self.console.append(str(params["exceptionDetails"]))
            case "Log.entryAdded":
                self.console.append(str(params["entry"]["text"]))
            case "Network.requestWillBeSent":
                self.requests.append(str(params["request"]["url"]))
            case _:
                pass


class Browser:
    """Use `running`."""

    def __init__(self, read_fd: int, write_fd: int) -> None:
        self._read_fd, self._write_fd = read_fd, write_fd
        self._received = b""
        self._number = 0
        self._pages: dict[str, Page] = {}

    def page(self) -> Page:
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        page = Page(self, attached["sessionId"])
        self._pages[page.session] = page
        return page

    def call(self, method: str, session: str = "", **params: Any) -> dict[str, Any]:
        self._number += 1
        message = {"id": self._number, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        os.write(self._write_fd, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                result: dict[str, Any] = answer["result"]
                return result

    def wait_for(self, method: str, page: Page) -> None:
        while True:
            event = self._next()
            if event.get("method") == method and event.get("sessionId") == page.session:
                return

    def _next(self) -> dict[str, Any]:
        """The next message; what a page has to hear of is told to it."""
        deadline = time.monotonic() + TIMEOUT_S
        while b"\0" not in self._received:
            left_s = deadline - time.monotonic()
            ready, _, _ = select.select([self._read_fd], [], [], max(0.0, left_s))
            assert ready, "the browser does not answer"
            more = os.read(self._read_fd, 1 << 16)
            assert more, "the browser has ended"
            self._received += more
        line, _, self._received = self._received.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        page = self._pages.get(message.get("sessionId", ""))
        if page is not None and "method" in message:
            page.told(message)
        return message


@contextmanager
def running(program: str) -> Iterator[Browser]:
    """A browser that ends with the block, with a profile of its own."""
    its_input, our_output = os.pipe()
    our_input, its_output = os.pipe()

    # Made by the shell, since the descriptors have to be 3 and 4.
    wrapped = f'exec "$@" 3<&{its_input} 4>&{its_output}'
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [
                *("bash", "-c", wrapped, "browser", program, *_FLAGS),
                *("--remote-debugging-pipe", f"--user-data-dir={profile}"),
            ],
            pass_fds=(its_input, its_output),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(its_input)
        os.close(its_output)
        try:
            yield Browser(our_input, our_output)
        finally:
            os.close(our_output)
            os.close(our_input)
            process.terminate()
            process.wait(timeout=TIMEOUT_S)
