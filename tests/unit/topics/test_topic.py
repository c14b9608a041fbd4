"""How the bytes of a recorded message become fields, also of records that are not ours."""

from __future__ import annotations

import pytest

from gcs.topics.topic import DecodeError, recorded_topic


@pytest.mark.parametrize(
    ("encoding", "schema", "metadata", "data"),
    [
        ("json", "gate.Fsa", {}, b"[1]"),
        ("json", "gate.Fsa", {}, b"{"),
        ("json", "gate.Fsa", {}, b'{"a":' * 400 + b"1" + b"}" * 400),
        ("json", "gate.Fsa", {}, b'{"a":' + b"[" * 100_000 + b"]" * 100_000 + b"}"),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "28"}, b""),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "28"}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "9" * 5000}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {"payload_length": "999"}, bytes(60)),
        ("ros1", "mavlink/ATTITUDE", {}, bytes(60)),
        ("protobuf", "foxglove.Log", {}, bytes(60)),
    ],
)
def test_what_is_no_message_of_its_topic_is_told(
    encoding: str, schema: str, metadata: dict[str, str], data: bytes
) -> None:
    with pytest.raises(DecodeError):
        recorded_topic("/x", schema, encoding, metadata, b"").decode(data)


def test_garbage_is_told_with_its_reason() -> None:
    data = (3).to_bytes(4, "little") + b"crc" + (2).to_bytes(4, "little") + b"\xfd\x00"
    topic = recorded_topic("/link/0/garbage", "mavlink/Garbage", "ros1", {}, b"")
    assert topic.decode(data) == {"reason": "crc", "data": "fd 00"}
