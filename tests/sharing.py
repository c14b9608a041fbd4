"""How `pytest -n` shares the tests out among its workers, so that all of them end together.

Two workers begin with a lane each, in which programs wait for real time, and the others compute
meanwhile.  All else goes out by file, so that what a file prepares is prepared once.
"""

from __future__ import annotations

import pytest
from xdist.scheduler import LoadScopeScheduling

from tests.lanes import share


class ByLane(LoadScopeScheduling):
    """The shares in the order in which their tests were collected."""

    def __init__(self, config: pytest.Config) -> None:
        super().__init__(config)
        config.option.loadscopereorder = False

    def _split_scope(self, nodeid: str) -> str:
        return share(nodeid)
