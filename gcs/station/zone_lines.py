"""Where a zone of the fence stands in its policy file, for errors that show only with a vehicle."""

from __future__ import annotations

from gcs import toml
from gcs.session.setup import Setup


def where_is(zone: str, setup: Setup) -> str:
    """Such as `yard.toml:4: fence[1]`, as errors of a policy are told; without line and number
    where the zone is none of the file's own tables."""
    file = setup.config.policy_path or setup.policy.name
    doc = toml.read(setup.policy_text, file)
    tables = doc.data.get("fence", [])
    assert isinstance(tables, list)
    for number, table in enumerate(tables):
        if table.get("name") == zone:
            line = doc.lines.get(("fence", number), 0)
            return f"{file}:{line}: fence[{number + 1}]"
    return f"{file}: fence"
