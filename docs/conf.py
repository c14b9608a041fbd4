"""The documentation site (`make docs`): Sphinx reads the pages of the repository as they are.

The pages of `docs/reference` are made from the program each time, by `reference.py` beside this
file.  A warning is an error, so a link that leads nowhere ends the build.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from pygments.lexers import TextLexer

if TYPE_CHECKING:
    from sphinx.application import Sphinx

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))
from reference import write  # noqa: E402

write(ROOT / "docs" / "reference")

project = "mavgate"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/**", "missions/**", "logs/README.md"]
exclude_patterns = ["CLAUDE.md"]
myst_heading_anchors = 4
myst_enable_extensions = ["deflist"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
suppress_warnings = [
    "myst.xref_missing",  # links to source files: tests/unit/test_pages.py checks those
    "toc.not_included",  # pages that are reached from other pages
]
html_theme = "furo"
html_title = "mavgate"
html_show_sphinx = False
html_copy_source = False


def setup(app: Sphinx) -> None:
    """Pictures of a terminal, which missions/lab3 has, are plain text."""
    app.add_lexer("terminal", TextLexer)
