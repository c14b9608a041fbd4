"""What `vehicle-sim` and the pytest plugin load before they have done anything."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from tests.system.patience import PATIENT_S

pytestmark = pytest.mark.system

OF_OTHERS = (
    "gcs",
    "foxglove",
    "textual",
    "mcap",
    "rich",
    "pygments",
    "pymavlink",
    "numpy",
    "msgspec",
)
"""Packages of the station, of its record and screens, of other ends and of larger fleets."""
RARE = (
    "vehicle_sim.live_page",
    "vehicle_sim.simulation.control_line",
    "vehicle_sim.engine.batch_engine",
    "vehicle_sim.flight_log.px4",
    "vehicle_sim.flight_log.ardupilot",
    "vehicle_sim.services.events.event_definitions",
    "hashlib",
    "vehicle_sim.numerics.lanes",
    "vehicle_sim.testing",
    "vehicle_sim.wire.dialect",
    "vehicle_sim.wire.generate",
    "asyncio",
    "subprocess",
    "unittest",
    "logging",
    "json",
    "difflib",
    "tempfile",
    "zipfile",
    "importlib.resources",
)
"""What is loaded when it is asked for."""


def loaded(*command: str) -> set[str]:
    """The modules that a Python program has imported when standard input ends."""
    ended = subprocess.run(
        [sys.executable, "-X", "importtime", *command],
        input="",
        capture_output=True,
        text=True,
        timeout=PATIENT_S,
        check=True,
    )
    names = re.findall(r"^import time: +\d+ \| +\d+ \| +(\S+)$", ended.stderr, re.MULTILINE)
    assert "encodings" in names
    return set(names)


def unwanted(names: set[str], packages: tuple[str, ...]) -> set[str]:
    """Those of the modules that are in one of the packages."""
    return {
        name for name in names for package in packages if (name + ".").startswith(package + ".")
    }


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_vehicle_loads_what_it_flies_with(autopilot: str) -> None:
    """It runs until its standard input ends, which is at once."""
    names = loaded("-m", "vehicle_sim", "--lifeline", "--port", "0", "--autopilot", autopilot)
    assert "vehicle_sim.services.server" in names
    assert unwanted(names, OF_OTHERS + RARE) == set()


def test_the_pytest_plugin_loads_no_vehicle_before_a_test_asks_for_one() -> None:
    names = loaded("-c", "import vehicle_sim.testing.plugin")
    ours = {name for name in names if name.startswith("vehicle_sim")}
    assert ours == {"vehicle_sim", "vehicle_sim.testing", "vehicle_sim.testing.plugin"}
    others = ("gcs", "foxglove", "textual", "mcap", "rich", "pymavlink", "numpy", "msgspec")
    assert unwanted(names, others) == set()


def test_what_the_package_promises_is_there_when_it_is_asked_for() -> None:
    program = (
        "import vehicle_sim.testing as t; names = [getattr(t, n).__name__ for n in t.__all__]; "
        "assert names == t.__all__, names; assert not hasattr(t, 'Nothing')"
    )
    subprocess.run([sys.executable, "-c", program], timeout=PATIENT_S, check=True)
