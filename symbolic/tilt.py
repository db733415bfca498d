"""From where the thrust is to point to roll and pitch: how a multirotor turns a wish for a position into an attitude."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import casadi as ca

from ..reference.rotors import tilt
from .block import Block
from .components import finish
from .errors import ModelError

STEEPEST = 0.95
"""Largest sine of an angle that may be allowed: beyond it the cosine that is divided by is small."""


def tilt_allocation(limit: float = 0.5, *, name: str = "allocation", doc: str = "") -> Block:
    """Return the block that finds roll and pitch for a wanted direction of the thrust.

    The thrust is along the third body axis, the attitude is yaw, then pitch, then roll (Z Y X). With (ux, uy) the horizontal
    part of its unit vector,
    sin(roll) = ux sin(yaw) - uy cos(yaw) and sin(pitch) = (ux cos(yaw) + uy sin(yaw)) / cos(roll), at the yaw that is wanted.

    Parameters
    ----------
    limit : float
        Of both sines: the run-time parameter `limit`, up to 0.95. Each is held within it before its angle is taken (status
        CLAMPED), so that no angle is undefined, and cos(roll) does not vanish.
    name, doc : str
        Name and meaning of the block.

    Returns
    -------
    Block
        Inputs `ux`, `uy`, the wanted `reference_yaw`, and the `yaw` that is; no memory. Outputs `sine_roll`, `sine_pitch`, as
        they were held, `roll`, `pitch`, and the wanted `yaw` in the turn that is nearest: less it, an error is in [-pi, pi).

    Raises
    ------
    ModelError
        If the limit is not between 0 and 0.95.

    Notes
    -----
    Ghanai, Medjghou and Chafaa, AEEE 16(4), 2018, eqs. 2 and 3, with the guards that they leave out.
    """
    if not (isinstance(limit, (int, float)) and 0 < limit <= STEEPEST):
        raise ModelError(
            f"{name}: the limit of the sines is {limit!r}; give a number above 0 and up to {STEEPEST:g} (sin 30 deg is 0.5)"
        )
    block = Block(name, doc=doc or "roll and pitch that point the thrust where it is wanted")
    ux = block.input("ux", doc="wanted thrust along x, as a share of the whole; from 1 on it is beyond any attitude")
    uy = block.input("uy", doc="wanted thrust along y, likewise")
    wanted = block.input("reference_yaw", unit="rad", range=(-10, 10), doc="yaw that is wanted")
    yaw = block.input("yaw", unit="rad", range=(-1e3, 1e3), doc="yaw that is, not wrapped")
    most = block.parameter("limit", limit, range=(1e-3, STEEPEST), doc="of the sines of roll and pitch")
    sine_roll = ux * ca.sin(wanted) - uy * ca.cos(wanted)
    held_roll = ca.fmin(ca.fmax(sine_roll, -most), most)
    cosine = ca.sqrt(1 - held_roll**2)
    sine_pitch = (ux * ca.cos(wanted) + uy * ca.sin(wanted)) / cosine
    held_pitch = ca.fmin(ca.fmax(sine_pitch, -most), most)
    turns = ca.floor((yaw - wanted + math.pi) / (2 * math.pi))
    block.entry(
        "step",
        inputs=[ux, uy, wanted, yaw],
        outputs={
            "sine_roll": sine_roll,
            "sine_pitch": sine_pitch,
            "roll": ca.asin(held_roll),
            "pitch": ca.asin(held_pitch),
            "yaw": wanted + 2 * math.pi * turns,
        },
        output_units={"roll": "rad", "pitch": "rad", "yaw": "rad"},
        output_ranges={
            "sine_roll": (-1, 1),
            "sine_pitch": (-1, 1),
            "roll": (-1.5, 1.5),
            "pitch": (-1.5, 1.5),
            "yaw": (-1.1e3, 1.1e3),
        },
        output_docs={
            "sine_roll": "held within its limit",
            "sine_pitch": "held within its limit",
            "roll": "wanted",
            "pitch": "wanted",
            "yaw": "wanted, in the turn nearest to the yaw that is",
        },
        limits={"sine_roll": (-most, most), "sine_pitch": (-most, most)},
        doc="Roll and pitch for a direction of the thrust.",
    )
    return finish(block, {"step": tilt}, _pointing)


def _pointing(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield calls with directions that can be had, and now and then some that cannot."""
    yield "init", {}
    for k in range(steps):
        size = 1.5 if k % 4 == 3 else 0.3
        ux, uy = (float(item) for item in size * rng.uniform(-1, 1, 2))
        yield "step", {"ux": ux, "uy": uy, "reference_yaw": rng.uniform(-3, 3), "yaw": rng.uniform(-12, 12)}
