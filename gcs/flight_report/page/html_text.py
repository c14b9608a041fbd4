"""Text of a log in HTML and SVG: always escaped, with no exception."""

from __future__ import annotations

import html
import re

_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]")


def text(value: object) -> str:
    """As HTML text or in a quoted attribute; control characters become U+FFFD."""
    return html.escape(_CONTROL.sub("\N{REPLACEMENT CHARACTER}", str(value)), quote=True)


def script_json(encoded: bytes) -> str:
    """JSON for a `<script type="application/json">`, which nothing in it can end."""
    plain = encoded.decode()
    for character in "<>&\u2028\u2029":
        plain = plain.replace(character, f"\\u{ord(character):04x}")
    return plain
