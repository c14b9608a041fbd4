"""A drawing that fills whatever room it is given; of it only the rows that changed are painted."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import RenderableType
from rich.segment import Segment
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

from gcs.tui.ascii_signs import in_ascii


class Panel(Widget):
    """`draw` is given columns and rows.

    Textual by itself renders all of a widget again for one sign that changed, which took most of
    the time from a key to the screen.
    """

    can_focus = False

    def __init__(self, draw: Callable[[int, int], RenderableType], name: str, title: str = ""):
        super().__init__(id=name)
        self._draw = draw
        self._drawn: RenderableType = ""
        self._drawn_for = Size(-1, -1)
        self._strips: list[Strip] = []
        self.border_title = title

    def redraw(self) -> None:
        if not self.display:
            return
        size, before, drawn = self.content_size, self._strips, self._drawn
        if self.styles.auto_dimensions:
            if self._drawing(*size) != drawn:
                self._drawn_for = Size(-1, -1)
                self.refresh(layout=True)
            return
        same_size = size == self._drawn_for
        self._put(self._drawing(*size), size)
        if not same_size:
            self.refresh()
        elif self._strips is not before:
            rows = [y for y, strip in enumerate(self._strips) if strip not in before[y : y + 1]]
            rows += range(len(self._strips), len(before))
            if rows:
                self.refresh(*(Region(0, y, size.width, 1) for y in rows))

    def render(self) -> RenderableType:
        """For the size of those that fit what is in them."""
        return self._drawing(*self.content_size)

    def render_line(self, y: int) -> Strip:
        if self._drawn_for != self.content_size:
            self._put(self._drawing(*self.content_size), self.content_size)
        return self._strips[y] if y < len(self._strips) else self._strip([])

    def _drawing(self, columns: int, rows: int) -> RenderableType:
        drawing = self._draw(columns, rows)
        return in_ascii(drawing) if self.screen.has_class("-ascii") else drawing

    def _put(self, drawing: RenderableType, size: Size) -> None:
        if drawing == self._drawn and size == self._drawn_for:
            return
        self._drawn, self._drawn_for = drawing, size
        console = self.app.console
        options = console.options.update(width=max(size.width, 1), height=None, highlight=False)
        lines = console.render_lines(drawing, options, pad=False)
        self._strips = [self._strip(line) for line in lines[: size.height]]

    def _strip(self, segments: list[Segment]) -> Strip:
        style = self.visual_style.rich_style
        return Strip(segments).apply_style(style).extend_cell_length(self._drawn_for.width, style)
