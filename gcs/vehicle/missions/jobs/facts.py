"""What the verifier of missions needs to know of the vehicle, asked for and waited for.

Radii of acceptance, the return's height and kind, and the rally points on board: all of them shape
the flown path, other stations may change any of them, and on a bad link each may be lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gcs.gate.airspace.projection import Projection
from gcs.gate.refusal import Code, Refusal
from gcs.plan.item_messages import item_of
from gcs.plan.legs import FlightSettings, LandingPlace
from gcs.plan.model import AutopilotName
from gcs.plan.settings import USUAL
from gcs.plan.wire import WireItem
from gcs.plan.wire_fence import is_above_home
from gcs.protocol.effects import Address, Heard, Send, TransferDone, TransferFailed, Wake
from gcs.protocol.mission import MissionDownload
from gcs.protocol.settings import USUAL_WAITS, Quantity, SettingsReader, Waits
from gcs.protocol.transfers.transfer import Timing
from gcs.session.speedup_waits import Times
from gcs.vehicle.missions.paths import autopilot_name
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt, ParamError, ParamValue

_KM = 1000.0

QUANTITIES: dict[AutopilotName, tuple[Quantity, ...]] = {
    "px4": (
        Quantity("accept_m", "NAV_ACC_RAD"),
        Quantity("return_up_m", "RTL_RETURN_ALT"),
        Quantity("accept_up_m", "NAV_MC_ALT_RAD", needed=False),
        Quantity("first_climb_m", "MIS_TAKEOFF_ALT", needed=False),
        Quantity("return_type", "RTL_TYPE", needed=False),
        Quantity("cone", "RTL_CONE_ANG", needed=False),
        Quantity("cone_within_m", "RTL_MIN_DIST", needed=False),
        Quantity("speed_m_s", "MPC_XY_CRUISE", needed=False),
        Quantity("accel_m_s2", "MPC_ACC_HOR", needed=False),
    ),
    "ardupilot": (
        Quantity("accept_m", "WP_RADIUS_M"),
        Quantity("return_up_m", "RTL_ALT_M"),
        Quantity("speed_m_s", "WP_SPD", needed=False),
        Quantity("accel_m_s2", "WP_ACC", needed=False),
        Quantity("return_climb_m", "RTL_CLIMB_MIN_M", needed=False),
        Quantity("cone", "RTL_CONE_SLOPE", needed=False),
    ),
}
OF_FLIGHT_TIME: dict[AutopilotName, tuple[Quantity, ...]] = {
    "px4": (
        Quantity("take_off_m_s", "MPC_TKO_SPEED", needed=False),
        Quantity("climb_m_s", "MPC_Z_V_AUTO_UP", needed=False),
        Quantity("descend_m_s", "MPC_Z_V_AUTO_DN", needed=False),
        Quantity("land_m_s", "MPC_LAND_SPEED", needed=False),
        Quantity("return_waits_s", "RTL_LAND_DELAY", needed=False),
    ),
    "ardupilot": (
        Quantity("climb_m_s", "WP_SPD_UP", needed=False),
        Quantity("descend_m_s", "WP_SPD_DN", needed=False),
        Quantity("land_m_s", "LAND_SPD_MS", needed=False),
        Quantity("return_waits_ms", "RTL_LOIT_TIME", needed=False),
    ),
}
"""Asked for beside the others where the policy has the time of a flight judged."""
_FLATTEST_SLOPE = 0.5
"""ArduCopter: a smaller RTL_CONE_SLOPE is none."""


@dataclass(frozen=True, slots=True)
class Facts:
    """The vehicle's answers; `return_up_m` is None where it has told none."""

    settings: FlightSettings
    return_up_m: float | None
    rally: tuple[WireItem, ...] = ()


class Learning:
    """Asks the vehicle; over once `facts` or `refusal` is there."""

    def __init__(
        self,
        own: Address,
        telemetry: Telemetry,
        timing: Timing,
        times: Times,
        *,
        flight_time: bool = False,
    ) -> None:
        self._autopilot = autopilot_name(telemetry)
        target = Address(telemetry.sysid, telemetry.compid)
        quantities = QUANTITIES[self._autopilot]
        if flight_time:
            quantities += OF_FLIGHT_TIME[self._autopilot]
        encoding = telemetry.autopilot.param_encoding
        waits = Waits(
            times.real_ns(USUAL_WAITS.again_ns),
            times.real_ns(USUAL_WAITS.give_up_ns),
            times.real_ns(USUAL_WAITS.patience_ns),
        )
        self._reader = SettingsReader(own, target, encoding, quantities, waits)
        self._rally = MissionDownload(own, target, MissionType.RALLY, timing)
        self.facts: Facts | None = None
        self.refusal: Refusal | None = None

    @property
    def deadline_ns(self) -> int | None:
        return self._rally.deadline_ns if self._reader.done else self._reader.deadline_ns

    @property
    def over(self) -> bool:
        return self.facts is not None or self.refusal is not None

    def start(self, now_ns: int) -> list[Send]:
        return self._reader.start(now_ns)

    def handle(self, event: Heard | Wake, now_ns: int) -> list[Send]:
        if not self._reader.done:
            if isinstance(event, Heard) and not isinstance(event.message, ParamValue | ParamError):
                return []
            sends = self._reader.handle(event, now_ns)
            return self._settings_known(now_ns) if self._reader.done else sends
        sends = []
        for effect in self._rally.handle(event, now_ns):
            match effect:
                case Send():
                    sends.append(effect)
                case TransferDone(_, items):
                    self._learnt(items)
                case TransferFailed(_, result, text):
                    self._no_rally_points(result, text)
        return sends

    def _settings_known(self, now_ns: int) -> list[Send]:
        """The radii are needed for any path, the return's height for one that returns."""
        for quantity in self._reader.missing:
            if quantity.name == "accept_m":
                names = " or ".join(each.name for each in quantity.names)
                text = f"the vehicle has not told its acceptance radius ({names})"
                self.refusal = Refusal(Code.NO_ANSWER, text)
                return []
        return [effect for effect in self._rally.start(now_ns) if isinstance(effect, Send)]

    def _no_rally_points(self, result: int | None, text: str) -> None:
        if result is not None:
            self._learnt(())  # it keeps none
            return
        sentence = f"the rally points on board could not be read: {text}"
        self.refusal = Refusal(Code.NO_ANSWER, sentence)

    def _learnt(self, items: tuple[MissionItemInt, ...]) -> None:
        values = self._reader.values
        usual = USUAL[self._autopilot]
        climb_m_s = self._positive("climb_m_s", usual.climb_m_s)
        settings = replace(
            usual,
            accept_m=values["accept_m"],
            first_climb_m=values.get("first_climb_m", usual.first_climb_m),
            return_low_within_m=self._low_within_m(usual),
            return_type=int(values.get("return_type", usual.return_type)),
            speed_m_s=self._positive("speed_m_s", usual.speed_m_s),
            accel_m_s2=self._positive("accel_m_s2", usual.accel_m_s2),
            return_climb_m=values.get("return_climb_m", usual.return_climb_m),
            accept_up_m=values.get("accept_up_m", usual.accept_up_m),
            climb_m_s=min(climb_m_s, self._positive("take_off_m_s", climb_m_s)),
            descend_m_s=self._positive("descend_m_s", usual.descend_m_s),
            land_m_s=self._positive("land_m_s", usual.land_m_s),
            return_waits_s=self._return_waits_s(usual),
        )
        rally = tuple(item_of(item) for item in items)
        self.facts = Facts(settings, values.get("return_up_m"), rally)

    def _positive(self, name: str, usual: float) -> float:
        """What a vehicle cannot fly with (zero, less, not a number) is not believed."""
        value = self._reader.values.get(name, usual)
        return value if value > 0.0 else usual

    def _return_waits_s(self, usual: FlightSettings) -> float:
        """RTL_LAND_DELAY is in seconds, and less than zero where a return does not land;
        RTL_LOIT_TIME is in milliseconds."""
        values = self._reader.values
        if self._autopilot == "px4":
            waits_s = values.get("return_waits_s", usual.return_waits_s)
        else:
            waits_s = values.get("return_waits_ms", 1e3 * usual.return_waits_s) / 1e3
        return waits_s if waits_s >= 0.0 else math.inf

    def _low_within_m(self, usual: FlightSettings) -> float:
        """PX4 returns lower within RTL_MIN_DIST, ArduCopter within its cone."""
        values = self._reader.values
        cone = values.get("cone")
        if cone is None:
            return usual.return_low_within_m
        if self._autopilot == "px4":
            within_m = values.get("cone_within_m", usual.return_low_within_m)
            return within_m if cone > 0.0 else 0.0
        return values.get("return_up_m", 0.0) / cone if cone >= _FLATTEST_SLOPE else 0.0


def landings_on_board(
    items: tuple[WireItem, ...], telemetry: Telemetry, name: str = "rally point"
) -> tuple[LandingPlace, ...]:
    """Rally points as the vehicle holds them, in its local frame."""
    if telemetry.origin is None or telemetry.home_ned is None:
        return ()
    projection = Projection(telemetry.origin, telemetry.autopilot.name)
    home_down_m = telemetry.home_ned[2]
    home_alt_amsl_m = telemetry.origin.alt_amsl_m - home_down_m
    found = []
    for number, item in enumerate(items, start=1):
        north_m, east_m = projection.north_east(item.x * 1e-7, item.y * 1e-7)
        relative = is_above_home(item, home_alt_amsl_m)
        down_m = home_down_m - item.z if relative else telemetry.origin.alt_amsl_m - item.z
        title = f"{name} {number}"
        if autopilot_name(telemetry) == "px4":
            found.append(LandingPlace(title, (north_m, east_m, down_m)))
        else:
            ground_ned = (north_m, east_m, home_down_m)
            found.append(LandingPlace(title, ground_ned, home_down_m - down_m))
    return tuple(found)
