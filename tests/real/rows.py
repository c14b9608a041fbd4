"""What is flown: rows, each with a place to begin, and what goes wrong meanwhile."""

import itertools
import math
import random
from dataclasses import dataclass, replace

from tests.real.autopilots import PX4, Kind
from tests.real.truth import Vector

EIGHT = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")
HEIGHT_M = 20.0
PILOTS = ("library", "one-shot", "bridge")


@dataclass(frozen=True)
class Row:
    """One request, or what its kind says.  The fence is a cylinder about home."""

    kind: str
    by: str = "library"
    direction: str = "E"
    leg_m: float = 0.0
    goal_m: float = 0.0  # how far out the goal is, from home, or how high
    radius_m: float = 60.0
    ceiling_m: float = 40.0
    trouble: str = ""  # kill, blackout, delay, loss, other-station, gps, hold; see trials.py
    figure: float = 0.0  # of the kind or the trouble: m/s, m, s, a share
    when: float = 0.0  # the trouble begins: a share of the leg's time
    word: str = ""  # of the kind: what is asked for, or what a client tries
    wind_m_s: float = 0.0
    wind_deg: float = 0.0

    @property
    def name(self) -> str:
        words = [self.kind, self.word, self.by if self.by != "library" else ""]
        if self.kind in ("approach", "go"):
            words.append(
                f"{self.leg_m:g} m {self.direction} to {self.goal_m:g} of {self.limit_m:g}"
            )
        words.append(self.trouble)
        if self.figure:
            words.append(f"{self.figure:g}")
        if self.when:
            words.append(f"at {self.when:g}")
        if self.wind_m_s:
            words.append(f"wind {self.wind_m_s:g} from {self.wind_deg:g}")
        return " ".join(filter(None, words))

    @property
    def limit_m(self) -> float:
        return self.ceiling_m if self.direction == "up" else self.radius_m

    @property
    def unit(self) -> Vector:
        if self.direction == "up":
            return (0.0, 0.0, 1.0)
        angle = math.radians(45.0 * EIGHT.index(self.direction))
        return (math.sin(angle), math.cos(angle), 0.0)

    def at(self, metres: float) -> Vector:
        """So far out on the row's line through home, or up."""
        e, n, u = self.unit
        return (e * metres, n * metres, metres if u else HEIGHT_M)

    @property
    def start(self) -> Vector:
        if self.direction == "up":
            return self.at(max(3.0, self.goal_m - self.leg_m))
        return self.at(self.goal_m - self.leg_m)

    def clearance_m(self, from_home: Vector) -> float:
        """How far inside the fence; negative is outside."""
        east, north, up = from_home
        return min(self.radius_m - math.hypot(east, north), self.ceiling_m - up)


def known(kind: Kind) -> list[Row]:
    """The approaches that a real vehicle has left its fence on."""
    if kind is PX4:
        legs = [(20, 57.8), (30, 57.8), (29, 57.6), (40, 57.8), *[(57, 57.7)] * 5]
        legs += [(55, 54.8), (51, 50.8), (46, 46.8)]
    else:
        legs = [(10, 57.9), (20, 57.9), (40, 57.9), *[(58, 57.9)] * 3, (55, 55.0)]
    rows = [Row("approach", leg_m=leg, goal_m=goal) for leg, goal in legs]
    rows.append(Row("approach", leg_m=147.8, goal_m=147.8, radius_m=150.0, ceiling_m=50.0))
    rows.append(Row("approach", by="bridge", leg_m=57.7, goal_m=57.7))
    return rows


def approaches(kind: Kind, rng: random.Random, count: int, trouble: str = "") -> list[Row]:
    rows = []
    for number in range(count):
        inside_m = round(rng.uniform(2.0, 10.0), 1)
        by = "library" if trouble else rng.choices(PILOTS, (6, 1, 2))[0]
        windy = kind is not PX4 and number % 2
        wind = (rng.choice((4.0, 8.0)), 45.0 * rng.randrange(8)) if windy else (0.0, 0.0)
        figures = {
            "blackout": round(rng.uniform(0.5, 6.0), 1),
            "loss": 0.25,
            "delay": rng.choice((0.2, 0.5)),
        }
        when = 0.0 if trouble in ("", "loss", "delay") else round(rng.uniform(0.05, 0.9), 2)
        if number % 8 == 7:
            leg, direction, radius = rng.uniform(5.0, 30.0), "up", 60.0
        else:
            leg, direction = 5.0 * 30.0 ** rng.random(), rng.choice(EIGHT)
            radius = 60.0 if leg < 100.0 else 150.0
        limit = 40.0 if direction == "up" else radius
        rows.append(
            Row("approach", by, direction, round(leg, 1), limit - inside_m, radius, 40.0, trouble,
                figures.get(trouble, 0.0), when, "", *wind)
        )  # fmt: skip
    return rows


def ground() -> list[Row]:
    """From the ground and back to it: each kind of landing is followed by an arming."""
    rows = [Row("takeoff", figure=2.0), Row("landing", "library", word="land")]
    for up_m, word in zip(
        (5.0, 10.0, 20.0, 29.0), ("rtl", "mission", "other", "land"), strict=True
    ):
        rows += [Row("takeoff", figure=up_m), Row("landing", word=word)]
    return [*rows, Row("takeoff", "one-shot", figure=5.0), Row("landing", "one-shot", word="land")]


def stops(rng: random.Random) -> list[Row]:
    words = itertools.cycle(("hold", "abort"))
    return [
        Row("stop", direction=rng.choice(EIGHT), goal_m=80.0, leg_m=160.0, radius_m=150.0,
            ceiling_m=50.0, figure=float(speed), word=next(words))
        for speed in range(1, 13)
    ]  # fmt: skip


def held_at_the_end() -> list[Row]:
    """Told to hold so many metres before a goal near the fence: just after it has slowed down."""
    legs = ((57.0, 57.7, 60.0), (147.8, 147.8, 150.0), (280.0, 147.8, 150.0))
    return [
        Row("approach", direction=direction, leg_m=leg, goal_m=goal, radius_m=radius,
            ceiling_m=50.0, trouble="hold", figure=before_m)
        for before_m, direction in zip((0.3, 0.7, 1.2, 2.0, 4.0, 8.0), EIGHT, strict=False)
        for leg, goal, radius in legs
    ]  # fmt: skip


def states() -> list[Row]:
    back = [
        Row("way back", direction=direction, leg_m=24.0, goal_m=64.0) for direction in ("E", "NW")
    ]
    return back + [
        Row("hold in", word=word) for word in ("HOVERING", "MOVING", "RETURNING", "LANDING")
    ]


TRICKS = (
    "velocity",
    "position",
    "reposition",
    "stick",
    "guided",
    "parameters",
    "mission",
    "terminate",
)


def hostile() -> list[Row]:
    return [Row("hostile", "bridge", goal_m=20.0, word=trick) for trick in TRICKS]


def cuts() -> list[Row]:
    """The link is cut at so many metres before the fence, at full speed towards it: first with the
    vehicle's settings as delivered, then with the policy's fence on board."""
    cut = [
        Row("cut", direction=direction, leg_m=160.0, goal_m=97.8, radius_m=100.0, ceiling_m=50.0,
            figure=speed, when=before_m)
        for before_m, direction in zip((45.0, 38.0, 60.0, 32.0, 26.0), EIGHT, strict=False)
        for speed in (0.0, 10.0)
        if not speed or before_m > 35.0  # nearer, the gate has slowed it down
    ]  # fmt: skip
    through = replace(cut[1], kind="stranger", direction="S", when=0.0)
    return [*cut[:4], through, *(replace(row, word="put") for row in cut)]


def missions() -> list[Row]:
    figures = (("", 0.0), ("delay", 0.2), ("delay", 0.5), ("loss", 0.25))
    return [Row("mission", trouble=trouble, figure=figure) for trouble, figure in figures]


def ways() -> list[Row]:
    """Each other way to go than a goto: well inside, near the fence, and where it is refused."""
    rows = []
    for number, by in enumerate(("library", "one-shot")):
        for turn, word in enumerate(("move", "forward", "goto-global")):
            direction = EIGHT[(3 * number + turn) % 8]
            for leg, goal in ((30.0, 40.0), (40.0, 57.0), (20.0, 59.5)):
                rows.append(Row("go", by, direction, leg, goal, word=word))
        rows += [
            Row("go", by, "NE", 0.0, 40.0, word="heading", figure=90.0),
            Row("go", by, "NE", 0.0, 40.0, word="heading", figure=-135.0),
            Row("go", by, "W", 40.0, 57.0, word="speed", figure=2.0),
            Row("go", by, "W", 40.0, 50.0, word="speed", figure=40.0, trouble="most"),
            Row("go", by, "S", 20.0, 40.0, word="orbit", figure=10.0),
            Row("go", by, "SE", 15.0, 52.0, word="orbit", figure=-8.0),
            Row("go", by, "N", 30.0, 59.5, word="orbit", figure=10.0),
        ]
    return rows


def amid() -> list[Row]:
    """A goto while something else is under way: at speed, towards the fence."""
    words = ("goto", "move", "heading", "orbit", "parameters", "download", "takeoff", "land", "rtl")
    rows = [Row("amid", leg_m=60.0, goal_m=50.0, word=word, when=3.0) for word in words]
    rows = [
        replace(row, when=0.3) if row.word in ("heading", "parameters", "download") else row
        for row in rows
    ]
    replaced = [replace(row, trouble="replace") for row in rows[:2]]
    return [
        *rows[:2],
        *replaced,
        replace(replaced[0], goal_m=57.0, leg_m=80.0, when=6.0),
        *rows[2:],
    ]


def days() -> list[Row]:
    words = ("log", "parameters", "fences", "preflight")  # the log is of one flight
    return [Row("daily", "one-shot", word=word) for word in words]


def smoke(kind: Kind) -> list[Row]:
    leg, goal = (40.0, 57.8) if kind is PX4 else (58.0, 57.9)
    return [
        Row("takeoff", figure=5.0),
        Row("approach", leg_m=leg, goal_m=goal),
        Row("approach", "bridge", "N", leg_m=20.0, goal_m=55.0),
        Row("landing", word="land"),
    ]


def whole(kind: Kind, seed: int, count: int) -> list[list[Row]]:
    """Groups; each has a fresh vehicle."""
    rng = random.Random(f"{seed} {kind.name}")
    troubles = [
        row
        for trouble in ("kill", "blackout", "delay", "loss", "other-station", "gps")
        for row in approaches(kind, rng, max(2, count // 10), trouble)
    ]
    return [
        known(kind),
        approaches(kind, rng, count),
        ground(),
        [*stops(rng), *held_at_the_end(), *states()],
        troubles,
        [*missions(), *hostile()],
        [Row("plans"), *cuts()],
        ways(),
        amid(),
        days(),
    ]
