"""`make oracles`: is everything as it was?  For changes that move and rename, and nothing else.

python -m tests.oracles            compare with what is kept in hashes.json
python -m tests.oracles --write    keep what is so now
python -m tests.oracles --record   make the records that are missing: where behaviour changes by
                                   intention, those that differ are removed first

What is kept: of each flight of `flights.py` the frames both ways, the record, what was told and the
vehicle's state at the end; of each record in `records/` what an audit finds; the gate's table, and
what the explorer meets from its beginnings; every command's help; the tables of docs/json.md.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Final

import pytest
from click import Command, Context, Group

from gcs.cli.main import gcs as gcs_command
from gcs.gate.machine.table import TABLE
from gcs.record.compact import compact
from gcs.record.writer import Recorder
from tests.audits import audited, read
from tests.loopback.flight import PERSONALITIES, Flight
from tests.loopback.observed import START_NS
from tests.loopback.recorded_flights import flights_recorded
from tests.oracles.flights import SCRIPTS
from tests.proof.explorer import Explorer
from tests.proof.walk import Begun, Walk
from tests.unit import json_page
from tests.unit.gate.explored import WORLDS
from vehicle_sim.cli import main as sim_command

KEPT = Path(__file__).with_name("hashes.json")
RECORDS = Path(__file__).with_name("records")
SITUATIONS: Final = 4_000
"""So many of them have had their turn when an exploration ends here; `make thorough` does all."""


def digest(parts: Iterable[object]) -> str:
    """The first 16 digits of the SHA-256 of their `repr`, and how many there are."""
    sha, count = hashlib.sha256(), 0
    for count, part in enumerate(parts, 1):  # noqa: B007 - the last one is used
        sha.update(repr(part).encode())
    return f"{sha.hexdigest()[:16]} of {count}"


def flights() -> Iterator[tuple[str, str]]:
    for name, script in SCRIPTS.items():
        for personality in PERSONALITIES:
            with flights_recorded() as recorded:
                flight = script(personality)
                (own,) = recorded
                messages = own.tape.take()
            of = f"flight {name} {personality}"
            yield f"{of}: sent", digest((each.time_ns, each.data) for each in flight.sent)
            yield f"{of}: received", digest((each.time_ns, each.data) for each in flight.received)
            yield f"{of}: record", digest(tuple(each) for each in messages)
            yield f"{of}: told", digest(flight.told())
            yield f"{of}: vehicle", digest([flight.vehicle.state_bytes()])


def record() -> None:
    """Each script in one file, flown by either autopilot in turn."""
    for number, (name, script) in enumerate(SCRIPTS.items()):
        personality = PERSONALITIES[(number + 1) % 2]
        kept = RECORDS / f"{name}_{personality}.mcap"
        if kept.exists():
            continue
        recorder = Recorder.open(RECORDS, name, "20260101-000000", START_NS, sealed=True)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Flight, "new_recorder", lambda _, made=recorder: made)
            flight = script(personality)
        recorder.close(flight.now_ns)
        compact(recorder.path)
        recorder.path.rename(kept)


def audits() -> Iterator[tuple[str, str]]:
    for path in sorted(RECORDS.glob("*.mcap")):
        messages, attachments = read(path)
        result = audited(messages, attachments)
        yield f"audit {path.stem}", f"{'good' if result.good else 'differs'}, {len(messages)}"


def explored() -> Iterator[tuple[str, str]]:
    """The situations that are nearest to the beginnings, and the edges between them."""
    for name, world in WORLDS.items():
        explorer = Explorer(world)
        begun = Begun.from_starts(explorer.starts(TABLE))
        walk = Walk(explorer.letters(TABLE), explorer.judge, begun)
        met = walk.run(SITUATIONS)
        cells = sorted(
            (state.name, event.name, at) for (state, event), at in walk.first_met.items()
        )
        combinations = sorted(map(repr, met.combinations))
        fault = "none" if met.fault is None else str(met.fault)
        yield (
            f"explorer {name}",
            digest([met.situations, met.edges, fault, *cells, *combinations]),
        )


def helps() -> Iterator[tuple[str, str]]:
    for root, name in ((gcs_command, "gcs"), (sim_command, "vehicle-sim")):
        yield "help " + name, digest(_help(root, Context(root, info_name=name)))


def _help(command: Command, context: Context) -> Iterator[str]:
    yield command.get_help(context)
    if isinstance(command, Group):
        for name in sorted(command.list_commands(context)):
            one = command.get_command(context, name)
            assert one is not None
            yield from _help(one, Context(one, info_name=name, parent=context))


def found() -> dict[str, str]:
    table = digest(sorted(map(repr, TABLE.items())))
    page = {"JSON page": digest([json_page.tables()])}
    lines = (helps(), explored(), audits(), flights())
    return {"gate table": table, **page, **dict(chain.from_iterable(lines))}


def main(words: list[str]) -> int:
    if "--record" in words:
        record()
        return 0
    now = found()
    if "--write" in words:
        KEPT.write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
        return 0
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    differ = sorted(key for key in kept.keys() | now.keys() if kept.get(key) != now.get(key))
    for key in differ:
        print(f"{key}: {kept.get(key)} was kept, {now.get(key)} is so now")
    print(f"{len(now) - len(differ)} of {len(kept)} as they were")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
