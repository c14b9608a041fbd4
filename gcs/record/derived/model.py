"""What a vehicle looks like in 3D."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from foxglove.messages import (
    CubePrimitive,
    CylinderPrimitive,
    Pose,
    Quaternion,
    SceneEntity,
    SceneUpdate,
    Timestamp,
    Vector3,
)

from gcs.record.derived.drawing import NO_TURN, color

ARM_M = 0.45
"""Centre to motor: larger than life, so that it is seen from a hundred metres."""

_DARK = color((0.12, 0.13, 0.16))
_FRONT = color((1.0, 0.45, 0.1), 0.9)
_REAR = color((0.85, 0.87, 0.9), 0.9)


def quadrotor(stamp: Timestamp, frame_id: str, name: str) -> SceneUpdate:
    """A quadrotor in X, forward = x, up = z of `frame_id`; the front propellers are orange."""
    arms = [
        CubePrimitive(
            pose=Pose(
                position=Vector3(),
                orientation=Quaternion(z=sin(turn / 2), w=cos(turn / 2)),
            ),
            size=Vector3(x=2 * ARM_M, y=0.05, z=0.04),
            color=_DARK,
        )
        for turn in (pi / 4, -pi / 4)
    ]
    body = CubePrimitive(
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        size=Vector3(x=0.3, y=0.2, z=0.12),
        color=_DARK,
    )
    reach = ARM_M / sqrt(2.0)
    propellers = [
        CylinderPrimitive(
            pose=Pose(position=Vector3(x=forward, y=left, z=0.06), orientation=NO_TURN),
            size=Vector3(x=0.4, y=0.4, z=0.015),
            bottom_scale=1.0,
            top_scale=1.0,
            color=_FRONT if forward > 0 else _REAR,
        )
        for forward in (reach, -reach)
        for left in (reach, -reach)
    ]
    entity = SceneEntity(
        timestamp=stamp,
        frame_id=frame_id,
        id=name,
        frame_locked=True,
        cubes=[body, *arms],
        cylinders=propellers,
    )
    return SceneUpdate(entities=[entity])
