"""What a viewer decodes of a record, and short ways to write items."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from gcs.frames import Vec3
from gcs.report import FsaItem, PoseItem, Quat
from tests.unit.record.flights import messages_of

UPRIGHT: Quat = (1.0, 0.0, 0.0, 0.0)


def pose(pos_ned: Vec3, sysid: int = 1, q: Quat = UPRIGHT) -> PoseItem:
    return PoseItem(sysid, pos_ned, (0.0, 0.0, 0.0), q)


def fsa(state: str, number: int = 1) -> FsaItem:
    return FsaItem(1, state, number, "", "event", "ours", "nominal", None)


def pictures(path: Path, topic: str) -> list[Any]:
    """The decoded protobuf messages of a topic."""
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [decoded for *_, decoded in reader.iter_decoded_messages(topics=[topic])]


def readings(path: Path, topic: str) -> list[Any]:
    """The JSON messages of a topic; NaN and infinity are an error, as in a viewer."""

    def refuse(word: str) -> None:
        raise ValueError(f"{word} is no JSON")

    found = [message for message in messages_of(path) if message.topic == topic]
    return [json.loads(message.data, parse_constant=refuse) for message in found]


def turned(q: Any, v: Vec3) -> Vec3:
    """The vector `v` rotated by the quaternion `q` (Rodrigues)."""
    x, y, z, w = q.x, q.y, q.z, q.w
    vx, vy, vz = v
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )
