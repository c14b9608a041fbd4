"""The page behind the preflight key: what fails and what is a caution, with what mends it."""

from __future__ import annotations

from rich.text import Text

from gcs.operator.preflight import SIGNS
from gcs.tui import look
from gcs.tui.scene import Scene

_STYLES = {"fail": look.BAD, "caution": look.WARN}


def draw(scene: Scene) -> Text:
    """The failures first; what passes by its name alone."""
    report = scene.talk.preflight_report
    if report is None:
        return Text("looking ...", look.DIM)
    page = Text()
    for verdict, style in _STYLES.items():
        for row in (each for each in report.rows if each.verdict == verdict):
            page.append(f"{SIGNS[verdict]:<8} {row.name}: ", style)
            page.append(f"{row.sentence}\n", look.PLAIN)
            for command in row.remedies:
                typed = command.removeprefix("gcs ").partition(" --")[0]  # the policy is here
                page.append(f"{'':9}:{typed}\n", look.PENDING)
    passed = ", ".join(row.name for row in report.rows if row.verdict == "pass")
    return page.append(f"pass     {passed}", look.DIM)
