"""QGroundControl's .plan: JSON -> Plan.

The format is QGroundControl's "Plan File Format" (docs.qgroundcontrol.com): top level version 1,
mission version 2, geoFence version 2, rallyPoints version 1 or 2.  Home is not an item.
"""

from __future__ import annotations

from gcs.plan.build import item_from_numbers
from gcs.plan.errors import Finding, Level, PlanError
from gcs.plan.formats.json_cursor import Node, parse
from gcs.plan.model import (
    AutopilotName,
    BreachReturn,
    Circle,
    Fence,
    Geodetic,
    Item,
    LatLon,
    Plan,
    Polygon,
    RallyPoint,
    Zone,
    open_ring,
)
from gcs.steps import Steps
from gcs.wire.ids import MavType

FIRMWARES: dict[int, AutopilotName] = {12: "px4", 3: "ardupilot"}
_ANY_FIRMWARE = 0
_MULTIROTORS = frozenset(
    {
        MavType.GENERIC,
        MavType.QUADROTOR,
        MavType.COAXIAL,
        MavType.HELICOPTER,
        MavType.HEXAROTOR,
        MavType.OCTOROTOR,
        MavType.TRICOPTER,
        MavType.DODECAROTOR,
    }
)
_TRANSECTS: dict[str, tuple[int, ...]] = {"survey": (4, 5), "CorridorScan": (2,)}
_PARAM_COUNT = 7
ITEMS_A_STEP = 50

_MIN_CORNERS = 3
_RADIUS_MAX_M = 1.0e6


def read_plan(file: str, data: bytes, name: str) -> Steps[Plan]:
    """Raises PlanError with the JSON path."""
    yield
    top = parse(file, data)
    kind = top.get("fileType", hint="is this a QGroundControl .plan?")
    if kind.text() != "Plan":
        raise kind.error(f'is "{kind.text()}"', '"Plan"', "only plan files hold a mission")
    top.version(1)
    notes: list[Finding] = []
    fence_node, rally_node = top.find("geoFence"), top.find("rallyPoints")
    fence = read_fence(fence_node, notes) if fence_node else Fence()
    rally = _read_rally(rally_node) if rally_node else ()
    mission = top.find("mission")
    if mission is None:
        notes.append(Finding(Level.WARNING, "mission", "mission", "there is none in this file"))
        return Plan(name, None, None, (), fence, rally, source=file, notes=tuple(notes))
    mission.version(2, hint="save the plan again with a present QGroundControl")
    firmware = _read_firmware(mission, notes)
    home = _read_home(mission, notes)
    items = yield from _read_items(mission.get("items"))
    cruise, hover = mission.find("cruiseSpeed"), mission.find("hoverSpeed")
    return Plan(
        name,
        firmware,
        home,
        items,
        fence,
        rally,
        cruise.number(0.0, 1000.0) if cruise else None,
        hover.number(0.0, 1000.0) if hover else None,
        source=file,
        notes=tuple(notes),
    )


def _read_firmware(mission: Node, notes: list[Finding]) -> AutopilotName | None:
    vehicle = mission.find("vehicleType")
    if vehicle is not None and vehicle.integer() not in _MULTIROTORS:
        number = vehicle.integer()
        kind = MavType(number).name if number in list(MavType) else f"MAV_TYPE {number}"
        what = f"the plan was made for {kind}, not for a multirotor"
        notes.append(Finding(Level.WARNING, vehicle.path, "vehicleType", what))
    node = mission.find("firmwareType")
    if node is None:
        return None
    firmware = FIRMWARES.get(node.integer())
    if firmware is None and node.integer() != _ANY_FIRMWARE:
        what = f"{node.integer()} is neither PX4 (12) nor ArduPilot (3)"
        notes.append(Finding(Level.WARNING, node.path, "firmwareType", what))
    return firmware


def _read_home(mission: Node, notes: list[Finding]) -> Geodetic | None:
    node = mission.get("plannedHomePosition")
    lat, lon, alt = node.items(3)
    lat_deg, lon_deg = lat.number(-90.0, 90.0), lon.number(-180.0, 180.0)
    if lat_deg == 0.0 and lon_deg == 0.0:
        what = "0, 0 is taken as: no home was planned"
        notes.append(Finding(Level.WARNING, node.path, "plannedHomePosition", what))
        return None
    return Geodetic(lat_deg, lon_deg, None if alt.is_null else alt.number(-1000.0, 100_000.0))


def _read_rally(node: Node) -> tuple[RallyPoint, ...]:
    node.version(1, 2)
    points = []
    for point in node.get("points").items():
        lat, lon, alt = point.items(3)
        where = read_lat_lon(lat, lon)
        points.append(RallyPoint(*where, alt.number(-1000.0, 100_000.0), point.path))
    return tuple(points)


def _read_items(node: Node) -> Steps[tuple[Item, ...]]:
    items: list[Item] = []
    for number, entry in enumerate(node.items()):
        if number % ITEMS_A_STEP == 0:
            yield
        kind = entry.get("type")
        match kind.text():
            case "SimpleItem":
                items.append(_read_simple(entry))
            case "ComplexItem":
                items.extend(_read_complex(entry))
            case other:
                raise kind.error(f'is "{other}"', '"SimpleItem" or "ComplexItem"')
    seen: dict[int, str] = {}
    for item in items:
        if item.do_jump_id in seen:
            raise PlanError(
                node.file,
                f"{item.where}.doJumpId",
                "doJumpId",
                f"{item.do_jump_id} is also that of {seen[item.do_jump_id]}",
                "every item its own",
            )
        seen[item.do_jump_id] = item.where
    return tuple(items)


def _read_simple(entry: Node) -> Item:
    numbers = [n.number_or_unset() for n in entry.get("params").items(_PARAM_COUNT)]
    autocontinue = entry.find("autoContinue")
    return item_from_numbers(
        entry.file,
        entry.path,
        entry.get("command").integer(0, 65535),
        entry.get("frame").integer(0, 255),
        numbers,
        entry.get("doJumpId").integer(1, 65535),
        autocontinue.boolean() if autocontinue else True,
    )


def _read_complex(entry: Node) -> list[Item]:
    """The flattened items of a survey or a corridor; what was not flattened is not guessed."""
    kind_node = entry.get("complexItemType")
    kind = kind_node.text()
    if kind == "StructureScan":
        raise kind_node.error(
            "a structure scan is saved as a polygon, without the items that would be flown",
            hint="upload it from QGroundControl and download the flat mission into a file",
        )
    if kind not in _TRANSECTS:
        told = ", ".join(f'"{name}"' for name in _TRANSECTS)
        raise kind_node.error(f'is "{kind}", which a multirotor does not fly from a file', told)
    entry.version(*_TRANSECTS[kind], hint="save the plan again with a present QGroundControl")
    style = entry.get("TransectStyleComplexItem")
    style.version(1, 2)
    flattened = style.get(
        "Items",
        hint=f"only the polygon of the {kind} is here, and its path is not guessed: open the "
        "plan in QGroundControl, let it compute the transects, and save again",
    )
    flat = flattened.items()
    if not flat:
        raise flattened.error("is empty", f"the flattened items of the {kind}")
    return [_read_simple(item) for item in flat]


def read_fence(node: Node, notes: list[Finding]) -> Fence:
    """`inclusion: false` is an exclusion zone.  Raises PlanError with the JSON path.

    A fence of version 1 or lower is an error, as other programs drop it silently; an empty one
    has nothing to drop and goes into `notes`.
    """
    if node.get("version").integer(0, 1000) < 2:
        corners = node.find("polygon")
        if corners is not None and corners.items():
            raise node.get("version").error(
                "the fence is of an old version, which is ignored elsewhere",
                "2",
                "open the plan in QGroundControl, check the fence, and save again",
            )
        what = "an empty fence of an old version: there is no fence in this file"
        notes.append(Finding(Level.WARNING, node.path, "geoFence", what))
        return Fence()
    node.version(2)
    polygons, circles = node.find("polygons"), node.find("circles")
    zones = [
        *(_read_polygon(entry) for entry in (polygons.items() if polygons else [])),
        *(_read_circle(entry) for entry in (circles.items() if circles else [])),
    ]
    breach = node.find("breachReturn")
    if breach is None:
        return Fence(tuple(zones))
    lat, lon, alt = breach.items(3)
    return Fence(
        tuple(zones),
        BreachReturn(*read_lat_lon(lat, lon), alt.number(-1000.0, 100_000.0)),
    )


def read_lat_lon(lat: Node, lon: Node) -> LatLon:
    return LatLon(lat.number(-90.0, 90.0), lon.number(-180.0, 180.0))


def _read_polygon(entry: Node) -> Zone:
    entry.version(1)
    node = entry.get("polygon")
    corners = tuple(read_lat_lon(*corner.items(2)) for corner in node.items())
    if len(corners) < _MIN_CORNERS:
        raise node.error(f"has {len(corners)} corners", f"at least {_MIN_CORNERS}")
    return _zone(Polygon(open_ring(corners)), entry)


def _read_circle(entry: Node) -> Zone:
    entry.version(1)
    circle = entry.get("circle")
    centre = read_lat_lon(*circle.get("center").items(2))
    radius = circle.get("radius")
    radius_m = radius.number(0.0, _RADIUS_MAX_M)
    if radius_m == 0.0:
        raise radius.error("is 0", "a radius in metres")
    return _zone(Circle(centre, radius_m), entry)


def _zone(shape: Polygon | Circle, entry: Node) -> Zone:
    return Zone(shape, entry.get("inclusion").boolean(), name=entry.path, where=entry.path)
