"""MAVProxy in a pseudo-terminal, driven by its own commands as somebody at its prompt types them.

Everything that it prints goes to transcript.txt in the working directory.
"""

import os
import pathlib
import pty
import re
import select
import subprocess
import sys
import time

MODULES = "log,signing,wp,rally,fence,param,relay,arm,mode,rc,misc,cmdlong,battery,output,ftp,link"


class Prompt:
    """MAVProxy's standard input and output."""

    def __init__(self, url):
        self.text = ""
        self.read_to = 0
        self.terminal, theirs = pty.openpty()
        program = pathlib.Path(sys.executable).with_name("mavproxy.py")
        self.process = subprocess.Popen(
            [
                *(sys.executable, program, f"--master={url}", "--state-basedir=."),
                f"--default-modules={MODULES}",
            ],
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            env={**os.environ, "TERM": "dumb", "HOME": "."},
            start_new_session=True,
        )
        os.close(theirs)

    def wait(self, pattern, seconds=30.0):
        """Until it prints that, after what was waited for before."""
        end = time.monotonic() + seconds
        while True:
            found = re.compile(pattern).search(self.text, self.read_to)
            if found:
                self.read_to = found.end()
                return found
            if time.monotonic() > end:
                raise AssertionError(f"no {pattern!r} after {self.text[-2000:]}")
            if select.select([self.terminal], [], [], 0.1)[0]:
                try:
                    told = os.read(self.terminal, 65536)
                except OSError:  # it has ended
                    told = b""
                assert told, f"it ended: {self.text[-2000:]}"
                self.text += told.decode("utf-8", "replace").replace("\r\n", "\n")

    def do(self, command, *patterns, seconds=30.0):
        """A command, and what it must lead to (nothing = a moment's rest); prints both."""
        os.write(self.terminal, command.encode() + b"\n")
        found = [self.wait(pattern, seconds)[0] for pattern in patterns]
        if not patterns:
            time.sleep(0.5)
        print(f"{command}: {'; '.join(each.strip() for each in found)}")

    def close(self):
        os.write(self.terminal, b"exit\n")
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        pathlib.Path("transcript.txt").write_text(self.text)
