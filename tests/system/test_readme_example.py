"""The README's example for MAVSDK runs as it stands there."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from tests.system.programs import LONGEST_S

pytest.importorskip("mavsdk")

pytestmark = pytest.mark.system

README = Path(__file__).parents[2] / "README.md"
BEGIN, END = "<!-- example: mavsdk -->", "<!-- end of example -->"


def example(readme: str) -> str:
    """The code between the markers, without its fence."""
    _, begin, rest = readme.partition(BEGIN)
    block, end, _ = rest.partition(END)
    assert begin, f"README.md has no {BEGIN}"
    assert end, f"README.md has no {END}"
    lines = block.strip().splitlines()
    assert (lines[0], lines[-1]) == ("```python", "```")
    return "\n".join(lines[1:-1]) + "\n"


def test_the_fence_is_not_a_part_of_the_example() -> None:
    text = textwrap.dedent(
        f"""\
        before
        {BEGIN}
        ```python
        import this
        ```
        {END}
        """
    )
    assert example(text) == "import this\n"


def test_the_readmes_example_passes_as_it_stands(tmp_path: Path) -> None:
    suite = tmp_path / "test_example.py"
    suite.write_text(example(README.read_text(encoding="utf-8")), encoding="utf-8")
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
