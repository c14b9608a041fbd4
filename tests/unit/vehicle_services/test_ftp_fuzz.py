"""Whatever is sent: the file server answers, keeps its bounds, and stays inside its store."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from tests.unit.vehicle_services.ftp_client import MS, frame
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Client, Send
from vehicle_sim.services.ftp.ftp import FtpServer
from vehicle_sim.services.ftp.wire import Opcode
from vehicle_sim.services.param_pack import PATH, param_pack
from vehicle_sim.shell.files import DiskStore
from vehicle_sim.storage.store import MemoryStore, Store, put
from vehicle_sim.wire import messages as m

LIMIT = 50_000
PATHS = (
    b"/", b"", b"a", b"a/b", b"a/b/c", b"b", b"log", b"log/1.bin", b"../out", b"/../out",
    b"a/../../out", b"link", b"link/x", b"@PARAM", b"@PARAM/param.pck",
    b"@PARAM/param.pck?withdefaults=1", b"@PARAM/param.pck?start=99999", b"a\\b", b"\xff",
    b"x" * 200,
)  # fmt: skip


def random_request(chance: Random, sequence: int) -> m.FileTransferProtocol:
    """Mostly sensible, sometimes noise."""
    if chance.random() < 0.1:
        return m.FileTransferProtocol(0, 1, 1, chance.randbytes(chance.choice((0, 3, 12, 251))))
    opcode = chance.choice([*Opcode, 16, 200])
    path = chance.choice(PATHS)
    if opcode is Opcode.RENAME:
        path += b"\0" + chance.choice(PATHS)
    if opcode is Opcode.WRITE_FILE:
        path = chance.randbytes(chance.randrange(240))
    size = chance.choice((None, None, None, 0, 1, 80, 239, 240, 255))
    offset = chance.choice((0, 0, 1, 80, 1000, LIMIT - 10, 2**31, 2**32 - 1))
    return frame(
        opcode,
        path[:239],
        sequence=sequence if chance.random() < 0.8 else chance.randrange(0x10000),
        session=chance.randrange(3),
        offset=offset,
        size=size,
    )


def tree(root: Path) -> dict[str, bytes]:
    return {str(each): each.read_bytes() for each in sorted(root.rglob("*")) if each.is_file()}


@pytest.mark.parametrize("kind", ["memory", "disk"])
@pytest.mark.parametrize("seed", range(3))
def test_random_requests(kind: str, seed: int, tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    (outside / "inner").mkdir(parents=True)
    (outside / "secret").write_bytes(b"SECRET-CONTENT")
    (tmp_path / "out").write_bytes(b"SECRET-CONTENT")
    root = tmp_path / "root"
    root.mkdir()
    (root / "link").symlink_to(outside)
    store: Store = DiskStore(root, LIMIT) if kind == "disk" else MemoryStore(LIMIT, 50)
    put(store, "log/1.bin", bytes(range(256)) * 20)
    parameters = Parameters("ardupilot")
    server = FtpServer(store, {PATH: param_pack(parameters)})
    chance = Random(seed)
    before = tree(outside), (tmp_path / "out").read_bytes()
    now_ns, answered = 0, 0
    for turn in range(4000):
        client = Client(chance.randrange(2), chance.choice((255, 254)), 190)
        effects = server.handle(client, random_request(chance, turn & 0xFFFF), now_ns)
        assert len(effects) <= 1
        answered += len(effects)
        now_ns += chance.choice((0, 1, 1, 1, 300, 3000)) * MS
        if now_ns >= server.deadline_ns:
            effects += server.tick(now_ns)
        for effect in effects:
            if isinstance(effect, Send) and isinstance(effect.message, m.FileTransferProtocol):
                assert len(effect.message.payload) <= 251
                assert b"SECRET" not in effect.message.payload
        assert server.deadline_ns > now_ns
    assert answered > 2000
    assert (tree(outside), (tmp_path / "out").read_bytes()) == before
    assert (root / "link").is_symlink()
    if isinstance(store, MemoryStore):
        assert store.used_bytes <= LIMIT
    else:
        assert sum(len(content) for content in tree(root).values()) <= LIMIT
