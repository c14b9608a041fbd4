"""How MAVLink FTP says no."""

from __future__ import annotations

from typing import Final

from vehicle_sim.services.ftp_wire import Nak
from vehicle_sim.storage.store import StoreError, StoreFault

NAKS: Final = {
    StoreFault.NOT_FOUND: bytes((Nak.FILE_NOT_FOUND,)),
    StoreFault.EXISTS: bytes((Nak.FILE_EXISTS,)),
    StoreFault.PROTECTED: bytes((Nak.FILE_PROTECTED,)),
    StoreFault.NO_SPACE: bytes((Nak.FAIL_ERRNO, 28)),
    StoreFault.WRONG_KIND: bytes((Nak.FAIL_ERRNO, 21)),
    StoreFault.NOT_EMPTY: bytes((Nak.FAIL_ERRNO, 39)),
    StoreFault.BAD_PATH: bytes((Nak.FAIL_ERRNO, 22)),
    StoreFault.BROKEN: bytes((Nak.FAIL_ERRNO, 5)),
}
"""The data of a NAK: Linux's errno where MAVLink has no word of its own."""


class FtpRefusedError(Exception):
    """A request gets this NAK."""

    def __init__(self, nak: Nak) -> None:
        super().__init__(nak.name)
        self.nak: Final = nak


def reason(refusal: FtpRefusedError | StoreError) -> bytes:
    """The data of the NAK."""
    return bytes((refusal.nak,)) if isinstance(refusal, FtpRefusedError) else NAKS[refusal.fault]
