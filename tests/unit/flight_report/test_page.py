"""The page: it holds all it needs, escapes all it is told, and says what is known of any record."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from html.parser import HTMLParser
from itertools import combinations
from pathlib import Path

import pytest

from gcs.flight_report.charts import chart_data
from gcs.flight_report.findings_json import report_json
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.number_format import clock, duration, utc
from gcs.flight_report.page.path_svg import colour_of
from gcs.flight_report.page.timeline_html import timeline
from gcs.flight_report.projection import Box, View, round_step, ticks
from gcs.flight_report.render import page
from gcs.report import (
    FenceItem,
    FenceShape,
    FsaItem,
    LogEvent,
    PointEnu,
    PoseItem,
    RecordItem,
)
from tests.unit.flight_report.test_scan import (
    UPRIGHT,
    a_flight_that_loses_gps,
    frame,
    gps,
    heartbeat,
    scanned,
    status,
)
from tests.unit.record.flights import MS, START_NS, a_flight, decided

EVIL = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&"


class Elements(HTMLParser):
    """The elements of a page and their attributes, as a browser's parser finds them."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.scripts: list[str] = []
        self._in_script = self._in_style = False
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._in_script, self._in_style = tag == "script", tag == "style"
        if self._in_script:
            self.scripts.append("")

    def handle_endtag(self, tag: str) -> None:
        self._in_script = self._in_style = False

    def handle_data(self, data: str) -> None:
        if self._in_script:
            self.scripts[-1] += data
        elif not self._in_style:
            self.words.append(data)

    def count(self, tag: str) -> int:
        return sum(name == tag for name, _ in self.tags)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def with_evil_words() -> list[RecordItem]:
    decision = decided(
        1,
        "refused",
        source=EVIL,
        code=EVIL,
        sentence=EVIL,
        zone=EVIL,
        goal=PointEnu(1.0, 2.0, 3.0),
        numbers={EVIL: 1.0},
    )
    text = EVIL.encode()[:50].ljust(50, b"\0")
    return [
        FenceItem([FenceShape(EVIL, True, [], (0.0, 0.0), 20.0, 0.0, 20.0)], None),
        heartbeat(),
        status(armed=True, landed="IN_AIR", mode=EVIL),
        PoseItem(1, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0), UPRIGHT),
        FsaItem(1, EVIL, 3, "HOVERING", "goto", EVIL, EVIL, None),
        decision,
        frame("STATUSTEXT", "<B50sHB", 2, text, 0, 0),
        LogEvent(START_NS, 3, "state_and_safety", f"HOLD: gps_lost: {EVIL}"),
        PoseItem(1, (5.0, 2.0, -3.0), (0.0, 0.0, 0.0), UPRIGHT),
        status(armed=True, landed="IN_AIR", mode=EVIL),
    ]


class TestEscaping:
    @pytest.fixture
    def html(self, tmp_path: Path) -> str:
        flight = scanned(tmp_path, with_evil_words(), 500 * MS)
        flight.name = EVIL
        flight.metadata["mavgate"] = {EVIL: EVIL}
        return page(flight)

    def test_no_word_of_a_log_becomes_an_element(self, html: str) -> None:
        found = Elements(html)
        assert found.count("script") == 2
        assert found.count("img") == 0
        assert not [a for _, attrs in found.tags for a in attrs if a.startswith("on")]
        assert not any("alert(2)" in script for script in found.scripts)

    def test_the_words_are_there_to_read(self, html: str) -> None:
        # In the name, the goal's reason, the number's name, the text, the state, the mode.
        assert Elements(html).text.count("</script><script>alert(1)</script>") >= 6

    def test_only_the_pages_own_script_may_run(self, html: str) -> None:
        found = Elements(html)
        policy = next(
            attrs["content"] or ""
            for tag, attrs in found.tags
            if tag == "meta" and attrs.get("http-equiv") == "Content-Security-Policy"
        )
        digest = base64.b64encode(hashlib.sha256(found.scripts[1].encode()).digest()).decode()
        assert f"script-src 'sha256-{digest}'" in policy
        assert "default-src 'none'" in policy
        assert "script-src 'unsafe" not in policy

    def test_a_control_character_and_half_a_surrogate(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, [heartbeat()])
        flight.name = "a\x00b\udc80.mcap"
        assert "a\N{REPLACEMENT CHARACTER}b\N{REPLACEMENT CHARACTER}.mcap" in page(flight)


class TestSelfContained:
    def test_it_refers_to_nothing_outside(self, tmp_path: Path) -> None:
        found = Elements(page(scanned(tmp_path, a_flight_that_loses_gps(), 125 * MS)))
        references = [
            value
            for _, attrs in found.tags
            for name, value in attrs.items()
            if name in ("src", "href", "action", "data")
        ]
        assert references == ["data:,"]
        assert found.count("svg") == 2
        css = page(scanned(tmp_path / "2", [heartbeat()]))
        assert "@import" not in css
        assert "url(http" not in css

    @pytest.mark.slow
    def test_ten_minutes_are_less_than_two_megabytes(self, tmp_path: Path) -> None:
        items: list[RecordItem] = []
        for step in range(600 * 5):
            east, up = step % 97 + 0.123456, step % 31 + 0.654321
            items.append(PoseItem(1, (east, -east, -up), (1.234567, 0.1, 0.1), UPRIGHT))
            items.append(status(armed=True, landed="IN_AIR"))
            items.append(gps(3, step % 17))
            if step % 25 == 0:
                items.append(heartbeat())
                items.append(
                    decided(
                        step,
                        "refused",
                        code="OUTSIDE_FENCE",
                        sentence="goal (500.00 E, 0.00 N, 2.00 U) is 350.2 m outside",
                        zone="home",
                        goal=PointEnu(500.0, 0.0, 2.0),
                        numbers={f"number_{i}_m": 1.0 / 3.0 for i in range(7)},
                    )
                )
        flight = scanned(tmp_path, items, 60 * MS)
        assert flight.seconds > 550
        assert len(page(flight).encode()) < 2_000_000

    def test_the_library_stands_beside_its_licence(self) -> None:
        import gcs.flight_report

        folder = Path(gcs.flight_report.__file__).parent / "page"
        library = (folder / "uPlot.iife.min.js").read_bytes()
        # dist/uPlot.iife.min.js of uplot-1.6.32.tgz from the npm registry.
        assert hashlib.sha256(library).hexdigest() == (
            "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f"
        )
        licence = (folder / "uPlot.LICENSE").read_text()
        assert "MIT License" in licence
        # Which is to be in every copy.
        assert licence in page(Flight("x.mcap", 1))


class TestPartialRecords:
    """Whatever a record has, the page says what is known, and is a page."""

    @pytest.mark.parametrize(
        "items",
        [
            [],
            [heartbeat()],
            [heartbeat(autopilot=8, kind=6)],
            [status(armed=False, landed="ON_GROUND")],
            [PoseItem(1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), UPRIGHT)],
            [PoseItem(1, (float("inf"), 0.0, 0.0), (0.0, 0.0, 0.0), UPRIGHT)],
            [PoseItem(1, (1e308, -1e308, 1e308), (1e308, 0.0, 0.0), UPRIGHT)] * 2,
            [status(armed=True, landed="UNDEFINED", mode="")] * 2,
            [FenceItem([], None)],
            [FenceItem([FenceShape("open", False, [(1, 1), (2, 1), (1, 2)])], None)],
            [
                FenceItem([FenceShape("huge", True, [], (0.0, 0.0), 1e300, -1e300, 1e300)], None),
                PoseItem(1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), UPRIGHT),
            ],
            a_flight(),
        ],
        ids=[
            *("nothing", "one heartbeat", "a station alone", "one state", "one position"),
            *("a position at infinity", "a position off the Earth", "no landed state"),
            *("no zones", "an open zone", "a huge zone"),
            "one of everything",
        ],
    )
    def test_a_page_all_the_same(self, tmp_path: Path, items: list[RecordItem]) -> None:
        flight = scanned(tmp_path, items)
        found = Elements(page(flight))
        assert found.count("h1") == 1
        assert len(found.text) > 20
        data = json.loads(found.scripts[0])
        assert set(data) == {"seconds", "charts", "scene"}
        assert not re.search(r"\b(nan|inf)\b", " ".join(str(tag) for tag in found.tags))
        told = json.loads(report_json(flight))
        assert told["messages"] == flight.messages

    def test_without_a_position_it_says_so(self, tmp_path: Path) -> None:
        flight = scanned(tmp_path, [heartbeat(), status(armed=True, landed="IN_AIR")])
        assert "no position of this vehicle" in Elements(page(flight)).text

    def test_a_record_that_was_not_closed_says_so(self) -> None:
        text = Elements(page(Flight("x.mcap", 1, closed=False, damaged=2, messages=3))).text
        assert "was not closed" in text
        assert "2 damaged records" in text


class TestContent:
    @pytest.fixture
    def flight(self, tmp_path: Path) -> Flight:
        return scanned(tmp_path, a_flight_that_loses_gps(), 125 * MS)

    def test_the_main_trouble_stands_before_everything_else(self, flight: Flight) -> None:
        text = Elements(page(flight)).text
        assert "What went wrong" in text
        assert text.index("the GPS lost its fix") < text.index("highest")
        assert "later the vehicle's failsafe acted" in text

    def test_the_fence_and_its_margin_are_drawn_to_scale(self, flight: Flight) -> None:
        found = Elements(page(flight))
        margins = [
            float(attrs["stroke-width"] or 0.0)
            for _, attrs in found.tags
            if attrs.get("class") == "margin"
        ]
        view_px = next(attrs["viewbox"] for tag, attrs in found.tags if tag == "svg")
        assert view_px is not None
        # 1.5 m of margin is half the stroke; the view is as wide as the flight, not as the fence.
        assert margins[0] / 2 / 640 > 1.5 / 100

    def test_every_plot_has_its_numbers(self, flight: Flight) -> None:
        data = chart_data(flight, flight.shown_vehicles())
        assert [chart.id for chart in data.charts] == [
            *("height", "speed", "place", "battery", "link", "gps"),
        ]
        for chart in data.charts:
            assert all(len(line.values) == len(chart.x) for line in chart.lines)
        html = page(flight)
        assert html.count('class="plot"') == len(data.charts)

    def test_a_heading_about_north_is_one_line(self, tmp_path: Path) -> None:
        turns = [(0.9999619, 0.0, 0.0, z) for z in (0.0087, -0.0087, 0.0087)]
        items = [PoseItem(1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), q) for q in turns]
        flight = scanned(tmp_path, items, 500 * MS)
        heading = next(c for c in chart_data(flight, flight.shown_vehicles()).charts if c.circle)
        values = [value for value in heading.lines[0].values if value is not None]
        assert max(values) - min(values) == pytest.approx(2.0, abs=0.2)

    def test_json_has_the_main_trouble(self, flight: Flight) -> None:
        (vehicle,) = json.loads(report_json(flight))["vehicles"]
        assert vehicle["main_trouble"]["title"] == "the GPS lost its fix"
        assert vehicle["main_trouble"]["level"] == "critical"
        assert {check["name"] for check in vehicle["checks"]} >= {"HDOP", "Vibration", "Silence"}


class TestWordsAndScales:
    def test_clock(self) -> None:
        assert [clock(t) for t in (0.0, 59.96, 61.5, 3_725.0)] == [
            *("0:00.0", "1:00.0", "1:01.5", "1:02:05"),
        ]

    def test_duration(self) -> None:
        assert [duration(t) for t in (4.2, 60.0, 185.0, 4_320.0)] == [
            *("4 s", "1 min", "3 min 5 s", "1 h 12 min"),
        ]

    def test_a_time_that_is_no_date(self) -> None:
        assert [utc(10**30), utc(0), utc(500_000_000)] == ["", "", ""], "no clock was set in 1970"
        assert utc(START_NS) == "2026-01-01 00:00:00 UTC"

    def test_the_labels_of_goals_that_are_near_do_not_lie_over_each_other(
        self, tmp_path: Path
    ) -> None:
        """On a phone, where a label is 48 by 20 of the picture's 640 across."""
        goals = [decided(n, "refused", goal=PointEnu(0.3 * n, 0.0, 3.0)) for n in (1, 2, 3)]
        flown = [PoseItem(1, (n, 0.0, -3.0), (1.0, 0.0, 0.0), UPRIGHT) for n in range(20)]
        html = page(scanned(tmp_path, [heartbeat(), *flown, *goals], 500 * MS))
        label = r'<text x="([\d.]+)" y="([\d.]+)" text-anchor="(\w+)">#'
        places = [
            (float(x) - (48.0 if anchor == "end" else 0.0), float(y))
            for x, y, anchor in re.findall(label, html)
        ]
        assert len(places) == 6, "three goals, in two pictures"
        for three in (places[:3], places[3:]):
            for (a, up), (b, down) in combinations(three, 2):
                assert abs(a - b) >= 48.0 or abs(up - down) >= 20.0

    def test_the_last_mark_of_the_states_stays_on_a_phone(self) -> None:
        """Its text leans back from an end that it would pass: 1:15 of 1:17."""
        vehicle = VehicleFlight(1)
        vehicle.lanes.landed.add(0.0, "armed")
        shown = timeline(Flight("a.mcap", 0, seconds=77.4), vehicle)
        marks = re.findall(r'<span( class="?last"?)? style="left:[\d.]+%">([\d:.]+)</span>', shown)
        assert [(bool(last), at) for last, at in marks][-2:] == [(False, "1:00"), (True, "1:15")]

    def test_steps_are_round(self) -> None:
        assert [round_step(span, 5) for span in (5.0, 12.0, 33.0, 700.0)] == [1.0, 5.0, 10.0, 200.0]
        assert ticks(-3.0, 11.0, 7) == [-2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0]

    def test_a_view_maps_its_corners(self) -> None:
        view = View(Box(-10.0, 30.0, 0.0, 20.0), 400.0, 200.0)
        assert view.px(-10.0, 20.0) == (0.0, 0.0)
        assert view.px(30.0, 0.0) == (400.0, 200.0)

    def test_colours_go_from_the_first_to_the_last(self) -> None:
        assert re.fullmatch(r"#[0-9a-f]{6}", colour_of(0.5))
        assert colour_of(-1.0) == colour_of(0.0) != colour_of(1.0) == colour_of(2.0)
