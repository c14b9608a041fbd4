"""`gcs.connect`: a station for a Python program, one that runs already or one of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import msgspec

from gcs.config import SimConfig, StationConfig, Wanted
from gcs.exit_codes import ExitCode
from gcs.operator import arguments, joined
from gcs.operator.client import StationClient
from gcs.operator.differences import differences, hint, sentence
from gcs.operator.failures import CannotConnect, Disconnected, StationDiffers
from gcs.operator.station import Station
from gcs.resources import policy_path
from gcs.shell.stations import Description

DEFAULT_LINK = "udpin://127.0.0.1:14550"
SETTLE_WAIT_S = 3.0
START_WAIT_S = 30.0


@arguments.called_right
def connect(
    link: str | Sequence[str] | None = None,
    *,
    sim: bool = False,
    policy: str | None = None,
    sign_key: str | None = None,
    take_control: bool = False,
    keep: bool | None = None,
    autopilot: str | None = None,
    vehicle: int | None = None,
    speedup: float | None = None,
    log_dir: str | None = None,
    name: str = "script",
    timeout_s: float = 10.0,
) -> Station:
    """A station for the vehicle on `link`, one URL or several, as of `gcs fly --link`.

    Joins the station that has the link open, if one runs on this machine: then another operator
    may be in control, and `take_control` takes it over, which is told there.  Otherwise it starts
    one, with this `policy` (default, lab or a file; None: default), that records into `log_dir`
    (None: logs) and ends when this program leaves, unless it is to `keep`.  Without a link: the
    station on the default link, else the only one that runs, else one of its own.  `sim`: one of
    its own with a vehicle of its own, which speaks like `autopilot` (None: px4), `speedup` times
    as fast as real time (None: 1).

    `vehicle`: the MAVLink system id of the one to fly, where several are heard (None: the only one;
    of a running bridge the first; `choose` may name one later).  What is asked is asked of that one
    alone, stops as well.

    A running station that has another `policy`, `log_dir`, `speedup` or `keep` than asked for, or
    not that vehicle, is not joined: StationDiffers says which, and the vehicles that are there.
    What is None is taken as the station has it.

    `sign_key`: the file with the vehicle's MAVLink 2 signing key, for a station of its own.

    Waits `timeout_s` for a vehicle to be heard.  Raises CannotConnect, BadArgument.
    """
    _check(
        {
            "link": link,
            "sim": sim,
            "policy": policy,
            "sign_key": sign_key,
            "take_control": take_control,
            "keep": keep,
            "autopilot": autopilot,
            "vehicle": vehicle,
            "speedup": speedup,
            "log_dir": log_dir,
            "name": name,
            "timeout_s": timeout_s,
        }
    )
    if sim and link is not None:
        raise CannotConnect(
            "sim=True starts a vehicle of its own", "leave out the link", ExitCode.USAGE
        )
    if autopilot is not None and not sim:
        raise CannotConnect(
            f"autopilot={autopilot!r} is for the vehicle of sim=True; another one is as it is",
            "leave out the autopilot",
            ExitCode.USAGE,
        )
    if vehicle is not None and sim:
        raise CannotConnect(
            f"vehicle={vehicle} is for vehicles that are there; sim=True starts one of its own",
            "leave out the vehicle",
            ExitCode.USAGE,
        )
    links = [link] if isinstance(link, str) else list(link or ())
    found = None if sim else _running(links)
    if found is not None:
        _refuse_differences(found, Wanted(policy, log_dir, vehicle, speedup, keep))
        return _join(found, name, vehicle, take_control, timeout_s)
    times = 1.0 if speedup is None else speedup
    simulated = SimConfig(autopilot=autopilot or "px4", speedup=times) if sim else None
    setup = StationConfig(
        endpoints=[] if sim else links or [DEFAULT_LINK],
        sim=simulated,
        fleet=vehicle is None,
        target_sysid=vehicle or 0,
        policy_path=_policy_file(policy or "default"),
        vehicle_key_path=sign_key or "",
        log_dir=log_dir or "logs",
        name=name,
        speedup=times,
        connect_timeout_s=timeout_s,
        operator=f"Python {name}",
        keep=bool(keep),
    )
    station = Station(StationClient.start(setup))
    try:
        _wait_for_vehicle(station, timeout_s)
    except BaseException:
        station.close()
        raise
    return station


class _Arguments(msgspec.Struct):
    """What `connect` takes; the speed-ups are those of `gcs fly`."""

    link: str | list[str] | None
    sim: bool
    policy: str | None
    sign_key: str | None
    take_control: bool
    keep: bool | None
    autopilot: Literal["px4", "ardupilot"] | None
    vehicle: Annotated[int, msgspec.Meta(ge=1, le=255)] | None
    speedup: Annotated[float, msgspec.Meta(gt=0.0)] | None
    log_dir: str | None
    name: str
    timeout_s: Annotated[float, msgspec.Meta(ge=0.0)]


def _check(given: dict[str, object]) -> None:
    """Raises BadArgument."""
    try:
        msgspec.convert(given, _Arguments)
    except msgspec.ValidationError as error:
        wanted, _, where = str(error).rpartition(" - at `$.")
        name = where.rstrip("`").partition("[")[0]
        wanted = wanted.removeprefix("Expected ").partition(", got")[0].replace("`", "")
        raise arguments.bad("connect", name, wanted, given[name]) from None


def _running(links: Sequence[str]) -> Description | None:
    found = joined.station_on(links or [DEFAULT_LINK])
    if found is not None or links:
        return found
    everywhere = joined.running_stations()
    return everywhere[0] if len(everywhere) == 1 else None


def _refuse_differences(found: Description, wanted: Wanted) -> None:
    """Raises StationDiffers, or CannotConnect for a policy that cannot be read."""
    try:
        different = differences(found, wanted)
    except OSError as error:
        raise _no_policy(str(wanted.policy)) from error
    if different:
        raise StationDiffers(sentence(found, different), hint(found, different), different)


def _join(
    found: Description, name: str, vehicle: int | None, take_control: bool, timeout_s: float
) -> Station:
    """It knows the vehicle, if there is one: nothing is waited for but its greeting, and what is
    told of a chosen vehicle."""
    try:
        way = joined.JoinedStation.join(found, f"Python {name}")
    except OSError as error:
        raise CannotConnect(f"the station of process {found.pid} takes no connection") from error
    chosen = vehicle if vehicle is not None and found.vehicles else 0
    station = Station(way, chosen)
    talk = station.talk
    try:
        station.wait_until(
            lambda: talk.snapshot is not None and bool(talk.snapshot.vehicle or not chosen),
            timeout_s,
        )
        if take_control:
            station.take_control()
    except Disconnected as error:
        station.close()
        raise CannotConnect(str(error)) from error
    except BaseException:
        station.close()
        raise
    return station


def _wait_for_vehicle(station: Station, timeout_s: float) -> None:
    """Until a vehicle is heard whose place is known; a little longer for all of it."""
    talk = station.talk
    try:
        station.wait_until(lambda: talk.hello is not None, START_WAIT_S)
        station.wait_until(lambda: talk.position_known, timeout_s)
        if talk.snapshot is None or not talk.snapshot.vehicle:
            where = ", ".join(talk.hello.endpoints) if talk.hello else "the link"
            raise CannotConnect(
                f"no vehicle heard within {timeout_s:g} s ({where})",
                "start one with `vehicle-sim`, use sim=True, or name the link",
            )
        station.wait_until(lambda: talk.can_be_judged, SETTLE_WAIT_S)
    except Disconnected as error:
        trouble = talk.trouble
        if trouble is None or not trouble.exit_code:
            raise CannotConnect(str(error), exit_code=ExitCode.BUG) from error
        raise CannotConnect(trouble.text, trouble.hint, trouble.exit_code) from error


def _policy_file(policy: str) -> str:
    """As the station is told it: empty for the built-in default."""
    if policy == "default":
        return ""
    path = policy_path(policy)
    if not path.is_file():
        raise _no_policy(policy)
    return str(path)


def _no_policy(policy: str) -> CannotConnect:
    hint = "a file's name, or one of: default, lab"
    return CannotConnect(f"{policy}: no such policy file", hint, ExitCode.BAD_FILE)
