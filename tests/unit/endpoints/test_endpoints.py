"""Endpoints as people write them."""

from __future__ import annotations

import pytest

from gcs.shell.endpoints import (
    FORMS,
    Endpoint,
    EndpointError,
    Form,
    Kind,
    parse_endpoint,
)


@pytest.mark.parametrize(
    ("text", "endpoint"),
    [
        ("udpin://0.0.0.0:14540", Endpoint(Kind.UDP_IN, "0.0.0.0", 14540)),
        ("udpin://:14550", Endpoint(Kind.UDP_IN, "127.0.0.1", 14550)),
        ("udpin://127.0.0.1:0", Endpoint(Kind.UDP_IN, "127.0.0.1", 0)),
        ("udpout://vehicle.local:14550", Endpoint(Kind.UDP_OUT, "vehicle.local", 14550)),
        ("udpout://[::1]:14550", Endpoint(Kind.UDP_OUT, "::1", 14550)),
        ("tcpout://10.0.0.7:5760", Endpoint(Kind.TCP_OUT, "10.0.0.7", 5760)),
        ("tcpin://:5760", Endpoint(Kind.TCP_IN, "127.0.0.1", 5760)),
        ("serial:///dev/ttyUSB0:921600", Endpoint(Kind.SERIAL, device="/dev/ttyUSB0", baud=921600)),
        ("udp:127.0.0.1:14550", Endpoint(Kind.UDP_IN, "127.0.0.1", 14550)),
        ("udpin:0.0.0.0:14550", Endpoint(Kind.UDP_IN, "0.0.0.0", 14550)),
        ("udpout:127.0.0.1:14550", Endpoint(Kind.UDP_OUT, "127.0.0.1", 14550)),
        ("tcp:127.0.0.1:5760", Endpoint(Kind.TCP_OUT, "127.0.0.1", 5760)),
        ("tcpin:127.0.0.1:5760", Endpoint(Kind.TCP_IN, "127.0.0.1", 5760)),
        ("/dev/ttyACM0,115200", Endpoint(Kind.SERIAL, device="/dev/ttyACM0", baud=115200)),
        ("/dev/ttyACM0", Endpoint(Kind.SERIAL, device="/dev/ttyACM0", baud=57600)),
        ("COM4,57600", Endpoint(Kind.SERIAL, device="COM4", baud=57600)),
        ("  udpin://:14550 ", Endpoint(Kind.UDP_IN, "127.0.0.1", 14550)),
    ],
)
def test_an_endpoint_is_understood(text: str, endpoint: Endpoint) -> None:
    assert parse_endpoint(text) == endpoint
    assert parse_endpoint(str(endpoint)) == endpoint


@pytest.mark.parametrize(
    ("text", "why", "hint"),
    [
        ("", "no known kind", "udpin://"),
        ("14550", "no known kind", "udpin://"),
        ("udp://:14550", "which side begins", "udpin://127.0.0.1:14550 to listen"),
        ("udp://h:1", "which side begins", "udpout://h:1 to send"),
        ("ftp://host:21", "no known kind", "tcpout://"),
        ("udpin://14550", "expected HOST:PORT", "udpin://127.0.0.1:14540"),
        ("tcp:host", "expected HOST:PORT", "tcp:127.0.0.1:5760"),
        ("udpin://::1:14550", "expected HOST:PORT", "udpin://"),
        ("udpin://:99999", "port 99999 is over 65535", "udpin://"),
        ("udpout://127.0.0.1:0", "nowhere to send", "udpout://"),
        ("/dev/ttyUSB0,0", "baud rate of 0", "/dev/ttyUSB0,57600"),
        ("/dev/ttyUSB0,fast", "expected DEVICE and BAUD", "/dev/ttyUSB0,57600"),
        ("COM", "expected DEVICE and BAUD", "COM4"),
    ],
)
def test_what_is_no_endpoint_is_told_why_with_a_hint(text: str, why: str, hint: str) -> None:
    with pytest.raises(EndpointError, match=why) as caught:
        parse_endpoint(text)
    assert str(caught.value).startswith(text)
    assert hint in caught.value.hint


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.example)
def test_every_example_of_the_table_is_of_its_kind(form: Form) -> None:
    assert parse_endpoint(form.example).kind is form.kind
