"""The record of a session: one MCAP.

`gcs.record.columns(path, "LOCAL_POSITION_NED")` gives the messages of one kind of a finished .mcap
or .tlog as a numpy array; it is loaded when it is used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcs.logfile.columns.read import columns

__all__ = ["columns"]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """The station imports this package and must not load what reads finished logs."""
        if name == "columns":
            return import_module("gcs.logfile.columns.read").columns
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
