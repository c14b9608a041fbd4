"""How a station process is to be started: one object, passed as JSON in its first argument."""

from __future__ import annotations

import msgspec

DEFAULT_LINK = "udpin://127.0.0.1:14550"
"""Where vehicles are looked for if nobody says where."""
DISK_LOW_BYTES = 200_000_000
DISK_CRITICAL_BYTES = 20_000_000
"""Less room than that on the disk of the record is too little, or next to none."""
SIM_SYSID = 1
"""The system id of a vehicle of the station's own: vehicle-sim's default."""


class SimConfig(msgspec.Struct, frozen=True):
    """A vehicle of the station's own (`--sim`), stopped once it holds or has landed."""

    autopilot: str = "px4"
    home: str = ""  # LAT,LON,ALT; empty = the autopilot's own
    seed: int = 1
    speedup: float = 1.0
    params: dict[str, float] = {}  # parameters that are set at its start
    count: int = 1  # so many vehicles, numbered from 1, in rows


class StationConfig(msgspec.Struct, frozen=True):
    """Everything that a station needs to know.  Times in seconds, paths as typed by the user."""

    endpoints: list[str] = []  # empty with `sim`: a private free port
    clients: list[str] = []  # ports where MAVLink clients reach the vehicle through the gate
    bridge: bool = False  # `gcs bridge`: the operator who started it only looks
    fleet: bool | msgspec.UnsetType = msgspec.UNSET  # every vehicle that is heard is flown, and
    #   is named in each request; where it is not said, it is in no record either
    sim: SimConfig | None = None
    policy_path: str = ""  # empty = the built-in default
    vehicle_key_path: str = ""  # file with the MAVLink 2 signing key of the vehicle's links
    client_key_path: str = ""  # and of the clients' links; empty = not signed
    log_dir: str = "logs"
    name: str = "flight"  # <YYYYMMDD-HHMMSS>_<name>.mcap
    sysid: int = 255
    compid: int = 190
    target_sysid: int = 0  # 0 = the first vehicle heard
    speedup: float = 1.0
    connect_timeout_s: float = 10.0
    operator: str = "first operator"  # its name, for the others who look at the station
    keep: bool = False  # the station lives on when the operator who started it leaves
    command_line: str = ""  # what was typed, for the record
    record: bool = True  # False: nothing is written, as for a short look at the vehicle
    rotate_bytes: int = 0  # a new file of the record from this size on; 0 = one file
    rotate_s: float = 0.0  # and after so long, by the station's clock; 0 = one file
    compact: bool = True  # files are rewritten in larger chunks once the station has ended
    rule_path: str | msgspec.UnsetType = msgspec.UNSET  # `--verifier`: the operator's own rule

    @property
    def expected_sysid(self) -> int:
        """The number of the vehicle that is waited for; 0 = not known."""
        return self.target_sysid or (SIM_SYSID if self.sim is not None else 0)

    @property
    def several(self) -> bool:
        """Whether every vehicle that is met is flown, and not one alone."""
        one = self.sim is not None and self.sim.count == 1
        return (self.bridge or self.fleet is True) and not one and not self.target_sysid


class Wanted(msgspec.Struct, frozen=True):
    """What an operator asks of a station by name, which one that runs may have otherwise; None:
    whatever it has."""

    policy: str | None = None  # default, lab, or a file
    log_dir: str | None = None
    vehicle: int | None = None  # MAVLink system id
    speedup: float | None = None
    keep: bool | None = None


ANY_STATION = Wanted()


def encode(config: StationConfig) -> str:
    return msgspec.json.encode(config).decode()


def decode(text: str) -> StationConfig:
    """Raises msgspec.ValidationError."""
    return msgspec.json.decode(text.encode(), type=StationConfig)
