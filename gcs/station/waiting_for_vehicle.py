"""What is told while no vehicle is heard."""

from __future__ import annotations

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.gate.effects import Level
from gcs.session.effects import Emit
from gcs.session.setup import Setup
from gcs.session.speedup_waits import Times
from gcs.session.work import Log, Work
from gcs.station.signatures import Signatures
from gcs.station.vehicles import Vehicles

SIGNED_OTHERWISE_S = 2.0
"""How long frames may come that are not rightly signed, before that is told as the reason why no
vehicle is known."""

NODE = "link"


class WaitingForVehicle:
    """Tells it once, with what is heard in its place."""

    def __init__(
        self,
        setup: Setup,
        times: Times,
        vehicles: Vehicles,
        signatures: Signatures,
        start_ns: int,
    ) -> None:
        self._setup = setup
        self._times = times
        self._vehicles = vehicles
        self._signatures = signatures
        self._start_ns = start_ns
        self._told = False

    def second(self, now_ns: int) -> list[Work]:
        """Once a second, as long as none is heard."""
        waited_s = self._times.real_s(now_ns - self._start_ns)
        patience_s = self._setup.config.connect_timeout_s
        what, why = self._signatures.why_no_vehicle()
        if what:
            # It is there, and waiting does not help: told before an operator has given up.
            patience_s = min(patience_s, SIGNED_OTHERWISE_S)
        if self._told or waited_s < patience_s:
            return []
        self._told = True
        where = ", ".join(self._setup.endpoints)
        hint = "is the vehicle running, and does it send to this address? (try: gcs fly --sim)"
        heard = self._vehicles.heard_names(now_ns)
        wanted = self._setup.config.target_sysid
        text = f"no vehicle heard for {waited_s:.0f} s ({where})"
        if heard and wanted:
            text = f"vehicle {wanted} was not heard for {waited_s:.0f} s, but {', '.join(heard)}"
            hint = "choose one of them with --vehicle"
        if what:
            text, hint = f"no vehicle is known after {waited_s:.0f} s ({where}): {what}", why
        return [Emit(ipc.Trouble(text, hint, ExitCode.NO_VEHICLE)), Log(Level.WARNING, NODE, text)]
