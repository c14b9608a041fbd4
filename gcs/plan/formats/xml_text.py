"""Text as XML takes it."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape

_NO_XML = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def escaped(text: str) -> str:
    """In an element or an attribute in double quotes; what XML has no way to say is U+FFFD."""
    return escape(_NO_XML.sub("\N{REPLACEMENT CHARACTER}", text), {'"': "&quot;"})
