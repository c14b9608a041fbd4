"""A MAVLink ground station that sends no command it cannot justify.

As a Python library it flies through the same station process as the command line::

    import gcs

    with gcs.connect(sim=True) as station:
        station.arm()
        station.takeoff(2)
        station.goto(3, 0, 2)
        station.land()

`async with gcs.aconnect(...)` is the same for asyncio.
`gcs.connect` joins the station that has the link open already, if one runs; what it returns is in
`gcs/operator/station.py`, what is raised in `gcs/operator/failures.py`.
`gcs.columns(path, "LOCAL_POSITION_NED")` gives the messages of one kind of a finished .mcap or
.tlog as a numpy array.  Nothing of it is loaded before it is asked for.
"""

TYPE_CHECKING = False  # that of `typing`, which takes its time to load
if TYPE_CHECKING:
    from gcs.logfile.columns.read import columns
    from gcs.operator.async_station import AsyncOperation, AsyncStation, aconnect
    from gcs.operator.connect import connect
    from gcs.operator.failures import (
        BadArgument,
        CannotConnect,
        Disconnected,
        GcsError,
        NotCompleted,
        NotHeard,
        Refused,
        StationDiffers,
    )
    from gcs.operator.operation import Operation
    from gcs.operator.station import Station

__version__ = "0.1.0"
_HOME = {
    "AsyncOperation": "gcs.operator.async_station",
    "AsyncStation": "gcs.operator.async_station",
    "aconnect": "gcs.operator.async_station",
    "columns": "gcs.logfile.columns.read",
    "connect": "gcs.operator.connect",
    "Operation": "gcs.operator.operation",
    "Station": "gcs.operator.station",
}
__all__ = [
    "AsyncOperation",
    "AsyncStation",
    "BadArgument",
    "CannotConnect",
    "Disconnected",
    "GcsError",
    "NotCompleted",
    "NotHeard",
    "Operation",
    "Refused",
    "Station",
    "StationDiffers",
    "aconnect",
    "columns",
    "connect",
]


if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """The library, loaded when it is used: every start of `gcs` imports this module."""
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(_HOME.get(name, "gcs.operator.failures")), name)

    def __dir__() -> list[str]:
        """With what `__getattr__` gives: `dir(gcs)` and Tab in a shell show the whole library, and
        nothing of how it is loaded."""
        return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
