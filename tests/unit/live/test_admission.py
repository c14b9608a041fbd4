"""Which pages and names are let in (RFC 6454: a page's Origin; RFC 9110, 7.2: Host)."""

from __future__ import annotations

from gcs.live.admission import Admission
from tests.each import each

HOST = "127.0.0.1:8765"
ALLOWED = frozenset({"https://viewer.example", "station.lan"})


@each(
    "origin",
    [
        None,  # a program
        "https://app.foxglove.dev",
        "file://",  # a desktop viewer
        "http://localhost:8080",
        "http://127.0.0.1:8080",
        "http://[::1]:8080",
        "https://viewer.example",
    ],
)
def test_these_pages_are_let_in(origin: str | None) -> None:
    assert Admission("127.0.0.1", ALLOWED).why_refused(origin, HOST) == ""


@each(
    "origin",
    [
        "https://evil.example",
        "https://app.foxglove.dev.evil.example",
        "http://app.foxglove.dev",
        "http://localhost.evil.example",
        "http://localhost@evil.example",
        "http://viewer.example",
        "https://viewer.example:444",
        "http://127.0.0.1.evil.example:8765",
        "http://[",
        "null",  # a file in a browser, and a frame in a sandbox on any page
        "",
    ],
)
def test_no_other_page_is(origin: str) -> None:
    assert "not let in" in Admission("127.0.0.1", ALLOWED).why_refused(origin, HOST)


@each("host", [HOST, "localhost:8765", "[::1]:8765", "192.168.1.7:9000", "station.lan:8765", "::1"])
def test_this_machine_may_be_asked_for_by_these_names(host: str) -> None:
    refused = Admission("0.0.0.0", ALLOWED).why_refused(None, host)
    assert bool(refused) == (host == "::1")  # which is no Host without its brackets


@each("host", [None, "", "evil.example", "evil.example:8765", "127.0.0.1.evil.example", "["])
def test_by_no_other_name_which_a_page_may_have_given_our_address(host: str | None) -> None:
    refused = Admission("127.0.0.1", ALLOWED).why_refused("http://localhost:8765", host)
    assert "is not known as" in refused
