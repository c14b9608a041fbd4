"""The pages' examples of tests run as they stand there."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from tests.system.patience import until
from tests.system.programs import GCS, LONGEST_S, running
from tests.system.vehicle_program import free_port

pytest.importorskip("mavsdk")

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[2]
BEGIN, END = "<!-- example: {} -->", "<!-- end of example -->"


def example(page: str, name: str) -> str:
    """The code between the markers, without its fence."""
    _, begin, rest = page.partition(BEGIN.format(name))
    block, end, _ = rest.partition(END)
    assert begin, f"the page has no example {name}"
    assert end, f"the page has no {END}"
    lines = block.strip().splitlines()
    assert (lines[0], lines[-1]) == ("```python", "```")
    return "\n".join(lines[1:-1]) + "\n"


def test_the_fence_is_not_a_part_of_the_example() -> None:
    text = textwrap.dedent(
        f"""\
        before
        {BEGIN.format("one")}
        ```python
        import this
        ```
        {END}
        """
    )
    assert example(text, "one") == "import this\n"


@pytest.mark.parametrize(
    ("page", "name"),
    [
        ("README.md", "mavsdk"),
        ("docs/ci.md", "vehicle in a test"),
        ("docs/ci.md", "a gated test"),
    ],
)
def test_the_example_passes_as_it_stands(tmp_path: Path, page: str, name: str) -> None:
    suite = tmp_path / "test_example.py"
    suite.write_text(example((ROOT / page).read_text(encoding="utf-8"), name), encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(suite)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout
    assert "1 passed" in ended.stdout


def test_the_client_of_a_bridge_does_as_the_page_says(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "connect.md").read_text(encoding="utf-8")
    port = free_port()
    script = tmp_path / "client.py"
    code = example(page, "pymavlink through a bridge").replace("14551", str(port))
    script.write_text(code, encoding="utf-8")
    bridge = ("bridge", "--sim", "--client", f"udpin://127.0.0.1:{port}")
    with running(GCS, *bridge, "--log-dir", str(tmp_path)) as station:
        until(lambda: any("GROUNDED" in line for line in station.err), "a vehicle that stands")
        ended = subprocess.run(
            [sys.executable, str(script)],
            capture_output=True,
            text=True,
            timeout=LONGEST_S,
            check=False,
        )
        assert ended.returncode == 0, ended.stdout + ended.stderr
        assert "refused TOO_HIGH" in ended.stdout
