"""The report's page in a real browser: it draws, asks nobody for anything, and fits a phone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from gcs.flight_report.render import page as page_of
from gcs.flight_report.scan import scan
from gcs.report import RecordItem
from tests.system.browser import Browser, Page, chromium, running
from tests.unit.flight_report.test_page import with_evil_words
from tests.unit.flight_report.test_scan import a_flight_that_loses_gps, heartbeat
from tests.unit.record.flights import MS, record

PROGRAM = chromium()
pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(PROGRAM is None, reason="there is no Chromium on this machine"),
]

OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    assert PROGRAM is not None
    with running(PROGRAM) as one:
        yield one


def written(folder: Path, items: list[RecordItem]) -> Path:
    path = folder / "page.html"
    path.write_text(page_of(scan(record(folder, items, 125 * MS))), encoding="utf-8")
    return path


def opened(browser: Browser, path: Path, width: int = 1280, *, phone: bool = False) -> Page:
    page = browser.page()
    page.size(width, 844, phone=phone)
    page.open(path)
    return page


def test_every_plot_is_drawn_without_a_word_on_the_console(
    browser: Browser, tmp_path: Path
) -> None:
    page = opened(browser, written(tmp_path, a_flight_that_loses_gps()))
    plots = page.evaluate("document.querySelectorAll('.plot').length")
    assert plots == 6  # height, speed, place, battery, link, GPS: it has no ATTITUDE
    # A canvas that nothing was drawn on has one colour only: none.
    drawn = """[...document.querySelectorAll('.plot canvas')].filter((canvas) => {
        const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        return pixels.some((value) => value);
    }).length"""
    assert page.evaluate(drawn) == plots
    assert page.console == []


def test_it_asks_nobody_for_anything(browser: Browser, tmp_path: Path) -> None:
    path = written(tmp_path, a_flight_that_loses_gps())
    page = opened(browser, path)
    page.evaluate("1")
    assert [url for url in page.requests if not url.startswith("data:")] == [path.as_uri()]


@pytest.mark.parametrize("width", [320, 390, 768, 1280])
def test_nothing_is_wider_than_the_screen(browser: Browser, tmp_path: Path, width: int) -> None:
    path = written(tmp_path, a_flight_that_loses_gps())
    assert opened(browser, path, width, phone=width < 800).evaluate(OVERFLOW) == 0


def test_words_of_a_log_run_nothing_and_break_nothing(browser: Browser, tmp_path: Path) -> None:
    page = opened(browser, written(tmp_path, with_evil_words()), 390, phone=True)
    assert page.evaluate("document.querySelectorAll('img').length") == 0
    assert page.evaluate(OVERFLOW) == 0
    assert page.console == []


def test_dark_and_light_follow_the_system_and_the_button(browser: Browser, tmp_path: Path) -> None:
    page = browser.page()
    page.scheme("dark")
    page.open(written(tmp_path, a_flight_that_loses_gps()))
    theme = "document.documentElement.dataset.theme"
    paper = "getComputedStyle(document.body).backgroundColor"
    assert page.evaluate(theme) == "dark"
    dark = page.evaluate(paper)
    page.evaluate("document.getElementById('theme').click()")
    assert page.evaluate(theme) == "light"
    assert page.evaluate(paper) != dark
    assert page.console == []


def test_to_zoom_into_one_plot_is_to_zoom_into_all(browser: Browser, tmp_path: Path) -> None:
    page = opened(browser, written(tmp_path, a_flight_that_loses_gps()))
    first_pixels = """[...document.querySelectorAll('.plot canvas')].map((canvas) => {
        const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        return pixels.reduce((sum, value, place) => (sum * 31 + value * (place % 97)) % 1e9, 7);
    })"""
    before = page.evaluate(first_pixels)
    page.evaluate("document.querySelector('.plot').scrollIntoView()")
    place = page.evaluate(
        "(({left, top, width, height}) => [left, top, width, height])"
        "(document.querySelector('.plot .u-over').getBoundingClientRect())"
    )
    left, top, width, height = place
    for kind, share in (("mousePressed", 0.3), ("mouseMoved", 0.6), ("mouseReleased", 0.6)):
        page.call(
            "Input.dispatchMouseEvent",
            type=kind,
            x=left + share * width,
            y=top + height / 2,
            button="left",
            buttons=0 if kind == "mouseReleased" else 1,
            clickCount=1,
        )
    page.evaluate("new Promise((resolve) => setTimeout(resolve, 200))")
    after = page.evaluate(first_pixels)
    assert all(one != two for one, two in zip(before, after, strict=True))


def test_on_paper_it_is_light_and_no_wider(browser: Browser, tmp_path: Path) -> None:
    page = browser.page()
    page.scheme("dark")
    page.open(written(tmp_path, a_flight_that_loses_gps()))
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    widths = "[...document.querySelectorAll('.uplot')].map((plot) => plot.offsetWidth)"
    assert max(page.evaluate(widths)) <= 660
    page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"


@pytest.mark.thorough
def test_a_record_of_one_message_is_a_page_too(browser: Browser, tmp_path: Path) -> None:
    page = opened(browser, written(tmp_path, [heartbeat()]))
    assert page.evaluate("document.querySelector('.lead').textContent.length") > 20
    assert page.console == []
