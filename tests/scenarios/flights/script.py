"""What the recorder of the flights sent, in the order of the answers.

The logs hold what the vehicles told alone.  Commands are known by their COMMAND_ACKs, their order
and the labels of commands_px4.json and commands_arducopter.json; places, heights and rates by what
the vehicle then did.  What neither tells is from memory of usual scripts: the parameters of
commands that were refused, which of PX4's modes was asked for on the ground, and where the
reposition before the orbit went.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import cos, nan, radians
from typing import Final

from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality

HOMES: Final[dict[Personality, Geodetic]] = {
    "px4": Geodetic(45.4671132, -73.7578418, 32.24),
    "ardupilot": Geodetic(47.397742, 8.545594, 488.1),
}
"""HOME_POSITION at the take-off."""

ENDS_S: Final[dict[Personality, float]] = {"px4": 163.0, "ardupilot": 124.0}
"""After the landing; the plans that were sent then are rows of behaviour.json."""

METRES_A_DEGREE: Final = 111_319.5


HOLD_S: Final = 78.0
LAND_S: Final = 152.0
"""What ours alone is asked for: the recorded PX4 went, by a VTOL's take-off, from the orbit to a
mode that ours does not fly.  On the ground it was armed in it, in the air it came down in it."""


@dataclass(frozen=True, slots=True)
class Phase:
    name: str
    from_s: float
    to_s: float


PHASES: Final[dict[Personality, tuple[Phase, ...]]] = {
    "px4": (
        Phase("unasked", 10.0, 24.0),
        Phase("intervals set", 70.0, 77.0),
        Phase("climb", 81.5, 87.0),
        Phase("hover", 89.5, 107.5),
        Phase("travel", 108.5, 116.0),
        Phase("offboard", 125.0, 131.0),
        Phase("failsafe", 132.5, 136.0),
        Phase("orbit", 142.0, 151.0),
    ),
    "ardupilot": (
        Phase("unasked", 4.0, 13.0),
        Phase("streams on the ground", 53.0, 61.0),
        Phase("climb", 77.0, 81.0),
        Phase("travel", 86.0, 91.0),
        Phase("setpoint", 97.5, 108.0),
        Phase("descent", 116.0, 118.5),
    ),
}


@dataclass(frozen=True, slots=True)
class Command:
    """`acked`: by the recorded one; one that is not follows the one before it."""

    number: int
    params: tuple[float, ...] = ()
    component: int = 1
    frame: int | None = None  # of COMMAND_INT
    acked: bool = True


@dataclass(frozen=True, slots=True)
class Asked:
    """Something that is not a command, at `t` seconds since power-up."""

    t: float
    what: str
    value: float = 0.0


def long(number: int, *params: float, component: int = 1) -> Command:
    return Command(number, params, component)


def unanswered(number: int, *params: float) -> Command:
    return Command(number, params, acked=False)


def located(
    personality: Personality, frame: int, north: float, alt: float, change_mode: float = 0.0
) -> Command:
    """DO_REPOSITION to so many metres north of home and an altitude AMSL."""
    lat_e7, lon_e7 = _place_e7(personality, north, 0.0)
    return Command(192, (-1.0, change_mode, 0.0, nan, lat_e7, lon_e7, alt), frame=frame)


def _place_e7(personality: Personality, north: float, east: float) -> tuple[float, float]:
    home = HOMES[personality]
    east_a_degree = METRES_A_DEGREE * cos(radians(home.lat_deg))
    lat, lon = home.lat_deg + north / METRES_A_DEGREE, home.lon_deg + east / east_a_degree
    return round(lat * 1e7), round(lon * 1e7)


REQUESTED: Final = (
    *(0, 1, 2, 22, 24, 30, 31, 32, 33, 36, 42, 49, 62, 65, 74, 77, 83, 85, 87, 105, 111, 116, 141),
    *(147, 148, 230, 231, 241, 242, 244, 245, 253, 259, 260, 261, 262, 263, 265, 266, 269, 280),
    *(283, 284, 290, 291, 300, 321, 340, 360, 370, 375, 380, 390, 395, 397, 410, 411, 412, 413),
    *(435, 436, 437, 440, 9000, 9999, 12904, 168, 178, 193, 163, 165, 136, 126, 152, 150, 125),
)
PING: Final = 4
INTERVALS: Final = (
    *(long(511, 30, 1e5), long(511, 9999, 1e6), long(511, 0, 1e6), long(511, 30, 66_667)),
    *(long(511, 32, 33_333), long(511, 245, 2e5), long(511, 147, 1e6), long(511, 242, 1e6)),
    long(511, 30, 1e5),
)
"""Which messages were then told at which rate; the third, which PX4 refused, is from memory."""


def asked(personality: Personality) -> Iterable[Command]:
    """The requests of messages, and of intervals."""
    for number in (*REQUESTED[:3], PING, *REQUESTED[3:]):
        yield long(512, number)
    yield from (long(520, 1), long(519, 1), long(510, 30), *INTERVALS)


def _commands(personality: Personality) -> Iterable[Command]:
    """What was asked on the ground and again in the air, of everything there is."""
    px4 = personality == "px4"
    absent = unanswered if px4 else long
    home = HOMES[personality]
    yield from (long(31999), long(31010), long(44000))
    lat_e7, lon_e7 = _place_e7(personality, 4.0, 12.0)
    place = (lat_e7 / 1e7, lon_e7 / 1e7)
    yield long(192, -1, 1, 0, nan, *place, home.alt_amsl_m + 1.5 if px4 else 493.0)
    yield located(personality, 8, 0.0, home.alt_amsl_m + 5)
    yield located(personality, 2, 0.0, home.alt_amsl_m + 5)
    yield from (long(193, 0), long(193, 1), long(178, 1, 3, -1), long(178, 1, -5, -1))
    yield from (long(186, 8, 3), long(34, 5, 1, 0, nan, nan, nan, nan), long(115, 90, 20, 1))
    yield from (long(2000, 0, 0, 1), long(2001), absent(203, 0, 0, 0, 0, 1), long(2500))
    yield from (absent(530, 0, 0), long(521, 1), absent(1000, -10, 0, nan, nan))
    yield from (absent(205, -10, 0, 0, 0, 0, 0, 2), long(401), long(185, 0))
    yield from (absent(420, 4, 0, 0), long(410), long(224, 0), long(224, 99))
    yield from (long(207, 1), long(207, 0), long(183, 9, 1500))
    yield from (long(187, 0, nan, nan, nan, nan, nan, 0), long(310, 0, 1, 0, 0, 33))
    yield from (long(195, 0, 0, 0, 0, *place, home.alt_amsl_m), long(197), long(201))
    yield from (long(16), long(17), long(19, 5), long(84, 0, 0, 0, nan, nan, nan, 493.0))
    yield from (absent(3000, 3), absent(211, 1, 0), absent(206, 10, 0, 1), long(218, 9, 2))
    yield from (long(92, 1), long(43000, 0, 3), long(245, 1), long(511, 0, 1e6), long(177, 0, 1))
    yield from (long(252, 0, 2), long(5000), long(112, 1), absent(93, 1))
    yield from (long(400, 0, component=25), long(401))


def _ground_modes(personality: Personality) -> Iterable[Command]:
    if personality == "px4":
        told: tuple[tuple[int, ...], ...] = (
            *((4, 3), (3,), (6,), (4, 5), (4, 4), (4, 6), (4, 2), (99,), (4, 99), (1,), (4, 3)),
        )
    else:
        told = tuple((number,) for number in (4, 5, 6, 3, 17, 9, 99, 0))
    return (long(176, 1, *numbers) for numbers in told)


def commands(personality: Personality) -> list[Command]:
    """All commands, in order; those that are `acked` match the recorded COMMAND_ACKs one by one."""
    px4 = personality == "px4"
    alt = HOMES[personality].alt_amsl_m + 5.0
    at_once = (
        () if px4 else (long(400, 1), long(22, 0, 0, 0, 0, 0, 0, 5), long(176, 1, 4), long(401))
    )
    take_off = long(22, 0, 0, 0, nan, nan, nan, alt if px4 else 5.0)
    land = long(21, 0, 0, 0, nan, nan, nan, nan)
    hold = long(176, 1, 4, 3) if px4 else long(176, 1, 4)
    offboard = (long(176, 1, 4, 3), long(176, 1, 6), long(176, 1, 6), long(176, 1, 4, 3))
    return [
        *at_once,
        *asked(personality),
        *(long(22, 0, 0, 0, 0, 0, 0, 5), land, long(20), long(300)),
        *_ground_modes(personality),
        *_commands(personality),
        *(long(246, 0, 0, 1, 100), long(241), long(209, 1, 0, 5, 1, 1)),
        *(long(400, 0), long(179, 1)),
        *(() if px4 else (hold,)),
        *(long(400, 1), long(400, 1), take_off),
        located(personality, 5, 5.0, alt, change_mode=1.0),
        *(long(22, 0, 0, 0, 0, 0, 0, 5), long(400, 0), long(400, 1)),
        *(offboard if px4 else (hold, hold)),
        *_commands(personality),
        *(hold, land),
    ]


def asked_otherwise(personality: Personality) -> list[Asked]:
    """Lists, reads, streams and setpoints; when each began is seen in what followed."""
    if personality == "px4":
        return [
            Asked(25.4, "parameters"),
            *(Asked(HOLD_S, "hold"), Asked(LAND_S, "land")),
            *(Asked(round(121.6 + 0.05 * n, 2), "setpoint") for n in range(175)),
        ]
    return [
        Asked(26.68, "parameters"),
        *(Asked(36.64, "read _HASH_CHECK"), Asked(36.74, "read WP_SPD")),
        *(Asked(36.96, "read NOSUCH_PARAM"), Asked(37.16, "read WP_SPD")),
        *(Asked(52.1, "streams", 4.0), Asked(96.9, "setpoint")),
        *(Asked(115.9 + n, "throttle down") for n in range(9)),
    ]


@dataclass(frozen=True, slots=True)
class Figure:
    """A movement measured between two times; `word` is a state's name, where it is until one."""

    name: str
    unit: str
    what: str
    from_s: float
    to_s: float
    word: str = ""
    slack: float = 0.1  # what it may differ by, however small it is


FIGURES: Final[dict[Personality, tuple[Figure, ...]]] = {
    "px4": (
        Figure("take-off sent to TAKEOFF", "s", "until landed state", 78.92, 100, "TAKEOFF", 0.25),
        Figure("take-off sent to IN_AIR", "s", "until landed state", 78.92, 100, "IN_AIR", 0.25),
        Figure("take-off, fastest climb", "m/s", "up", 79, 90),
        Figure("take-off, height kept", "m", "height", 90, 107.5),
        Figure("reposition, fastest", "m/s", "horizontal", 108.2, 116),
        Figure("reposition, time to 90 %", "s", "time to 90 %", 108.2, 116),
        Figure("take-off again, fastest climb", "m/s", "up", 116.5, 121),
        Figure("take-off again, height kept", "m", "height", 120, 123.5),
        Figure("OFFBOARD, fastest across", "m/s", "horizontal", 124, 130.5),
        Figure("OFFBOARD, fastest descent", "m/s", "down", 124, 130.5),
        Figure("OFFBOARD, height kept", "m", "height", 128, 130.5),
        Figure("OFFBOARD lost, descent", "m/s", "mean down", 132.5, 136),
        Figure("orbit, speed", "m/s", "mean horizontal", 146, 151),
    ),
    "ardupilot": (
        Figure("take-off sent to TAKEOFF", "s", "until landed state", 74.74, 90, "TAKEOFF", 0.25),
        Figure("take-off sent to IN_AIR", "s", "until landed state", 74.74, 90, "IN_AIR", 0.25),
        Figure("take-off, fastest climb", "m/s", "up", 75, 84),
        Figure("take-off, height kept", "m", "height", 83, 84.9),
        Figure("reposition, fastest", "m/s", "horizontal", 84.9, 92),
        Figure("reposition, time to 90 %", "s", "time to 90 %", 84.9, 92),
        Figure("setpoint, fastest", "m/s", "horizontal", 96.9, 104),
        Figure("setpoint, time to 90 %", "s", "time to 90 %", 96.9, 104),
        Figure("setpoint, height kept", "m", "height", 100, 110),
        Figure("LOITER, throttle down: descent", "m/s", "down", 116.2, 119),
        Figure("LAND sent to ON_GROUND", "s", "until landed state", 119.28, 124, "ON_GROUND", 0.25),
        Figure("LAND sent to disarmed", "s", "until disarmed", 119.28, 124, "False", 1.0),
    ),
}
