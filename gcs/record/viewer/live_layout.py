"""The layout of a live view: buttons for what is asked most, and a 3D panel in which a click flies.

Made of the same template as the layouts of records.  The 3D panel stands in the frame `map`, in
which it publishes what is clicked; a frame of the vehicle would move under the click.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from gcs.record.viewer.extent import fence_extent
from gcs.record.viewer.layout import any_flight_of, layout
from gcs.report import FenceItem

PLOT_WIDTH_S = 60.0


def live_layout(vehicles: Sequence[int], fence: FenceItem | None, code: str) -> dict[str, Any]:
    """`vehicles` in the order in which they were seen; `code`: of the service `take_control`."""
    topics = any_flight_of(vehicles or [1])
    made = layout(topics, "live", fence_extent(fence), vehicles[1:])
    panels = made["configById"]
    panels["CallService!take_control"]["requestPayload"] = json.dumps({"code": code})
    for name, config in panels.items():
        if name.startswith("Plot!"):
            config["followingViewWidth"] = PLOT_WIDTH_S
    return made
