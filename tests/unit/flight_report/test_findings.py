"""The findings, against the limits of the documents that they name and recorded figures."""

from __future__ import annotations

import pytest

from gcs.flight_report.facts import (
    Battery,
    Cells,
    Decision,
    Estimator,
    Fact,
    Gps,
    LogLine,
    Machine,
    Pose,
    Status,
    Text,
    Vibration,
)
from gcs.flight_report.findings.battery import BatteryDetector
from gcs.flight_report.findings.estimator import AttitudeDetector, EstimatorDetector
from gcs.flight_report.findings.failsafes import FailsafeDetector
from gcs.flight_report.findings.finding import Level, Situation
from gcs.flight_report.findings.gate import GateDetector
from gcs.flight_report.findings.gps import GpsDetector
from gcs.flight_report.findings.limits import (
    BATTERY_LEFT,
    DILUTION,
    RATIOS,
    SATELLITES,
    TILT,
    VIBRATION,
    VOLTAGE,
    Row,
)
from gcs.flight_report.findings.link import LinkDetector
from gcs.flight_report.findings.vibration import VibrationDetector
from gcs.report import ConditionItem
from tests.unit.flight_report.facts_in_time import check, flying, found, levels

UNDISTURBED = Status(True, "OFFBOARD", "IN_AIR", 230.0, 0.0)


class TestVibration:
    """ArduPilot wiki, Measuring Vibration: below 30 m/s² acceptable, above 60 nearly always bad."""

    @pytest.mark.parametrize(
        ("worst", "level"),
        [(29.9, Level.OK), (30.1, Level.WARNING), (59.9, Level.WARNING), (60.1, Level.CRITICAL)],
    )
    def test_limits_of_ardupilot_hold_for_the_worst_axis(self, worst: float, level: Level) -> None:
        facts = [(1.0, Vibration(5.0, worst, 3.0, 0)), (2.0, Vibration(1.0, 1.0, 1.0, 0))]
        result = found(VibrationDetector(), facts, flying("ardupilot"))
        assert check(result, "Vibration").level is level
        assert levels(result) == ([(1.0, level)] if level is not Level.OK else [])

    @pytest.mark.parametrize(
        ("worst", "level"),
        [(1.52, Level.OK), (4.9, Level.OK), (4.91, Level.NOTE), (9.82, Level.WARNING)],
    )
    def test_px4s_metric_is_in_z_with_the_limits_of_flight_review(
        self, worst: float, level: Level
    ) -> None:
        # 1.52 is the most in px4_1_14_flight.tlog.
        result = found(VibrationDetector(), [(1.0, Vibration(99.0, 99.0, worst, 0))])
        assert check(result, "Vibration").level is level

    def test_the_worst_of_a_real_quadrotor_is_critical(self) -> None:
        # quad_2015.tlog, the message with the largest vibration_z; 716 were clipped in all.
        facts = [(0.0, Vibration(0.1, 0.1, 0.1, 0)), (9.0, Vibration(24.1, 45.9, 85.4, 716))]
        result = found(VibrationDetector(), facts, flying("ardupilot"))
        assert levels(result) == [(9.0, Level.CRITICAL), (9.0, Level.WARNING)]
        assert "85.4" in result.findings[0].detail
        assert "716" in result.findings[1].detail

    def test_few_clipped_samples_are_a_note(self) -> None:
        facts = [(0.0, Vibration(1, 1, 1, 40)), (3.0, Vibration(1, 1, 1, 41))]
        result = found(VibrationDetector(), facts)
        assert levels(result) == [(3.0, Level.NOTE)]

    def test_a_touch_down_is_not_judged(self) -> None:
        landing = Situation(autopilot="px4", armed=True, flying=True, in_air=False)
        result = found(VibrationDetector(), [(1.0, Vibration(0.0, 0.0, 50.0, 0))], landing)
        assert result.findings == []

    def test_no_message_is_no_verdict(self) -> None:
        assert check(found(VibrationDetector(), []), "Vibration").level is None


class TestGps:
    """ArduPilot wiki, Diagnosing problems using Logs: HDOP 1.5 and 2.0, 12 satellites."""

    GOOD = Gps(3, 14, 0.8, 0.5)

    def test_a_good_receiver(self) -> None:
        result = found(GpsDetector(), [(0.0, self.GOOD), (1.0, self.GOOD)])
        assert result.findings == []
        assert {c.level for c in result.checks} == {Level.OK}

    def test_a_lost_fix_has_its_beginning_and_its_end(self) -> None:
        lost = Gps(1, 0, None, None)
        facts = [(0.0, self.GOOD), (10.0, lost), (10.5, lost), (18.0, self.GOOD)]
        (finding,) = found(GpsDetector(), facts).findings
        assert (finding.t_s, finding.until_s, finding.level) == (10.0, 18.0, Level.CRITICAL)
        assert "for 8.0 s" in finding.detail

    def test_a_spell_ends_where_the_vehicle_is_disarmed(self) -> None:
        diluted, detector, now = Gps(3, 14, 2.6, None), GpsDetector(), flying()
        for t_s, armed in ((0.0, True), (10.0, True), (10.5, False), (500.0, True), (501.0, True)):
            now.t_s, now.armed = t_s, armed
            detector.handle(diluted, now)
        (finding,) = detector.result(now).findings
        assert "2 times, 11.5 s in all" in finding.detail

    def test_a_fix_that_is_not_regained(self) -> None:
        facts = [(0.0, self.GOOD), (10.0, Gps(0, 0, None, None))]
        (finding,) = found(GpsDetector(), facts, end_s=12.0).findings
        assert finding.until_s is None
        assert "until the end" in finding.detail

    def test_a_receiver_that_is_not_told_of_any_more(self) -> None:
        facts: list[tuple[float, Fact]] = [
            (0.0, self.GOOD),
            *((float(t), UNDISTURBED) for t in range(1, 8)),
        ]
        (finding,) = found(GpsDetector(), facts).findings
        assert finding.title == "nothing more was told of the GPS"
        assert finding.t_s == 4.0

    def test_indoors_there_never_was_a_fix(self) -> None:
        result = found(GpsDetector(), [(0.0, Gps(0, 0, None, None))])
        assert result.findings == []
        assert check(result, "GPS fix").level is Level.NOTE

    @pytest.mark.parametrize(
        ("autopilot", "hdop", "level"),
        [
            ("ardupilot", 1.5, Level.OK),
            ("ardupilot", 1.51, Level.NOTE),
            ("ardupilot", 2.0, Level.NOTE),
            ("ardupilot", 2.01, Level.WARNING),
            ("px4", 2.5, Level.OK),
            ("px4", 2.51, Level.WARNING),
        ],
    )
    def test_dilution(self, autopilot: str, hdop: float, level: Level) -> None:
        # ArduPilot wiki; EKF2_REQ_PDOP is 2.5 in px4_1_14_params.json.
        result = found(GpsDetector(), [(0.0, Gps(3, 14, hdop, None))], flying(autopilot))
        assert check(result, "HDOP").level is level
        assert len(result.findings) == (level is Level.WARNING)

    @pytest.mark.parametrize(
        ("autopilot", "satellites", "level"),
        [
            ("ardupilot", 12, Level.OK),
            ("ardupilot", 11, Level.NOTE),
            ("ardupilot", 5, Level.WARNING),
            ("px4", 6, Level.OK),
            ("px4", 5, Level.WARNING),
        ],
    )
    def test_satellites(self, autopilot: str, satellites: int, level: Level) -> None:
        # EKF2_REQ_NSATS is 6 in px4_1_14_params.json.
        result = found(GpsDetector(), [(0.0, Gps(3, satellites, 0.8, None))], flying(autopilot))
        assert check(result, "Satellites").level is level


class TestEstimator:
    def test_px4_rejects_a_measurement_above_one(self) -> None:
        # 0.34 is the most velocity ratio in px4_step_responses.tlog.
        facts = [
            (1.0, Estimator("px4", 0.34, 0.24, 0.1, 0.32)),
            (2.0, Estimator("px4", 0.3, 1.2, 0.1, 0.3)),
            (3.0, Estimator("px4", 0.3, 0.4, 0.1, 0.3)),
        ]
        result = found(EstimatorDetector(), facts)
        assert levels(result) == [(2.0, Level.WARNING)]
        assert check(result, "Estimator, position").level is Level.WARNING
        assert check(result, "Estimator, velocity").level is Level.OK

    def test_the_compass_of_a_real_quadrotor(self) -> None:
        # quad_2015.tlog has compass_variance up to 0.992.
        facts = [(1.0, Estimator("ardupilot", 0.387, 0.339, 0.175, 0.992))]
        result = found(EstimatorDetector(), facts, flying("ardupilot"))
        assert levels(result) == [(1.0, Level.WARNING)]

    def test_two_above_the_limit_for_a_second_are_arducopters_failsafe(self) -> None:
        bad = Estimator("ardupilot", 0.9, 0.9, 0.1, 0.1)
        facts = [(t / 2, bad) for t in range(4)]
        result = found(EstimatorDetector(), facts, flying("ardupilot"))
        assert (1.0, Level.CRITICAL) in levels(result)

    def test_two_above_the_limit_for_less_are_not(self) -> None:
        bad, good = (Estimator("ardupilot", r, r, 0.1, 0.1) for r in (0.9, 0.2))
        facts = [(0.0, bad), (0.5, bad), (0.9, good)]
        result = found(EstimatorDetector(), facts, flying("ardupilot"))
        assert Level.CRITICAL not in [finding.level for finding in result.findings]

    def test_the_other_autopilots_message_does_not_count(self) -> None:
        result = found(EstimatorDetector(), [(1.0, Estimator("ardupilot", 5.0, 5.0, 5.0, 5.0))])
        assert result.findings == []

    def test_ratios_that_are_unknown(self) -> None:
        result = found(EstimatorDetector(), [(1.0, Estimator("px4", None, None, None, None))])
        assert {c.level for c in result.checks} == {None}


class TestBattery:
    """BAT_LOW_THR 0.15, BAT_CRIT_THR 0.07 and BAT1_V_EMPTY 3.6 of px4_1_14_params.json."""

    def test_a_good_battery(self) -> None:
        facts = [(0.0, Battery(16.8, 0.0, 100.0)), (60.0, Battery(15.9, 12.0, 80.0))]
        result = found(BatteryDetector(), facts)
        assert result.findings == []
        assert {c.level for c in result.checks} == {Level.OK}

    @pytest.mark.parametrize(
        ("percent", "level"),
        [(15.0, Level.OK), (14.0, Level.WARNING), (7.0, Level.WARNING), (6.0, Level.CRITICAL)],
    )
    def test_what_is_left(self, percent: float, level: Level) -> None:
        result = found(BatteryDetector(), [(0.0, Battery(None, None, percent))])
        assert check(result, "Battery left").level is level

    def test_sag_is_what_the_voltage_falls_within_seconds(self) -> None:
        facts = [(0.0, Battery(16.8, 1.0, 99.0)), (2.0, Battery(15.4, 40.0, 98.0))]
        result = found(BatteryDetector(), facts)
        assert check(result, "Sag").measured == "1.40 V within 5 s, 0.35 V a cell"
        assert levels(result) == [(2.0, Level.WARNING)]

    def test_a_discharge_is_no_sag(self) -> None:
        facts = [(10.0 * i, Battery(16.8 - 0.1 * i, 10.0, 90.0)) for i in range(10)]
        result = found(BatteryDetector(), facts)
        assert check(result, "Sag").level is Level.OK

    def test_cells_that_are_told_are_not_guessed(self) -> None:
        # quad_2015.tlog came down to 6.98 V of three cells.
        facts: list[tuple[float, Fact]] = [(0.0, Cells(3)), (1.0, Battery(6.981, 1.0, 20.0))]
        result = found(BatteryDetector(), facts)
        assert "2.33 V a cell of 3" in check(result, "Voltage").measured
        assert "guessed" not in check(result, "Voltage").measured
        assert levels(result) == [(1.0, Level.WARNING)]

    def test_nothing_is_judged_before_arming(self) -> None:
        on_the_ground = Situation(autopilot="px4")
        result = found(BatteryDetector(), [(0.0, Battery(6.0, 0.0, 1.0))], on_the_ground)
        assert result.findings == []


class TestLink:
    @staticmethod
    def silences(*times: float, armed: bool = True, autopilot: str = "px4") -> list[Level]:
        detector, now = LinkDetector(), Situation(autopilot=autopilot, armed=armed)
        for t_s in times:
            now.t_s = t_s
            detector.heard(now)
        return [finding.level for finding in detector.result(now).findings]

    def test_a_heartbeat_a_second_is_no_gap(self) -> None:
        # arducopter_4_7_flight.tlog: 1.035 s at most.
        assert self.silences(0.0, 1.0, 2.035) == []

    def test_gaps_by_length(self) -> None:
        assert self.silences(0.0, 2.5) == [Level.NOTE]
        assert self.silences(0.0, 4.0) == [Level.WARNING]
        assert self.silences(0.0, 11.0) == [Level.CRITICAL]

    def test_arducopters_own_failsafe_waits_less_long(self) -> None:
        # FS_GCS_TIMEOUT 5 and COM_DL_LOSS_T 10 in the recorded parameters.
        assert self.silences(0.0, 6.0, autopilot="ardupilot") == [Level.CRITICAL]
        assert self.silences(0.0, 6.0, autopilot="px4") == [Level.WARNING]

    def test_on_the_ground_a_gap_is_a_note(self) -> None:
        assert self.silences(0.0, 60.0, armed=False) == [Level.NOTE]

    def test_a_record_that_ends_in_silence(self) -> None:
        detector, now = LinkDetector(), flying()
        detector.heard(now)
        now.t_s = 8.0
        (finding,) = detector.result(now).findings
        assert (finding.t_s, finding.level) == (0.0, Level.WARNING)

    def test_lost_messages(self) -> None:
        lossy = Status(True, "OFFBOARD", "IN_AIR", 100.0, 12.0)
        result = found(LinkDetector(), [(3.0, lossy), (4.0, UNDISTURBED)])
        assert levels(result) == [(3.0, Level.WARNING)]


class TestAttitude:
    @staticmethod
    def leaning(roll_deg: float, pitch_deg: float) -> Pose:
        return Pose((0.0, 0.0, 5.0), 0.0, 0.0, roll_deg, pitch_deg, 0.0)

    def test_a_step_response_is_no_trouble(self) -> None:
        # px4_step_responses.tlog: 47.9 deg for a step of 10 m.
        result = found(AttitudeDetector(), [(1.0, self.leaning(47.9, 0.0))])
        assert check(result, "Roll and pitch").level is Level.OK

    def test_px4s_failure_detector_acts_at_60_degrees(self) -> None:
        result = found(AttitudeDetector(), [(1.0, self.leaning(45.0, -46.0))])
        assert result.findings == []
        result = found(AttitudeDetector(), [(1.0, self.leaning(0.0, -61.0))])
        assert levels(result) == [(1.0, Level.CRITICAL)]


class TestFailsafes:
    """The texts are as recorded in scenarios_px4.json and scenarios_arducopter.json."""

    @pytest.mark.parametrize(
        "text",
        [
            "Failsafe activated",
            "Failsafe activated, entering Hold for 5 seconds",
            "Preflight Fail: Geofence violation",
            "GCS Failsafe",
            "Radio Failsafe",
            "Battery Failsafe",
            "Polygon fence breached",
            "Max Alt fence breached",
            "Battery 1 is critical 9.70V used 384 mAh",
        ],
    )
    def test_a_failsafe_in_flight_is_critical(self, text: str) -> None:
        result = found(FailsafeDetector(), [(4.0, Text(2, text))])
        assert levels(result) == [(4.0, Level.CRITICAL)]
        assert text in result.findings[0].detail

    @pytest.mark.parametrize(
        ("text", "level"),
        [
            ("Connection to ground station lost", Level.WARNING),
            ("Battery 1 is low 10.20V used 154 mAh", Level.WARNING),
        ],
    )
    def test_warnings(self, text: str, level: Level) -> None:
        assert levels(found(FailsafeDetector(), [(1.0, Text(4, text))])) == [(1.0, level)]

    @pytest.mark.parametrize(
        "text",
        [
            "GCS Failsafe Cleared",
            "Radio Failsafe Cleared",
            "Fence breach cleared",
            "Fence validation failed",
            "EKF3 IMU0 is using GPS",
            "Takeoff detected",
            "Mission finished, loitering",
            "Mode change to Auto failed: init failed",
        ],
    )
    def test_what_is_no_failsafe(self, text: str) -> None:
        assert found(FailsafeDetector(), [(1.0, Text(6, text))]).findings == []

    def test_before_arming_it_is_not_the_flights(self) -> None:
        ground = Situation(autopilot="ardupilot")
        assert found(FailsafeDetector(), [(1.0, Text(2, "GCS Failsafe"))], ground).findings == []

    def test_the_mode_that_follows_is_told(self) -> None:
        facts: list[tuple[float, Fact]] = [
            (1.0, UNDISTURBED),
            (4.0, Text(2, "Failsafe activated")),
            (5.5, Status(True, "AUTO.RTL", "IN_AIR", None, None)),
        ]
        (finding,) = found(FailsafeDetector(), facts).findings
        assert finding.detail == "it said: Failsafe activated; then mode AUTO.RTL after 1.5 s"

    def test_the_modes_after_that_are_not(self) -> None:
        # px4_1_14_flight.tlog: POSCTL after the text, then what the script asked for.
        facts: list[tuple[float, Fact]] = [
            (1.0, UNDISTURBED),
            (4.0, Text(2, "Failsafe activated")),
            (5.6, Status(True, "POSCTL", "IN_AIR", None, None)),
            (10.6, Status(True, "AUTO.LOITER", "IN_AIR", None, None)),
        ]
        (finding,) = found(FailsafeDetector(), facts).findings
        assert "POSCTL" in finding.detail
        assert "AUTO.LOITER" not in finding.detail

    def test_a_mode_much_later_is_none_of_its_doing(self) -> None:
        facts: list[tuple[float, Fact]] = [
            (1.0, UNDISTURBED),
            (4.0, Text(2, "Failsafe activated")),
            (30.0, Status(True, "AUTO.RTL", "IN_AIR", None, None)),
        ]
        (finding,) = found(FailsafeDetector(), facts).findings
        assert "AUTO.RTL" not in finding.detail


@pytest.mark.parametrize(
    "row", [TILT, BATTERY_LEFT, VOLTAGE, *RATIOS, DILUTION, SATELLITES, VIBRATION]
)
def test_no_limit_of_one_autopilot_is_cited_for_the_other(row: Row) -> None:
    assert "PX4" not in row.of("ardupilot").source
    sources = {limit.source for _, limit in row.of("px4").bands} | {row.of("px4").source}
    assert not [source for source in sources if "Ardu" in source]


class TestGate:
    @staticmethod
    def decision(phase: str, outcome: str, code: str = "", sentence: str = "") -> Decision:
        return Decision(1, 7, "operator", "goto", phase, outcome, code, sentence, None, {})

    def test_the_brake(self) -> None:
        breach = Machine("HOLDING", "breach predicted", "OURS", "NOMINAL", None)
        (finding,) = found(GateDetector(), [(6.0, breach)]).findings
        assert finding.level is Level.WARNING
        assert "braked" in finding.title

    def test_a_reminder_is_nothing_new(self) -> None:
        again = Machine("HOLDING", "reminder", "OURS", "NOMINAL", None)
        assert found(GateDetector(), [(6.0, again)]).findings == []

    def test_what_the_record_repeats_is_one_finding(self) -> None:
        breach = Machine("HOLDING", "breach predicted", "OURS", "NOMINAL", None)
        moved = Machine("MOVING", "goal cleared", "OURS", "NOMINAL", None)
        facts = [(6.0, breach), (7.0, breach), (8.0, moved), (9.0, breach)]
        assert [f.t_s for f in found(GateDetector(), facts).findings] == [6.0, 9.0]

    def test_a_condition_with_its_severity_and_reason(self) -> None:
        line = LogLine(3, "state_and_safety", "HOLD: gps_lost: no fix, 0 satellites")
        (finding,) = found(GateDetector(), [(6.0, line)]).findings
        assert finding.title == "the gate called HOLD: the GPS was lost"
        assert finding.detail == "no fix, 0 satellites"
        assert finding.level is Level.WARNING

    def test_of_several_vehicles_a_line_names_its_own(self) -> None:
        lines = [
            LogLine(3, "state_and_safety", f"vehicle {n}: CAUTION: too_close: 5 m") for n in (1, 2)
        ]
        now = flying()
        now.sysid = 2
        (finding,) = found(GateDetector(), [(6.0, line) for line in lines], now).findings
        assert finding.title == "the gate called CAUTION: the vehicle came too close to another one"

    def test_two_vehicles_too_close_in_flight_went_wrong_though_it_is_a_caution(self) -> None:
        for condition, level in (("too_close", Level.WARNING), ("gps_poor", Level.NOTE)):
            standing = (ConditionItem(condition, "CAUTION", "vehicle 2: 3 m away"),)
            told = Machine("MOVING", "reminder", "OURS", "CAUTION", None, standing)
            assert levels(found(GateDetector(), [(2.0, told)])) == [(2.0, level)]

    def test_conditions_of_the_machine_are_told_once_while_they_stand(self) -> None:
        def machine(severity: str) -> Machine:
            standing = (ConditionItem("gps_poor", severity, "5 m"),) if severity else ()
            return Machine("MOVING", "reminder", "OURS", severity or "NOMINAL", None, standing)

        line = LogLine(3, "state_and_safety", "CAUTION: gps_poor: 5 m")
        facts: list[tuple[float, Fact]] = [
            (1.0, machine("")),
            (2.0, line),
            *((t, machine("CAUTION")) for t in (2.0, 3.0)),
            *((t, machine("HOLD")) for t in (4.0, 5.0)),
            (6.0, machine("")),
            (7.0, machine("CAUTION")),
        ]
        assert levels(found(GateDetector(), facts)) == [
            (2.0, Level.NOTE),
            (4.0, Level.WARNING),
            (7.0, Level.NOTE),
        ]

    @pytest.mark.parametrize(
        "text", ["No longer HOLD: gps_lost", "Current State: HOLDING", "HOLD", "goto: aborted: x"]
    )
    def test_other_lines_are_no_conditions(self, text: str) -> None:
        assert found(GateDetector(), [(6.0, LogLine(3, "state_and_safety", text))]).findings == []

    def test_a_refusal_is_the_gates_work_and_no_trouble(self) -> None:
        refused = self.decision("verdict", "refused", "OUTSIDE_FENCE")
        result = found(GateDetector(), [(6.0, refused)])
        assert result.findings == []
        assert check(result, "Requests").measured == "0 accepted, 1 refused"

    @pytest.mark.parametrize(
        ("outcome", "code", "found_it"),
        [
            ("complete", "", False),
            ("aborted", "OPERATOR", False),
            ("aborted", "SEVERITY", True),
            ("timed out", "DEADLINE", True),
            ("taken over", "TAKEN_OVER", True),
        ],
    )
    def test_endings(self, outcome: str, code: str, found_it: bool) -> None:
        ending = self.decision("ending", outcome, code, "why")
        assert bool(found(GateDetector(), [(6.0, ending)]).findings) is found_it
