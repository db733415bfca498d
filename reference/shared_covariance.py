"""Several signals of one kind, read together, seen by the filter of all their states.

Nothing of the structure is used: the whole covariance is written down, its block for each signal, and the textbook filter does
with it what it always does. So that P stays the same for each signal is checked by another road than that it was derived by.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Fields = dict[str, Any]


@dataclass(frozen=True)
class SharedCovarianceOracle:
    """The independent view of a filter whose signals share one covariance.

    Attributes
    ----------
    whole : KalmanOracle
        Of all states, with one vector sensor.
    states : tuple of (str, int)
        Vector state of each signal, which starts at zero, and its size.
    sensor : str
        Name of the sensor.
    """

    whole: Any
    states: tuple[tuple[str, int], ...]
    sensor: str

    def call(
        self,
        entry: str,
        memory: Mapping[str, Any],
        inputs: Mapping[str, Any],
        params: Mapping[str, Any],
        precision: type = np.float64,
    ) -> tuple[int, Fields, Fields]:
        """Run an entry; see `plantc.reference.kalman.KalmanOracle.call`."""
        before = dict(memory)
        if "covariance" in before:
            before["covariance"] = np.tile(np.ravel(before["covariance"]), len(self.states))
        status, after, outputs = self.whole.call(entry, before, inputs, self.of_all(params), precision)
        if "covariance" in after:
            blocks = np.reshape(after["covariance"], (len(self.states), -1))
            worst = np.argmax(np.max(np.abs(blocks - blocks[0]), axis=1))
            # were the signals' blocks ever to differ, the one that is furthest from the first would be seen
            after = {**after, "covariance": blocks[worst]}
        reported = {"variance", f"{self.sensor}.variance"}
        return status, after, {k: v[:1] if k in reported else v for k, v in outputs.items()}

    def of_all(self, params: Mapping[str, Any]) -> Fields:
        """Return the parameters of all states from those of one signal."""
        answer = dict(params)
        step, start = answer.pop("variance_step"), answer.pop("variance_0")
        for state, size in self.states:
            answer |= {f"variance_step_{state}": step, f"variance_{state}_0": start, f"{state}_0": np.zeros(size)}
        noise = np.ravel(answer[f"variance_{self.sensor}"])
        answer[f"variance_{self.sensor}"] = np.repeat(noise, len(self.states))
        return answer
