"""A policy file's text -> `Policy`: its keys over those of `default.toml`, then checked whole."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple, TypeAlias

from msgspec import Struct

from gcs import toml
from gcs.gate.condition import Severity
from gcs.gate.policy.policy import BridgeRules, Policy
from gcs.gate.policy.zonespec import KINDS, Text, ZoneSpec, home_fault, room_fault, zone_fault
from gcs.toml_lines import KeyPath

Table: TypeAlias = dict[str, object]

_PARAMETER = re.compile(r"[A-Z0-9_*]{1,16}")
_UNPRINTABLE = frozenset({"Cc", "Cf", "Zl", "Zp"})
"""Unicode's categories: control, format (of the direction of writing), new lines."""
_BOUNDS = ("floor_up_m", "ceiling_up_m")
NAME_HINT = "a refusal names its zone: give each a name of its own"
FENCE_FILE_HINT = "the path of a plan, from the folder of this file"

FenceFile: TypeAlias = Callable[[str], tuple[ZoneSpec, ...]]
"""The zones of the fence file of that name, as the policy writes it."""


class NameFault(NamedTuple):
    """What is wrong with a name in one of the lists of `[bridge]`: the list's key, which entry
    from 0, what, and what to do."""

    key: str
    entry: int
    what: str
    hint: str = ""


CheckNames: TypeAlias = Callable[[BridgeRules], NameFault | None]
"""Whether the names in `[bridge]` are those of messages, commands and modes."""


class _FileSpec(Struct, frozen=True, forbid_unknown_fields=True, tag_field="kind", tag="file"):
    """A `[[fence]]` table that stands for all zones of a plan file."""

    path: Text
    name: Text | None = None


class _Written(NamedTuple):
    """A zone, and where it is from: its table, or the key that names its file."""

    at: KeyPath
    zone: ZoneSpec
    file: str = ""


def parse_policy(
    text: str,
    file: str,
    fence_file: FenceFile | None = None,
    check_names: CheckNames | None = None,
) -> Policy:
    """`file` is what errors call it; `fence_file` reads the plan files that the fence names,
    `check_names` knows the dialect, which this package does not.

    Raises TomlError for unknown keys, wrong types, impossible values, contradictions, and for a
    fence file where there is no `fence_file`; lets through what `fence_file` raises.
    """
    return _build(toml.read(text, file), _DEFAULTS, fence_file, check_names)


def _build(
    doc: toml.Document,
    defaults: Table,
    fence_file: FenceFile | None,
    check_names: CheckNames | None,
) -> Policy:
    table = _overlay(doc, defaults, doc.data)
    table["arrival"] = _without_none(table["arrival"], "speed_m_s", "yaw_deg")
    table["battery"] = _without_none(table["battery"], "low_v", "critical_v", "endurance_s")
    table["severities"] = _severities(doc, table["severities"])
    zones = _read_fence(doc, table["fence"], fence_file)
    policy = _convert(doc, {**table, "fence": [written.zone for written in zones]})
    _check_limits(doc, policy)
    _check_bridge(doc, policy.bridge, check_names)
    _check_stream(doc, policy)
    _check_slack(doc, policy)
    _check_zones(doc, policy, zones)
    _check_printable(doc, policy, zones)
    return policy


def _overlay(doc: toml.Document, defaults: Table, own: Table, at: KeyPath = ()) -> Table:
    """`defaults` with the values of `own` in their place, table by table; arrays are replaced."""
    merged = dict(defaults)
    for key, value in own.items():
        if key not in defaults:
            raise doc.unknown((*at, key), defaults)
        default = defaults[key]
        if isinstance(default, dict) and isinstance(value, dict):
            value = _overlay(doc, default, value, (*at, key))
        merged[key] = value
    return merged


_MAY_BE_NONE: Final = frozenset(
    {
        "arrival.speed_m_s",
        "arrival.yaw_deg",
        "battery.low_v",
        "battery.critical_v",
        "battery.endurance_s",
    }
)


def _convert(doc: toml.Document, table: Table) -> Policy:
    """Raises TomlError; where "none" is a value, its hint says so."""
    try:
        return doc.convert(Policy, table)
    except toml.TomlError as error:
        if error.key not in _MAY_BE_NONE:
            raise
        hint = f'{error.hint or "a number"}, or "none"'
        raise toml.TomlError(error.file, error.line, error.key, error.what, hint) from None


def _without_none(value: object, *keys: str) -> object:
    """The table with None for the word "none", which TOML writes for it."""
    if not isinstance(value, dict):
        return value
    return {k: None if k in keys and v == "none" else v for k, v in value.items()}


def _severities(doc: toml.Document, value: object) -> object:
    if not isinstance(value, dict):
        return value
    words = {severity.name.lower(): severity for severity in Severity}
    for name, word in value.items():
        if not (isinstance(word, str) and word in words):
            raise doc.error(("severities", name), *toml.none_of(word, words))
    return {name: words[word] for name, word in value.items()}


# ------------------------------------------------------------------------------- the fence


def _read_fence(doc: toml.Document, value: object, fence_file: FenceFile | None) -> list[_Written]:
    if not isinstance(value, list) or not all(isinstance(table, dict) for table in value):
        raise doc.error(("fence",), "is a list of tables", "write each as [[fence]]")
    zones: list[_Written] = []
    names: list[str] = []
    for number, table in enumerate(value):
        at = ("fence", number)
        if table.get("kind") == "file":
            named = doc.convert(_FileSpec, table, at)
            zones += _read_file(doc, named.path, (*at, "path"), fence_file)
            names.append(named.name or named.path)
        else:
            zone = _read_zone(doc, table, at)
            zones.append(_Written(at, zone))
            names.append(zone.name)
    for number, name in enumerate(names):
        if names.count(name) > 1:
            raise doc.error(("fence", number, "name"), f'two zones are called "{name}"', NAME_HINT)
    return zones


def _read_file(
    doc: toml.Document, path: str, at: KeyPath, fence_file: FenceFile | None
) -> list[_Written]:
    if fence_file is None:
        raise doc.error(at, "a fence file cannot be read here")
    try:
        zones = fence_file(path)
    except OSError as error:
        raise doc.error(at, f"{error.filename}: {error.strerror}", FENCE_FILE_HINT) from error
    for zone in zones:
        if fault := zone_fault(zone):
            what = f"zone '{zone.name}' of {path}: {fault.key}: {fault.what}"
            raise doc.error(at, what, fault.hint)
    return [_Written(at, zone, path) for zone in zones]


def _read_zone(doc: toml.Document, table: Table, at: KeyPath) -> ZoneSpec:
    kind = table.get("kind", "circle")
    spec = KINDS.get(kind) if isinstance(kind, str) else None
    if spec is None:
        raise doc.error((*at, "kind"), *toml.none_of(kind, (*KINDS, "file")))
    if table.get("frame") == "geographic":
        if kind == "box":
            raise doc.error((*at, "frame"), "a box is in metres", "write a polygon")
        if kind == "circle" and "centre" not in table:
            hint = "centre = [latitude, longitude]"
            raise doc.error((*at, "centre"), "is missing", hint)
    zone = doc.convert(spec, _without_none({**table, "kind": kind}, *_BOUNDS), at)
    if fault := zone_fault(zone):
        raise doc.error((*at, fault.key), fault.what, fault.hint)
    return zone


# --------------------------------------------------------------------------- contradictions


def _check_limits(doc: toml.Document, p: Policy) -> None:
    if p.min_up_m >= p.max_up_m:
        what = f"{p.max_up_m:g} is not above min_up_m of {p.min_up_m:g}"
        raise doc.error(("max_up_m",), what)
    if doc.has(("takeoff", "max_up_m")) and p.takeoff.max_up_m > p.max_up_m:
        what = f"{p.takeoff.max_up_m:g} is above the policy's max_up_m of {p.max_up_m:g}"
        raise doc.error(("takeoff", "max_up_m"), what)
    arrival = p.arrival
    if doc.has(("arrival", "max_radius_m")) and arrival.max_radius_m < arrival.radius_m:
        what = f"{arrival.max_radius_m:g} is less than radius_m of {arrival.radius_m:g}"
        hint = f"max_radius_m = {arrival.radius_m:g} leaves the radius as it is"
        raise doc.error(("arrival", "max_radius_m"), what, hint)
    battery = p.battery
    if battery.critical_pct > battery.low_pct:
        what = f"{battery.critical_pct:g} is above low_pct of {battery.low_pct:g}"
        raise doc.error(("battery", "critical_pct"), what)
    if battery.low_v is not None and (battery.critical_v or 0.0) > battery.low_v:
        what = f"{battery.critical_v:g} is above low_v of {battery.low_v:g}"
        raise doc.error(("battery", "critical_v"), what)
    if p.control.timeout_s <= p.control.stream_s:
        what = "is over before the stream has even begun to count"
        raise doc.error(("control", "timeout_s"), what)


def _check_bridge(doc: toml.Document, rules: BridgeRules, check_names: CheckNames | None) -> None:
    for key in ("parameters_allowed", "parameters_guarded"):
        for number, name in enumerate(getattr(rules, key)):
            if not _PARAMETER.fullmatch(name):
                hint = "up to 16 capital letters, digits and _; * stands for any letters"
                raise doc.error(("bridge", key, number), f'"{name}" names no parameter', hint)
    _check_parameters(doc, rules)
    for number, name in enumerate(rules.extra_harmless):
        if name in rules.extra_denied:
            what = f'"{name}" is in extra_denied, too'
            raise doc.error(("bridge", "extra_harmless", number), what)
    if doc.has(("bridge", "message_hz")) and rules.message_hz > rules.messages_hz:
        what = f"{rules.message_hz:g} is more than messages_hz of {rules.messages_hz:g}"
        hint = "messages_hz is what all messages together may have"
        raise doc.error(("bridge", "message_hz"), what, hint)
    fault = None if check_names is None else check_names(rules)
    if fault is not None:
        raise doc.error(("bridge", fault.key, fault.entry), fault.what, fault.hint)


def _check_parameters(doc: toml.Document, rules: BridgeRules) -> None:
    """Names beside a choice with which they mean nothing, and names that take back the choice."""
    does = {"refuse": "refuses them all", "forward": "forwards them all"}.get(rules.parameters)
    for key, names in (
        ("parameters_guarded", rules.parameters_guarded if does else ()),
        ("parameters_allowed", rules.parameters_allowed if rules.parameters == "forward" else ()),
    ):
        if names:
            what = f'means nothing beside parameters = "{rules.parameters}", which {does}'
            raise doc.error(("bridge", key), what, 'leave it out, or write parameters = "guard"')
    for number, name in enumerate(rules.parameters_allowed):
        at = ("bridge", "parameters_allowed", number)
        if name in rules.parameters_guarded:
            raise doc.error(at, f'"{name}" is in parameters_guarded, too')
        if rules.parameters == "refuse" and not name.strip("*"):
            what = f'"{name}" allows every parameter, which parameters = "refuse" refuses'
            raise doc.error(at, what, 'name some of them, or write parameters = "forward"')


def _check_stream(doc: toml.Document, p: Policy) -> None:
    """A sample counts no longer than the stream, no position is older than the policy's, and no
    stick asks for more than a stream may."""
    if p.stream.ends_after_s < p.stream.deadman_s:
        what = f"{p.stream.ends_after_s:g} is less than deadman_s of {p.stream.deadman_s:g}"
        raise doc.error(("stream", "ends_after_s"), what)
    if doc.has(("stream", "position_age_s")) and p.stream.position_age_s > p.position_age_s:
        what = f"{p.stream.position_age_s:g} is more than position_age_s of {p.position_age_s:g}"
        raise doc.error(("stream", "position_age_s"), what)
    for key in ("speed_h_m_s", "speed_up_m_s", "speed_down_m_s", "yaw_rate_deg_s"):
        full, most = getattr(p.stream, f"stick_{key}"), getattr(p.stream, f"max_{key}")
        if doc.has(("stream", f"stick_{key}")) and full > most:
            what = f"{full:g} is more than max_{key} of {most:g}"
            raise doc.error(("stream", f"stick_{key}"), what)
    # While it is held for refused samples the vehicle must have come out of its lean.
    if p.stream.tilt_deg > 0.0 and p.stream.good_again_s < p.stream.attitude_settle_s:
        what = f"attitude_settle_s of {p.stream.attitude_settle_s:g} is more than good_again_s of"
        raise doc.error(("stream", "tilt_deg"), f"{what} {p.stream.good_again_s:g}")


def _check_slack(doc: toml.Document, p: Policy) -> None:
    """A slack beyond the margin lets the vehicle out of the fence before the gate brakes."""
    if p.allow_stop_outside:
        return
    for slack_key, slack_m, margin_key, margin_m in (
        ("brake_slack_h_m", p.brake_slack_h_m, "margin_h_m", p.margin_h_m),
        ("brake_slack_v_m", p.brake_slack_v_m, "margin_v_m", p.margin_v_m),
    ):
        if slack_m <= margin_m:
            continue
        key, what = margin_key, f"{margin_m:g} is less than {slack_key} of {slack_m:g}"
        if not doc.has((margin_key,)):
            key, what = slack_key, f"{slack_m:g} is more than {margin_key} of {margin_m:g}"
        raise doc.error(
            (key,),
            f"{what}: the vehicle could leave the fence before the gate brakes",
            f"{slack_key} = {margin_m:g} keeps it inside; `allow_stop_outside = true` accepts this",
        )


def _check_zones(doc: toml.Document, p: Policy, zones: list[_Written]) -> None:
    for at, zone, file in zones:
        fault = room_fault(zone, p.margin_h_m, p.margin_v_m) or home_fault(zone)
        if fault is None:
            continue
        if not doc.has(("fence",)):
            key = "margin_v_m" if fault.key in _BOUNDS else "margin_h_m"
            hint = f"the default fence has {fault.key} = {getattr(zone, fault.key):g}"
            raise doc.error((key,), fault.what, hint)
        if file:
            what = f"zone '{zone.name}' of {file}: {fault.key}: {fault.what}"
            raise doc.error(at, what, fault.hint)
        raise doc.error((*at, fault.key), fault.what, fault.hint)
    if not any(written.zone.inclusion for written in zones):
        files = sorted({written.file for written in zones if written.file})
        hint = "the gate must know where the vehicle may be"
        if files:
            hint = f"{', '.join(files)} only says where it may not be: {hint}"
        raise doc.error(("fence",), "has no inclusion zone", hint)


def _check_printable(doc: toml.Document, p: Policy, zones: list[_Written]) -> None:
    """Names are shown on terminals, which obey what they cannot print."""
    names: list[tuple[KeyPath, str]] = [(("name",), p.name)]
    for at, zone, file in zones:
        names.append((at if file else (*at, "name"), zone.name))
    for at, name in names:
        odd = sorted({f"U+{ord(c):04X}" for c in name if unicodedata.category(c) in _UNPRINTABLE})
        if odd:
            what = f"has characters that cannot be printed ({', '.join(odd)})"
            raise doc.error(at, what, "write letters, digits, signs and spaces")


# -------------------------------------------------------------------------------- defaults

_FILE = Path(__file__).with_name("default.toml")
_DOCUMENT = toml.read(_FILE.read_text(encoding="utf-8"), str(_FILE))
_DEFAULTS: Final = _DOCUMENT.data

DEFAULT: Final = _build(_DOCUMENT, _DEFAULTS, None, None)
"""The policy of `default.toml`, which is also that of an empty file."""
