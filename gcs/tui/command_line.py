"""The line at the bottom: every word of the console behind `:`, a search of the log behind `/`.

In it Space types a space.  Esc closes it, and a second Esc is the abort that it always is;
Ctrl-Space aborts at once, and `abort` is a word like any other.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import ClassVar, Final

from textual.binding import Binding, BindingType
from textual.events import Key, Paste
from textual.widgets import Input

from gcs.tui.completion import Completed, Known, complete

HISTORY: Final = 200
SHOWN: Final = 12
"""Of the words or files that Tab offers."""


class CommandLine(Input):
    """Hidden until it is opened; keeps what was entered."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", show=False),
        Binding("up", "older(1)", show=False),
        Binding("down", "older(-1)", show=False),
        Binding("tab", "complete", show=False),
    ]

    def __init__(self, entered: Callable[[str, str], None]) -> None:
        """`entered` is given the prompt and the text of a line that was finished with Enter."""
        super().__init__(id="line", select_on_focus=False)
        self._entered = entered
        self.display = False
        self.prompt = ":"
        self.known = Known()
        self.offered: Completed | None = None
        self._history: deque[str] = deque(maxlen=HISTORY)
        self._back = 0
        self._typed = ""

    def open(self, prompt: str) -> None:
        self.prompt, self._back, self.offered = prompt, 0, None
        self.value = ""
        self.placeholder = "a word, as help lists them" if prompt == ":" else "search the log"
        self.display = True
        self.screen.set_focus(self)

    async def take(self, typed: Key | Paste) -> None:
        """Do it now.  Left to the queues of Textual, what comes in one burst with the key that
        opens the line, or that ends it, would be lost or overtake it."""
        if isinstance(typed, Paste):
            self.insert_text_at_cursor("".join(typed.text.splitlines()[:1]))
        elif typed.is_printable and typed.character:
            self.insert_text_at_cursor(typed.character)
        else:
            for binding in self._bindings.key_to_bindings.get(typed.key, ()):
                await self.app.run_action(binding.action, self)

    def action_close(self) -> None:
        self.value = ""  # a search ends with it
        self._hide()

    def action_older(self, by: int) -> None:
        """Lines that were entered before, the latest first."""
        if self._back == 0:
            self._typed = self.value
        self._back = min(max(self._back + by, 0), len(self._history))
        self.value = self._history[-self._back] if self._back else self._typed
        self.cursor_position = len(self.value)

    def action_complete(self) -> None:
        if self.prompt == ":":
            self.offered = complete(self.value, self.known)
            self.value = self.offered.text
            self.cursor_position = len(self.value)

    async def action_submit(self) -> None:
        text = self.value.strip()
        if self.prompt == ":" and text and (not self._history or self._history[-1] != text):
            self._history.append(text)
        if not text and self.prompt == "/":
            self.value = ""
        self._hide()
        if text:
            self._entered(self.prompt, text)

    def hint(self) -> str:
        """What Tab offers."""
        if self.offered is None or len(self.offered.offers) < 2:
            return ""
        more = len(self.offered.offers) - SHOWN
        return "  ".join(self.offered.offers[:SHOWN]) + (f"  and {more} more" if more > 0 else "")

    def _hide(self) -> None:
        self.display = False
        self.screen.set_focus(None)
