"""The topics beside the raw frames that let a viewer show the flight at once.

`Derived` is the one entrance: items of `gcs/report.py` in, messages out.  It needs no session, so
an imported log and the live server go through the same code.

A part is a `Deriver` of one subject:

    vehicle_json    /vehicle/N/state, fsa, param       phase      /vehicle/N/phase
    gate_json       /gate/decision, /gate/requests, /gate/fence, /session/input

and, where foxglove-sdk is there, in Foxglove's own schemas:

    body_frames     /tf_static, /vehicle/N/tf, model, odometry
    path            /vehicle/N/path                    places     /vehicle/N/location, /origin
    gate_scene      /gate/goals, /vehicle/N/setpoint, target, stop
    leg_scene       /vehicle/N/leg
    plan_scene      /geofence, /geofence/geojson, /mission
    words           /log, /events
"""

from __future__ import annotations

from importlib.util import find_spec

from gcs.record.derived.gate_json import GateJson
from gcs.record.derived.phase import Phases
from gcs.record.derived.vehicle_json import VehicleJson
from gcs.record.topics import Deriver, Out
from gcs.report import RecordItem


class Derived:
    """All derivers as one.  Without foxglove-sdk there are the JSON topics only."""

    def __init__(self) -> None:
        self._parts: list[Deriver] = [VehicleJson(), Phases(), GateJson()]
        if find_spec("foxglove"):
            self._parts = [*_foxglove_parts(), *self._parts]
        self._by_kind: dict[type[RecordItem], list[Deriver]] = {}
        for part in self._parts:
            for kind in part.takes:
                self._by_kind.setdefault(kind, []).append(part)
        self._started = False

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        """The messages that follow from `item`; before the first of all, those of the start."""
        outs = [] if self._started else self._start(now_ns)
        for part in self._by_kind.get(type(item), ()):
            outs += part.handle(item, now_ns)
        return outs

    def tick(self, now_ns: int) -> list[Out]:
        """What is due by the clock; call it at least twice a second."""
        return [out for part in self._parts for out in part.tick(now_ns)]

    def close(self, now_ns: int) -> list[Out]:
        """The last messages."""
        return [out for part in self._parts for out in part.close(now_ns)]

    def _start(self, now_ns: int) -> list[Out]:
        self._started = True
        return [out for part in self._parts for out in part.start(now_ns)]


def _foxglove_parts() -> list[Deriver]:
    """Imported late: the SDK is an extra."""
    from gcs.record.derived.body_frames import BodyFrames, FrameNames
    from gcs.record.derived.gate_scene import GateScene
    from gcs.record.derived.leg_scene import LegScene
    from gcs.record.derived.path import Paths
    from gcs.record.derived.places import Places
    from gcs.record.derived.plan_scene import PlanScene
    from gcs.record.derived.words import Words

    names = FrameNames()
    vehicles = [BodyFrames(names), Paths(names), Places(names), GateScene(names), LegScene(names)]
    return [*vehicles, PlanScene(names), Words()]
