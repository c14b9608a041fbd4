"""Random flights: an operator who asks for anything, a link that loses frames, a faulty vehicle.

Everything follows from one number, so that a flight that breaks a promise can be flown again.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from gcs import ipc
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.checked_flight import CheckedFlight
from tests.loopback.flight import MISSIONS, PERSONALITIES, POLICIES
from tests.loopback.lossy_link import Weather
from vehicle_sim.simulation.world import Datagram

NONSENSE = (math.nan, math.inf, -math.inf, 1e39, -1e308)
FILES = ("lab3/square.toml", "lab3/first_step.toml", "square.toml", "survey.plan", "no/such.plan")
MODES = (
    "AUTO.LOITER",
    "OFFBOARD",
    "AUTO.LAND",
    "POSCTL",
    "GUIDED",
    "RTL",
    "LAND",
    "STABILIZE",
    "?",
)
KINDS = ("hold", "brake", "position", "manual", "guided", "mission", "return", "land")

Act = Callable[[CheckedFlight, random.Random], None]


def _near(flight: CheckedFlight, dice: random.Random) -> None:
    flight.goto(dice.uniform(-4.8, 4.8), dice.uniform(-4.8, 4.8), dice.uniform(0.4, 1.9))


def _sensible(flight: CheckedFlight, dice: random.Random) -> None:
    """What an operator who wants to get on would do."""
    match flight.state:
        case State.GROUNDED:
            flight.say("arm")
            flight.run(1.0)
            flight.say("takeoff", up_m=1.2)
            flight.run(2.5)
        case State.HOLDING | State.EXTERNAL:
            flight.say("resume")
        case State.HOVERING:
            _near(flight, dice)
        case _:
            flight.run(1.0)


def _far(flight: CheckedFlight, dice: random.Random) -> None:
    reach_m = dice.choice((6.0, 200.0, 2000.0))
    flight.goto(*(dice.uniform(-reach_m, reach_m) for _ in range(3)))


def _nonsense(flight: CheckedFlight, dice: random.Random) -> None:
    goal = [dice.uniform(-4.0, 4.0), dice.uniform(-4.0, 4.0), 1.0]
    goal[dice.randrange(3)] = dice.choice(NONSENSE)
    flight.goto(*goal)


def _twice(flight: CheckedFlight, dice: random.Random) -> None:
    _near(flight, dice)
    _near(flight, dice)
    if dice.random() < 0.5:
        flight.say(dice.choice(("abort", "hold", "land", "photo", "mission_start")))


def _word(word: str) -> Act:
    return lambda flight, dice: _forget(flight.say(word))


def _take_off(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say("arm")
    up_m = dice.choice((1.0, 1.5, 1.9, 0.0, -3.0, 1e6, None))
    flight.run(dice.choice((0.0, 0.5, 1.5)))
    flight.say("takeoff", up_m=up_m)


def _disarm(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say("disarm", force=dice.random() < 0.5)


def _mode(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say("mode", mode=dice.choice(MODES))


def _fence(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say("fence", on=dice.random() < 0.6)


def _upload(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say("mission_upload", path=str(MISSIONS / dice.choice(FILES)))


def _unknown(flight: CheckedFlight, dice: random.Random) -> None:
    flight.say(dice.choice(("dance", "goto", "", "mission_download")))


def _pending(flight: CheckedFlight, dice: random.Random) -> None:
    flight.feed(inputs.OperatorLine(1, ipc.Pending((dice.uniform(-9.0, 9.0), 0.0, 0.5))))
    flight.feed(inputs.OperatorNoise(1, "{"))


def _dropout(flight: CheckedFlight, dice: random.Random) -> None:
    flight.positions_lost = True
    flight.run(dice.uniform(0.2, 3.0))
    flight.positions_lost = False


def _silence(flight: CheckedFlight, dice: random.Random) -> None:
    flight.vehicle_silent = True
    flight.run(dice.uniform(0.5, 5.0))
    flight.vehicle_silent = False


def _somebody_else(flight: CheckedFlight, dice: random.Random) -> None:
    flight.vehicle.set_mode_kind(dice.choice(KINDS))


def _gust(flight: CheckedFlight, dice: random.Random) -> None:
    flight.push((dice.uniform(-6.0, 6.0), dice.uniform(-6.0, 6.0), dice.uniform(-1.0, 2.0)))


def _garbage(flight: CheckedFlight, dice: random.Random) -> None:
    noise = dice.randbytes(dice.choice((1, 40, 300, 70_000)))
    flight.feed(inputs.Datagram(0, noise))
    flight.world.handle(Datagram(0, "somebody", noise), flight.now_ns)


def _recorder(flight: CheckedFlight, dice: random.Random) -> None:
    flight.feed(inputs.RecorderChanged(dice.random() < 0.5, "flight.mcap", "the disk"))


ACTS: tuple[tuple[int, Act], ...] = (
    (40, _sensible),
    (6, _near),
    (3, _far),
    (3, _nonsense),
    (4, _twice),
    (4, _take_off),
    (3, _word("abort")),
    (2, _word("hold")),
    (6, _word("resume")),
    (3, _word("control")),
    (3, _word("photo")),
    (1, _word("land")),
    (1, _word("rtl")),
    (1, _disarm),
    (2, _mode),
    (2, _fence),
    (2, _upload),
    (2, _word("mission_start")),
    (1, _word("mission_clear")),
    (1, _unknown),
    (1, _pending),
    (1, _dropout),
    (1, _silence),
    (1, _somebody_else),
    (1, _gust),
    (1, _garbage),
    (1, _recorder),
)


def weather(dice: random.Random) -> Weather:
    """From calm to awful: loss up to 30 %, delays up to 300 ms, and with them disorder."""
    badness = dice.random()
    slowest_s = 0.001 + 0.299 * dice.random() * badness
    return Weather(
        loss=0.3 * badness * dice.random(),
        duplicate=0.2 * badness,
        corrupt=0.1 * badness,
        delay_s=(0.001, slowest_s),
    )


def flown(index: int, seconds: float = 20.0) -> CheckedFlight:
    """Random flight number `index`, flown to its end and left in good order."""
    dice = random.Random(index)
    flight = CheckedFlight(
        PERSONALITIES[index % 2],
        policy=POLICIES[("lab", "default")[index // 2 % 2]],
        seed=index + 1,
        up=weather(dice),
        down=weather(dice),
    )
    with flight.witness.listening(flight.policy):
        flight.run(dice.uniform(1.5, 2.5))
        flight.say("arm")
        flight.run(dice.uniform(0.6, 1.2))
        flight.say("takeoff", up_m=dice.uniform(0.8, 1.6))
        flight.run(dice.uniform(1.0, 5.0))
        acts = [act for weight, act in ACTS for _ in range(weight)]
        while flight.elapsed_s < seconds and flight.finish is None:
            dice.choice(acts)(flight, dice)
            if dice.random() < 0.005:
                break
            flight.run(dice.choice((0.0, 0.02, 0.2, 0.7, 1.5, 3.0)))
        flight.feed(inputs.OperatorGone(1, "the flight is over"))
        flight.run(4.0)
    return flight


def _forget(_: object) -> None:
    return None
