"""XML -> elements that know their line, read safely.

A document type is refused, and with it every entity of a file's own: nothing is expanded, and
nothing is fetched.  Names are without their namespace, as KML and GPX have several versions of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from gcs.plan.errors import PlanError

_DEPTH_MAX = 100


@dataclass(slots=True)
class Element:
    """`text` is all text directly in it, in one piece and stripped."""

    file: str
    line: int
    name: str
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "".join(self.pieces).strip()

    @property
    def where(self) -> str:
        return str(self.line)

    def find(self, name: str) -> Element | None:
        """The first child of that name."""
        return next((child for child in self.children if child.name == name), None)

    def text_of(self, name: str) -> str:
        """Of the first child of that name; empty where there is none."""
        child = self.find(name)
        return "" if child is None else child.text

    def every(self, *names: str) -> Iterator[Element]:
        """Each element of one of these names below it, in the order of the file."""
        for child in self.children:
            if child.name in names:
                yield child
            yield from child.every(*names)

    def error(self, what: str, expected: str = "", hint: str = "") -> PlanError:
        return PlanError(self.file, self.where, f"<{self.name}>", what, expected, hint)


def read_xml(file: str, data: bytes) -> Element:
    """The outermost element.  Raises PlanError with the line."""
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True
    top = Element(file, 1, "", {})
    stack = [top]

    def start(name: str, attributes: dict[str, str]) -> None:
        line = parser.CurrentLineNumber
        if len(stack) > _DEPTH_MAX:
            raise PlanError(file, str(line), "XML", f"is more than {_DEPTH_MAX} elements deep")
        own = {key.rpartition(" ")[2]: value for key, value in attributes.items()}
        element = Element(file, line, name.rpartition(" ")[2], own)
        stack[-1].children.append(element)
        stack.append(element)

    def end(_name: str) -> None:
        stack.pop()

    def text(piece: str) -> None:
        stack[-1].pieces.append(piece)

    def document_type(*_: object) -> None:
        raise PlanError(
            file,
            str(parser.CurrentLineNumber),
            "<!DOCTYPE>",
            "is not read: a document type may hide what a file says, or make it endless",
            hint="KML and GPX need none: take it out",
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = text
    parser.StartDoctypeDeclHandler = document_type
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        what = f"is not well-formed: {expat.ErrorString(error.code)}"
        hint = "is the file whole?"
        raise PlanError(file, str(error.lineno), "XML", what, hint=hint) from None
    except (LookupError, ValueError) as error:  # an encoding that Python does not know
        raise PlanError(file, "1", "XML", f"cannot be decoded: {error}") from None
    return top.children[0]
