"""The process that the operator's own rule runs in, as the loop uses it."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import sys
from typing import Any

import msgspec

from gcs.gate.policy.policy import Policy
from gcs.session.effects import AskRule
from gcs.session.inputs import RuleSaid
from gcs.shell.pipes import LineSource

START_WAIT_S = 10.0
"""How long a rule may take to be loaded, with whatever it imports."""


class RuleError(Exception):
    """The file is no rule, or cannot be read: `file:line: what is wrong`."""


def rule_policy(policy: Policy) -> dict[str, Any]:
    """The policy as a rule is given it: JSON, with the keys of the policy's file."""
    made: dict[str, Any] = json.loads(json.dumps(msgspec.to_builtins(policy)))
    return made


class RuleProcess:
    """Never waited for: a question that has no answer is refused by the session."""

    def __init__(self, path: str, source: str, policy: Policy) -> None:
        """Raises RuleError where it does not load."""
        self._child = subprocess.Popen(
            [sys.executable, "-m", "gcs.shell.rule_child"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            bufsize=0,
        )
        assert self._child.stdin is not None
        assert self._child.stdout is not None
        self._stdin = self._child.stdin
        self.lines = LineSource(self._child.stdout.fileno())
        begin = {"path": path, "source": source, "policy": rule_policy(policy)}
        self._write(begin)
        wrong = self._first_answer(path)
        if wrong:
            self.stop()
            raise RuleError(wrong)
        if sys.platform != "win32":
            os.set_blocking(self._stdin.fileno(), False)

    def _first_answer(self, path: str) -> str:
        while select.select([self.lines], [], [], START_WAIT_S)[0]:
            for line in self.lines.read():
                return str(json.loads(line)["wrong"])
            if self.lines.ended:
                return f"{path}: ended while it was loaded"
        return f"{path}: was not loaded within {START_WAIT_S:g} s"

    def ask(self, asked: AskRule) -> None:
        self._write(msgspec.to_builtins(asked))

    def _write(self, line: object) -> None:
        """One that has ended hears nothing, and answers nothing."""
        with contextlib.suppress(OSError):
            self._stdin.write(json.dumps(line).encode() + b"\n")

    def answers(self) -> list[RuleSaid]:
        """What came; a line that is no answer is none."""
        found = []
        for line in self.lines.read():
            with contextlib.suppress(msgspec.MsgspecError):
                found.append(msgspec.json.decode(line, type=RuleSaid))
        return found

    def stop(self) -> None:
        with contextlib.suppress(OSError):
            self._stdin.close()
        self._child.kill()
        self._child.wait()
        assert self._child.stdout is not None
        self._child.stdout.close()
