"""A vehicle's settings under whichever name it has them, on a link that loses some."""

from __future__ import annotations

from gcs.protocol.autopilot import ParamEncoding
from gcs.protocol.effects import Address, Heard, Send, Wake
from gcs.protocol.settings import USUAL_WAITS, Quantity, SettingsReader
from gcs.wire.messages import Message, ParamError, ParamRequestRead, ParamValue

OWN, VEHICLE = Address(255, 190), Address(1, 1)
RADIUS = Quantity("radius", "WP_RADIUS_M")
HEIGHT = Quantity("height", "RTL_ALT_M")
SLOPE = Quantity("slope", "RTL_CONE_SLOPE", needed=False)
REAL32 = 9


class Script:
    """A reader of three quantities, and the names that it asked for in each round."""

    def __init__(self) -> None:
        quantities = (RADIUS, HEIGHT, SLOPE)
        self.reader = SettingsReader(OWN, VEHICLE, ParamEncoding.CAST, quantities)
        self.now_ns = 0
        self.rounds: list[list[str]] = []
        self._keep(self.reader.start(0))

    def _keep(self, sends: list[Send]) -> None:
        names = [s.message.param_id for s in sends if isinstance(s.message, ParamRequestRead)]
        if names:
            self.rounds.append(names)

    def hear(self, message: Message, sysid: int = 1) -> None:
        self._keep(self.reader.handle(Heard(sysid, 1, message), self.now_ns))

    def has(self, name: str, value: float, sysid: int = 1) -> None:
        self.hear(ParamValue(value, 1, 0, name, REAL32), sysid)

    def denies(self, name: str) -> None:
        self.hear(ParamError(-1, OWN.sysid, OWN.compid, name, 1))

    def wait(self, ns: int) -> None:
        self.now_ns += ns
        self._keep(self.reader.handle(Wake(), self.now_ns))


def test_all_names_are_asked_for_at_once_and_either_settles_a_quantity() -> None:
    script = Script()
    assert script.rounds == [
        ["WP_RADIUS_M", "WPNAV_RADIUS", "RTL_ALT_M", "RTL_ALT", "RTL_CONE_SLOPE"]
    ]
    script.has("WPNAV_RADIUS", 200.0)
    script.has("RTL_ALT_M", 15.0)
    script.has("RTL_CONE_SLOPE", 3.0)
    assert script.reader.done
    assert script.reader.values == {"radius": 2.0, "height": 15.0, "slope": 3.0}


def test_what_was_lost_is_asked_for_again_and_nothing_else() -> None:
    script = Script()
    script.has("WP_RADIUS_M", 2.0)
    script.denies("RTL_ALT")
    script.wait(USUAL_WAITS.again_ns - 1)
    assert len(script.rounds) == 1
    script.wait(1)
    assert script.rounds[1] == ["RTL_ALT_M", "RTL_CONE_SLOPE"]
    script.has("RTL_ALT_M", 30.0)
    script.denies("RTL_CONE_SLOPE")
    assert script.reader.done
    assert script.reader.missing == ()


def test_what_is_not_needed_is_not_waited_for_as_long() -> None:
    script = Script()
    script.has("WP_RADIUS_M", 2.0)
    script.has("RTL_ALT_M", 15.0)
    while not script.reader.done:
        script.wait(USUAL_WAITS.again_ns)
    assert script.now_ns == USUAL_WAITS.patience_ns
    assert script.reader.missing == ()


def test_a_quantity_that_every_name_is_denied_of_is_missing_and_not_waited_for() -> None:
    script = Script()
    for name in ("WPNAV_RADIUS", "WP_RADIUS_M", "RTL_ALT", "RTL_ALT_M", "RTL_CONE_SLOPE"):
        script.denies(name)
    assert script.reader.done
    assert script.reader.missing == (RADIUS, HEIGHT)


def test_silence_is_given_up_and_another_vehicle_is_not_heard() -> None:
    script = Script()
    script.has("WP_RADIUS_M", 9.0, sysid=2)
    while not script.reader.done:
        script.wait(USUAL_WAITS.again_ns)
    assert script.now_ns == USUAL_WAITS.give_up_ns
    assert script.reader.values == {}
    script.has("WP_RADIUS_M", 2.0)
    assert script.reader.deadline_ns is None


def test_what_is_silent_and_what_is_absent_are_told_apart() -> None:
    script = Script()
    script.has("WP_RADIUS_M", 2.0)
    for name in ("RTL_ALT", "RTL_ALT_M"):
        script.denies(name)
    assert (script.reader.silent, script.reader.absent) == ((SLOPE,), (HEIGHT,))
    script.denies("RTL_CONE_SLOPE")
    assert (script.reader.silent, script.reader.absent) == ((), (HEIGHT, SLOPE))


def test_a_denial_to_another_station_is_none_to_us() -> None:
    script = Script()
    script.hear(ParamError(-1, 254, OWN.compid, "RTL_CONE_SLOPE", 1))
    assert script.reader.absent == ()
    script.wait(USUAL_WAITS.again_ns)
    assert "RTL_CONE_SLOPE" in script.rounds[1]


def test_a_value_of_a_type_that_does_not_exist_is_none() -> None:
    script = Script()
    script.hear(ParamValue(15.0, 1, 0, "RTL_ALT_M", 99))
    assert script.reader.values == {}


def test_nothing_is_known_at_once_where_nothing_is_asked_for() -> None:
    reader = SettingsReader(OWN, VEHICLE, ParamEncoding.CAST, ())
    assert (reader.start(0), reader.done, reader.deadline_ns) == ([], True, None)
