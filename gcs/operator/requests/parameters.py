"""The vehicle's parameters, as a Python program asks for them."""

from __future__ import annotations

import math

from gcs import ipc
from gcs.operator import arguments
from gcs.operator.operation import Operation
from gcs.operator.requests.asks import Asks


@arguments.all_called_right
class Parameters(Asks):
    """Read, and set through the gate."""

    def parameters(self, timeout_s: float | None = None) -> dict[str, int | float]:
        """All parameters of the vehicle, by name; whole numbers where their type is.

        Raises Refused, NotCompleted, Disconnected.
        """
        return self._parameters(ipc.Ask(0, "param_list"), timeout_s)

    def parameter(self, name: str, timeout_s: float | None = None) -> int | float:
        """One parameter.  Raises Refused with BAD_PARAMETER where the vehicle has none of that
        name, and says which are near."""
        text = arguments.text("parameter", name=name)
        return self._parameters(ipc.Ask(0, "param_get", name=text), timeout_s)[name]

    def set_parameter(
        self, name: str, value: float, *, wait: bool = True, timeout_s: float | None = None
    ) -> Operation:
        """Set a parameter; complete once it is read back as asked.

        What safety stands on is set while the vehicle is disarmed on the ground only.
        """
        text = arguments.text("set_parameter", name=name)
        ask = ipc.Ask(
            0, "param_set", name=text, value=arguments.number("set_parameter", value=value)
        )
        return self.request(ask, wait, timeout_s)

    def _parameters(self, ask: ipc.Ask, timeout_s: float | None) -> dict[str, int | float]:
        found = self.request(ask, True, timeout_s).found
        told = [each for each in found if isinstance(each, ipc.ParametersEvent)]
        return {
            each.name: math.nan if each.value is None else each.value
            for event in told
            for each in event.parameters
        }
