"""A viewer that subscribes to everything and takes nothing more from its socket."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from tests.system.hostile_viewers import HANDSHAKE, subscribe_to_all

READS_EVERY_S = 0.5
READS_BYTES = 2_000


@contextmanager
def slow_viewer(port: int) -> Iterator[None]:
    """It takes 4 kB a second, of some hundred that there are."""
    with socket.create_connection(("127.0.0.1", port)) as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4_096)
        sock.sendall(HANDSHAKE + subscribe_to_all())
        stop = threading.Event()
        reader = threading.Thread(target=_read, args=(sock, stop))
        reader.start()
        try:
            yield
        finally:
            stop.set()
            reader.join()


def _read(sock: socket.socket, stop: threading.Event) -> None:
    sock.settimeout(READS_EVERY_S)
    while not stop.is_set():
        try:
            sock.recv(READS_BYTES)
        except TimeoutError:
            continue
        except OSError:
            return
        time.sleep(READS_EVERY_S)
