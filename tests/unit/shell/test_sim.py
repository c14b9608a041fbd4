"""How a vehicle of the station's own is started."""

from __future__ import annotations

from gcs.config import SimConfig
from gcs.shell.sim import words_of


def test_its_place_and_parameters_are_passed_on() -> None:
    sim = SimConfig("ardupilot", home="47,8,400", params={"FS_GCS_ENABLE": 1.0, "WP_SPD": 2.5})
    words = " ".join(words_of(sim, 14000)[1:])
    assert words == (
        "-m vehicle_sim --lifeline --autopilot ardupilot --seed 1 --speedup 1.0"
        " --link udpout://127.0.0.1:14000 --home 47,8,400"
        " --param FS_GCS_ENABLE=1 --param WP_SPD=2.5"
    )


def test_several_are_one_program() -> None:
    assert "--count 3" in " ".join(words_of(SimConfig(count=3), 14000))
    assert "--count" not in words_of(SimConfig(), 14000)
