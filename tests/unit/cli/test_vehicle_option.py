"""`--vehicle SYSID`: on every command that flies or asks a vehicle, and what it means."""

from __future__ import annotations

import click
import pytest

from gcs.cli import oneshot
from gcs.cli.fly import fly
from gcs.cli.mission import live as mission_live
from gcs.cli.options import station_config
from gcs.cli.preflight import preflight

COMMANDS = [
    fly.fly,
    oneshot.status,
    preflight,
    oneshot.goto,
    oneshot.abort,
    mission_live.upload,
    mission_live.fly,
    mission_live.download,
    mission_live.clear,
]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_every_command_with_a_vehicle_has_the_option(command: click.Command) -> None:
    assert "--vehicle" in [name for option in command.params for name in option.opts]


def test_it_names_the_system_id_and_nothing_means_the_only_one() -> None:
    setup = station_config((), "default", "logs", name="a", timeout_s=1.0, vehicle=7)
    assert setup.target_sysid == 7
    setup = station_config((), "default", "logs", name="a", timeout_s=1.0)
    assert setup.target_sysid == 0
