"""The report for programs: what `gcs log report --json` prints."""

from __future__ import annotations

import msgspec

from gcs.flight_report.findings.finding import Check, Finding
from gcs.flight_report.flight import Flight, Totals, VehicleFlight
from gcs.flight_report.number_format import utc
from gcs.flight_report.summary import (
    main_trouble,
    vehicle_name,
    what_all_did,
    what_went_wrong,
)


class VehicleReport(msgspec.Struct):
    sysid: int
    name: str
    autopilot: str
    totals: Totals
    path_m: float
    requests: int
    refused: int
    what_went_wrong: str
    main_trouble: Finding | None
    findings: list[Finding]
    checks: list[Check]


class ReportJson(msgspec.Struct):
    """Times are seconds since the first message."""

    file: str
    size_bytes: int
    closed: bool
    damaged: int
    unread_bytes: int
    started: str
    seconds: float
    messages: int
    what_happened: str
    vehicles: list[VehicleReport]


def report_json(flight: Flight) -> bytes:
    """One JSON object.  NaN and infinity become null."""
    main = flight.main_vehicle()
    vehicles = sorted(flight.vehicles.values(), key=lambda v: (v is not main, v.sysid))
    report = ReportJson(
        # JSON has no text but UTF-8; a file's name may be other.
        flight.name.encode(errors="backslashreplace").decode(),
        flight.size,
        flight.closed,
        flight.damaged,
        flight.unread_bytes,
        utc(flight.start_ns),
        flight.seconds,
        flight.messages,
        what_all_did(flight),
        [_vehicle(flight, vehicle) for vehicle in vehicles],
    )
    return msgspec.json.encode(report)


def _vehicle(flight: Flight, vehicle: VehicleFlight) -> VehicleReport:
    return VehicleReport(
        vehicle.sysid,
        vehicle_name(vehicle),
        vehicle.autopilot,
        vehicle.totals,
        vehicle.track.length_m,
        len(vehicle.requests) + vehicle.requests_left_out,
        sum(request.outcome == "refused" for request in vehicle.requests),
        what_went_wrong(flight, vehicle),
        main_trouble(vehicle),
        vehicle.findings,
        vehicle.checks,
    )
