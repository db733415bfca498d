"""The mixer of rotors as plain NumPy: squared speeds that apply a command, held at their limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .controllers import Array, Fields, held


@dataclass(frozen=True, eq=False)
class Mixer:
    """Squared speeds of rotors for a command u = E w^2, and what those that were held apply.

    Attributes
    ----------
    effect : array (commands, rotors)
        E.
    commands : tuple of str
        Names.
    slowest, fastest : float
        Limits of a speed.
    spins : array (rotors,)
        Signs of the speeds in their residual.
    residual : str
        Name of that sum.
    """

    effect: Array
    commands: tuple[str, ...]
    slowest: float
    fastest: float
    spins: Array
    residual: str

    def __call__(self, memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
        """Evaluate it; see `Formula`."""
        u = np.concatenate([inputs[name] for name in self.commands])
        # the least squares of least norm, in double whatever the precision of the rest: it is designed, not computed in C
        wanted = np.linalg.pinv(self.effect).astype(u.dtype) @ u
        was_held, squares = held(wanted, u.dtype.type(self.slowest**2), u.dtype.type(self.fastest**2))
        speeds, applied = np.sqrt(squares), self.effect.astype(u.dtype) @ squares
        outputs: Fields = {"squared_speed": squares, "speed": speeds}
        outputs |= {name: applied[k : k + 1] for k, name in enumerate(self.commands)}
        outputs[self.residual] = np.atleast_1d(self.spins.astype(u.dtype) @ speeds)
        return was_held, {}, outputs


def tilt(memory: Fields, inputs: Fields, params: Fields) -> tuple[bool, Fields, Fields]:
    """Return roll and pitch for a wanted direction of the thrust, by turning it into the frame of the wanted yaw.

    There the thrust is (cos(roll) sin(pitch), -sin(roll)); see `Formula`.
    """
    wanted, real = inputs["reference_yaw"], inputs["ux"].dtype.type
    direction = (inputs["ux"] + 1j * inputs["uy"]) * np.exp(-1j * wanted)
    roll_held, sine_roll = held(-np.imag(direction), -params["limit"], params["limit"])
    roll = np.arcsin(sine_roll)
    pitch_held, sine_pitch = held(np.real(direction) / np.cos(roll), -params["limit"], params["limit"])
    turn = real(2 * np.pi)
    near = wanted + turn * np.floor((inputs["yaw"] - wanted) / turn + real(0.5))
    outputs = {
        "sine_roll": sine_roll,
        "sine_pitch": sine_pitch,
        "roll": roll,
        "pitch": np.arcsin(sine_pitch),
        "yaw": near,
    }
    return roll_held or pitch_held, {}, outputs
