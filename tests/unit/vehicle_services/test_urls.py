"""Endpoint URLs in both forms that users know."""

from __future__ import annotations

import pytest

from vehicle_sim.shell.urls import Url, UrlError, UrlKind, parse


@pytest.mark.parametrize(
    ("text", "url"),
    [
        ("udpin://0.0.0.0:14550", Url(UrlKind.UDP_IN, "0.0.0.0", 14550)),
        ("udpout://127.0.0.1:14540", Url(UrlKind.UDP_OUT, "127.0.0.1", 14540)),
        ("tcpin://127.0.0.1:5760", Url(UrlKind.TCP_IN, "127.0.0.1", 5760)),
        ("tcpout://localhost:5760", Url(UrlKind.TCP_OUT, "localhost", 5760)),
        ("udpin://:14550", Url(UrlKind.UDP_IN, "127.0.0.1", 14550)),
        ("udpin://[::1]:14550", Url(UrlKind.UDP_IN, "::1", 14550)),
        ("udp:127.0.0.1:14550", Url(UrlKind.UDP_IN, "127.0.0.1", 14550)),
        ("udpin:127.0.0.1:14550", Url(UrlKind.UDP_IN, "127.0.0.1", 14550)),
        ("udpout:127.0.0.1:14550", Url(UrlKind.UDP_OUT, "127.0.0.1", 14550)),
        ("tcp:127.0.0.1:5760", Url(UrlKind.TCP_OUT, "127.0.0.1", 5760)),
        ("tcpin:127.0.0.1:5760", Url(UrlKind.TCP_IN, "127.0.0.1", 5760)),
    ],
)
def test_both_forms_are_understood(text: str, url: Url) -> None:
    assert parse(text) == url
    assert parse(str(url)) == url


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "no such kind"),
        ("http://127.0.0.1:80", "no such kind"),
        ("udpin://127.0.0.1", "port is missing"),
        ("udpin://127.0.0.1:", "port is missing"),
        ("udpin://127.0.0.1:x", "port is missing"),
        ("udpout://127.0.0.1:0", "no port"),
        ("udpin://127.0.0.1:65536", "no port"),
    ],
)
def test_what_is_wrong_is_said(text: str, complaint: str) -> None:
    with pytest.raises(UrlError, match=complaint):
        parse(text)


@pytest.mark.parametrize(
    ("vehicle", "client"),
    [
        ("udpin://0.0.0.0:14550", "udpout://127.0.0.1:14550"),
        ("udpout://10.0.0.1:14540", "udpin://10.0.0.1:14540"),
        ("tcpin://127.0.0.1:5760", "tcpout://127.0.0.1:5760"),
        ("tcpout://127.0.0.1:5760", "tcpin://127.0.0.1:5760"),
    ],
)
def test_a_client_is_told_the_other_end(vehicle: str, client: str) -> None:
    assert str(parse(vehicle).other_end) == client


def test_port_0_lets_the_system_choose_where_one_listens() -> None:
    assert parse("udpin://127.0.0.1:0").at(4000) == parse("udpin://127.0.0.1:4000")
    assert parse("tcpin:127.0.0.1:0").waits
