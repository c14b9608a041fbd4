"""Every record that a test of the programs leaves is audited: nothing in it differs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import gcs
from gcs.audit.audit import audit
from gcs.audit.files import sessions
from gcs.audit.turns import NoStartError
from gcs.mcap_file.errors import BadRecordError
from gcs.shell.environment import environment


@pytest.fixture(autouse=True)
def audited(tmp_path: Path) -> Iterator[None]:
    """A file that is empty, or cut before its set-up was written, holds nothing to audit."""
    yield
    for path in tmp_path.rglob("*.mcap"):
        try:
            (session,) = sessions([path])
            messages, attachments = session.messages(), session.attachments()
            result = audit(messages, attachments, gcs.__version__, environment())
        except (BadRecordError, NoStartError):
            continue
        assert result.differences == 0, (path, result.notes, result.first[:5])
