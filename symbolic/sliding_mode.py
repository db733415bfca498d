"""Sliding mode control: the law of a plant x'' = f + g u + d as a Block, its switching terms, and how to choose its gains."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ..reference import sliding_mode as reference
from .affinity import kink_in
from .block import Block
from .components import Calls, Ends, finish, is_number, middle_of, rounded_up
from .errors import ModelError, expect
from .expressions import equation_text, numpy_callable
from .fuzzy import FuzzySystem
from .intervals import Interval, bounds
from .piecewise import saturated
from .plant import Plant, State, Symbol, wrap
from .signals import WIDE, Signal
from .subexpressions import Subexpressions

LARGEST = 1.0e3
"""How much larger than given lambda, mu, K and a width may be made at run time; where they are below one, than one."""

NEAR = 1.0
"""How far from zero the nominal trace goes, where the range of a state has room."""

MOST_TURNED = 1000.0
"""Range of the reference of an angle, rad: its error is wrapped."""

SAMPLES = 2001
"""Points at which a fuzzy switching term is looked at for its sign."""


# -- switching terms --------------------------------------------------------------------------------------------------


_KINDS = ("sign", "boundary_layer", "tanh", "fuzzy")


@dataclass(frozen=True)
class Switching:
    """What takes the place of sgn(s) in a sliding mode law: made by `sign`, `boundary_layer`, `tanh` and `fuzzy`.

    Attributes
    ----------
    kind : {"sign", "boundary_layer", "tanh", "fuzzy"}
    width : float
        Of the surface, in its unit; a run-time parameter of the law. 0 for the sign, which has none.
    system : FuzzySystem, optional
        Of the kind "fuzzy".
    """

    kind: str
    width: float = 0.0
    system: FuzzySystem | None = None

    def __post_init__(self) -> None:
        if self.kind not in _KINDS:
            raise ModelError(f"the switching term is of the kind {self.kind!r}; give one of {', '.join(_KINDS)}")
        if (self.kind == "fuzzy") != isinstance(self.system, FuzzySystem):
            raise ModelError(
                f"{self.kind}: the fuzzy system of the switching term is {self.system!r}; take fuzzy(system, width) for one with "
                "a system, and sign(), boundary_layer(width) or tanh(width) for one without"
            )
        if self.kind != "sign" and not (is_number(self.width) and self.width > 0):
            raise ModelError(
                f"{self.kind}: the width is {self.width!r}; give a positive number, in the unit of the surface"
            )

    def __call__(self, s: Any, width: Any = None) -> ca.SX:
        """Return the term for a surface, between about -1 and 1; NaN gives NaN."""
        if self.kind == "sign":
            return ca.sign(ca.SX(s))
        v = ca.SX(s) / (self.width if width is None else width)
        if self.kind == "tanh":
            return ca.tanh(v)
        if self.system is not None:
            return self.system(v)
        return saturated(v, -1, 1)


def sign() -> Switching:
    """Return sgn(s), sgn(0) = 0: robust as no other, and it chatters."""
    return Switching("sign")


def boundary_layer(width: float) -> Switching:
    """Return s / width, held at -1 and 1 (Slotine and Li, 1991, section 7.2)."""
    return Switching("boundary_layer", width)


def tanh(width: float) -> Switching:
    """Return tanh(s / width)."""
    return Switching("tanh", width)


def fuzzy(system: FuzzySystem, width: float) -> Switching:
    """Return a fuzzy system of s / width.

    Parameters
    ----------
    system : FuzzySystem
        One input and one output. Where its input is not zero, its output has the sign of the input or is zero: the term
        pushes against s.
    width : float
        Of the surface, for which the input of the system is 1.

    Raises
    ------
    ModelError
        If the system has another number of inputs or outputs, does not reach to both sides of zero, or has somewhere a
        sign that pushes away from the surface: ``|K_fuzzy| sgn(s)`` and the K_fuzzy of a rule table with the signs of s are the
        same, K_fuzzy sgn(s) of that table is not.
    """
    if not isinstance(system, FuzzySystem) or len(system.inputs) != 1 or len(system.outputs) != 1:
        raise ModelError(
            "fuzzy: the switching term needs a FuzzySystem of one input and one output, s / width -> share of K"
        )
    low, high = system.inputs[0].range
    if not low < 0 < high:
        raise ModelError(
            f"fuzzy: the input {system.inputs[0].name!r} is in {low:g} .. {high:g}; let it reach to both sides of 0"
        )
    at = np.unique(np.concatenate([np.linspace(low, high, SAMPLES), system.inputs[0].corners(), [0.0]]))
    out = system.reference()(at)[0]
    wrong = np.flatnonzero(np.where(at == 0, np.abs(out) > 1e-12, at * out < -1e-12))
    if wrong.size:
        k = wrong[0]
        raise ModelError(
            f"fuzzy: the system gives {out[k]:g} for {at[k]:.6g}, which would push the state away from the surface or off it; let "
            "the output have the sign of the input, and be 0 at 0"
        )
    return Switching("fuzzy", width, system)


# -- choosing gains ---------------------------------------------------------------------------------------------------


def switching_gain(
    beta: float, disturbance: float, model_error: float, eta: float, *, equivalent: float = 0.0, printed: bool = False
) -> float:
    """Return the least K for which the surface is reached: ``s s' <= -eta |s|``, whatever the bounds allow.

    ``K = beta (eta + D + M) + (beta - 1) |tau|``, tau = -f - lambda e' + x_d'' (Slotine and Li, 1991, eq. 7.26).

    Parameters
    ----------
    beta : float
        sqrt(g_max / g_min), at least 1: the law's g is the geometric mean of the two, so that 1/beta <= g_law / g <= beta.
    disturbance : float
        D, the largest ``|d|``.
    model_error : float
        M, the largest error of f, also by the estimate that it is evaluated at.
    eta : float
        How fast the surface is to be reached, positive.
    equivalent : float
        The largest ``|tau|``; needed where beta is above 1.
    printed : bool
        Give the condition (22) as Ghanai et al. (AEEE 16(4), 2018) print it, ``(1 - 1/beta) |tau|`` instead of
        ``(beta - 1) |tau|``. It is not sufficient where beta is above 1: for g = g_law / beta,
        ``(beta - 1) |tau|`` is what tau leaves.

    Raises
    ------
    ModelError
        If beta is below 1, eta not positive, or another number negative.
    """
    _check_numbers("switching_gain", beta=(beta, 1.0), disturbance=(disturbance, 0.0), model_error=(model_error, 0.0),
                   equivalent=(equivalent, 0.0))  # fmt: skip
    if not (is_number(eta) and eta > 0):
        raise ModelError(f"switching_gain: eta is {eta!r}; give a positive number, else the surface is never reached")
    share = 1 - 1 / beta if printed else beta - 1
    return beta * (eta + disturbance + model_error) + share * equivalent


def reaching_time(s0: float, eta: float, *, mu: float = 0.0, beta: float = 1.0, layer: float = 0.0) -> float:
    """Return a bound on the time until ``|s| <= layer``, for a K that meets `switching_gain`.

    ``d|s|/dt <= -eta - (mu/beta) |s|``, hence ``t <= (beta/mu) ln((eta + mu |s0| / beta) / (eta + mu layer / beta))``;
    without mu it is ``(|s0| - layer) / eta``.

    Parameters
    ----------
    s0 : float
        The surface at the start.
    eta : float
        As given to `switching_gain`.
    mu : float
        Of the law; only helps.
    beta : float
        As given to `switching_gain`.
    layer : float
        0 for the sign. A boundary layer, and a fuzzy term that is -1 and 1 outside its width, switch like the sign as far as
        their width; a tanh never does.
    """
    _check_numbers("reaching_time", mu=(mu, 0.0), beta=(beta, 1.0), layer=(layer, 0.0))
    if not (is_number(eta) and eta > 0) or not is_number(s0):
        raise ModelError(f"reaching_time: s0 is {s0!r} and eta {eta!r}; give a finite and a positive number")
    way = max(abs(s0) - layer, 0.0)
    rate = mu / beta
    if rate == 0:
        return way / eta
    return math.log1p(rate * way / (eta + rate * layer)) / rate


def _check_numbers(what: str, **given: tuple[Any, float]) -> None:
    for name, (value, least) in given.items():
        if not (is_number(value) and value >= least):
            raise ModelError(f"{what}: {name} is {value!r}; give a finite number of {least:g} or more")


# -- the law ----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Channel:
    """An output q, its command, and q' = rate, q'' = f + g u in the symbols of the plant."""

    state: State
    command: Symbol
    rate: ca.SX
    f: ca.SX
    g: ca.SX
    switching: Switching
    numbers: dict[str, float]
    least: float | None
    limits: Ends | None
    wraps: bool

    @property
    def name(self) -> str:
        return self.state.signal.name

    def rate_state(self, plant: Plant) -> Signal | None:
        """Return the state that q' is, if it is one."""
        found = [s.signal for s in plant.states if s.signal.size == 1 and ca.is_equal(self.rate, ca.SX(s.symbol), 0)]
        return found[0] if found else None


def sliding_mode(
    plant: Plant,
    commands: Mapping[Any, Any],
    *,
    surface: Any,
    mu: Any = 0.0,
    gain: Any,
    switching: Any,
    least: Mapping[Any, float] | None = None,
    saturate: bool | Mapping[Any, Ends] = False,
    wrapped: Collection[Any] = (),
    name: str = "",
    doc: str = "",
) -> Block:
    """Return the sliding mode law of the outputs of a plant, each moved by a command of its own.

    Of each output q the plant tells q' and q'' = f + g u (its derivative along the dynamics, noises at zero). With e = q - q_d:
    s = e' + lambda e and u = (-K sigma(s) - mu s - f - lambda e' + q_d'') / g, so that s' = -K sigma(s) - mu s + d where the
    model is exact and d is what it does not know.

    Parameters
    ----------
    plant : Plant
        Continuous, or made discrete by `discretise`: the law is that of the continuous plant.
    commands : dict
        State (scalar) or its name -> input (scalar) that moves it, or its name. In this order: a command that was found
        is known to the channels after it, and what they need of it is taken as held at its limits.
    surface : float or dict
        lambda, 1/s, positive; a number for all outputs or one for each.
    mu : float or dict
        mu, 1/s.
    gain : float or dict
        K, in units of q''. How large: `switching_gain`.
    switching : Switching or dict
        sigma: `sign()`, `boundary_layer(width)`, `tanh(width)` or `fuzzy(system, width)`.
    least : dict, optional
        Output -> number at which g is held, from below if it is positive, from above if it is negative, where g may vanish or
        change its sign; inside the range of g. Where it is held the status is CLAMPED, and g is the output `input_gain_<q>`.
    saturate : bool or dict
        True: each command is held within the range of its input (CLAMPED); a dict: input -> (low, high) that it is held within.
        Otherwise a call with a command outside its range is refused (OVERFLOW).
    wrapped : collection
        Outputs whose error is wrapped to [-pi, pi), beside those that were declared with ``angle=True``.
    name, doc : str
        Name of the block, default ``<plant>_sliding_mode``, and its meaning.

    Returns
    -------
    Block
        Entry `step`, no memory. Inputs: the states and the other inputs of the plant that f and g need, and for each output
        `reference_<q>`, `reference_rate_<q>`, `reference_acceleration_<q>`. Outputs: the commands, and for each output
        `surface_<q>` (s) and `switching_gain_<q>` (``|K sigma(s)|``). Run-time parameters: `lambda_<q>`, `mu_<q>`, `gain_<q>`,
        `width_<q>`, and those of the plant.

    Raises
    ------
    ModelError
        If an output is no scalar state, its command moves already q' or does not move q'', q'' is not affine in it, depends
        on the command of a later channel, or its g may vanish within the ranges of what it depends on and `least` does not
        say what to do.

    Notes
    -----
    Ghanai, Medjghou and Chafaa, AEEE 16(4), 2018, eqs. 12-24, without the unknown -d of eq. 20, and with the errors of
    an angle wrapped.

    Examples
    --------
    >>> from plantc.symbolic import Plant
    >>> from plantc.symbolic.sliding_mode import boundary_layer, sliding_mode
    >>> cart = Plant("cart")
    >>> position, speed = cart.state("position", unit="m"), cart.state("speed", unit="m/s")
    >>> force = cart.input("force", unit="N", range=(-10, 10))
    >>> cart.dynamics({position: speed, speed: 0.5 * force - 0.1 * speed})
    >>> law = sliding_mode(cart, {position: force}, surface=2.0, gain=0.5, switching=boundary_layer(0.1), saturate=True)
    >>> [item.name for item in law.entries["step"].outputs]
    ['force', 'surface_position', 'switching_gain_position']
    """
    expect(plant, Plant, "sliding_mode: the plant", "the Plant that the law is of")
    name = name or f"{plant.name}_sliding_mode"
    if least is not None:
        expect(least, Mapping, f"{name}: least", "a dictionary, output -> number at which its input gain is held")
    expect(wrapped, (list, tuple, set, frozenset), f"{name}: wrapped", "a list of outputs, also where it is one")
    source = _continuous(name, plant)
    channels = _channels(name, source, commands, (surface, mu, gain, switching), least or {}, saturate, wrapped)
    block = Block(
        name, doc=doc or f'sliding mode law of the plant "{plant.name}": {", ".join(c.name for c in channels)}'
    )
    needed = _needed(source, channels)
    taken = {
        item.name: block.input(item.name, size=item.size, unit=item.unit, range=_range(item), doc=item.doc)
        for item in needed
    }
    aims = {own.name: _declare_references(block, source, own) for own in channels}
    kept = [
        (symbol, block.parameter(
            symbol.signal.name, symbol.signal.default, unit=symbol.signal.unit,
            range=(symbol.signal.low, symbol.signal.high), doc=symbol.signal.doc,
        ))
        for symbol in source.parameters if _uses(channels, symbol)
    ]  # fmt: skip
    by_name = {symbol.signal.name: symbol for symbol in (*[s.symbol for s in source.states], *source.inputs)}
    pairs: list[tuple[ca.SX, ca.SX]] = [(by_name[item], symbol) for item, symbol in taken.items()]
    pairs += kept
    outputs: dict[str, ca.SX] = {}
    signals: list[Signal] = []
    limits: dict[str, Any] = {}
    for own in channels:
        _law(block, own, pairs, taken, aims[own.name], outputs, signals, limits)
    block.entry(
        "step", inputs=[*taken.values(), *[symbol for group in aims.values() for symbol in group]], outputs=outputs,
        output_units={item.name: item.unit for item in signals},
        output_ranges={item.name: (item.low, item.high) for item in signals},
        output_docs={item.name: item.doc for item in signals}, limits=limits,
        doc="The commands for a state and what it is to follow.",
    )  # fmt: skip
    block.sample_time = plant.dt if isinstance(plant.dt, float) else None
    block.notes = [f"{own.name}'' = {text}" for own, text in zip(channels, _texts(source, channels), strict=True)]
    return finish(block, {"step": _oracle(source, channels)}, _following(source, taken, aims, channels))


def _continuous(name: str, plant: Plant) -> Plant:
    plant.dynamics_expression()
    if not plant.is_discrete:
        return plant
    if plant.discretisation is None:
        raise ModelError(
            f"{name}: the plant {plant.name!r} is discrete from the start, and the law needs q'' = f + g u; give the continuous "
            "plant, or what its discretise() made"
        )
    return plant.discretisation.continuous


def _channels(
    name: str, plant: Plant, commands: Mapping[Any, Any], given: tuple[Any, Any, Any, Any], least: Mapping[Any, float],
    saturate: bool | Mapping[Any, Ends], wrapped: Collection[Any],
) -> list[_Channel]:  # fmt: skip
    """Return the channels, derived and judged."""
    if not isinstance(commands, Mapping) or not commands:
        raise ModelError(f"{name}: the commands are {commands!r}; give a dictionary, state -> input that moves it")
    if not isinstance(saturate, (bool, np.bool_, Mapping)):
        raise ModelError(
            f"{name}: saturate is {saturate!r}; give True for the range of each command, or a dictionary, input -> (low, high)"
        )
    states = {state.signal.name: state for state in plant.states}
    inputs = {symbol.signal.name: symbol for symbol in plant.inputs}
    pairs = [
        (_known(name, "output", states, key), _known(name, "command", inputs, value)) for key, value in commands.items()
    ]
    names = [first for first, _ in pairs]
    if len({second for _, second in pairs}) < len(pairs) or len(set(names)) < len(names):
        raise ModelError(
            f"{name}: an output or a command stands twice in commands=; give each output a command of its own"
        )
    floors = {_name(key): value for key, value in least.items()}
    ends = {_name(key): value for key, value in saturate.items()} if isinstance(saturate, Mapping) else {}
    turning = {_name(key) for key in wrapped}
    for what, keys, known in (
        ("least", set(floors), names), ("saturate", set(ends), [second for _, second in pairs]), ("wrapped", turning, names)
    ):  # fmt: skip
        if set(keys) - set(known):
            raise ModelError(f"{name}: {what}= names {sorted(set(keys) - set(known))}; it may name {', '.join(known)}")
    answer: list[_Channel] = []
    later = dict(pairs)
    spread = [_for_each(name, what, value, names) for what, value in zip(_WORDS, given, strict=True)]
    for output, command in pairs:
        del later[output]
        state, symbol = states[output], inputs[command]
        rate, f, g = _derived(name, plant, state, symbol, [inputs[item] for item in later.values()])
        numbers = {
            word: _number(name, output, word, values[output]) for word, values in zip(_WORDS, spread[:3], strict=False)
        }
        term = spread[3][output]
        if not isinstance(term, Switching):
            raise ModelError(
                f"{name}: the switching term of {output!r} is {term!r}; give sign(), boundary_layer(width), tanh(width) or "
                "fuzzy(system, width)"
            )
        signal = symbol.signal
        within = (
            (signal.low[0], signal.high[0])
            if saturate and not isinstance(saturate, Mapping)
            else _within(name, signal, ends.get(command))
        )
        floor = _floor(name, plant, state, g, floors.get(output), answer)
        answer.append(
            _Channel(state, symbol, rate, f, g, term, numbers, floor, within, state.signal.angle or output in turning)
        )
    return answer


_WORDS = ("lambda", "mu", "gain", "switching")


def _known(name: str, what: str, known: Mapping[str, Any], key: Any) -> str:
    """Return the name of a scalar state or input of the plant."""
    found = key if isinstance(key, str) else getattr(getattr(key, "signal", None), "name", None)
    kind = "state" if what == "output" else "input"
    if not isinstance(found, str) or found not in known:
        raise ModelError(f"{name}: the {what} {found or key!r} is no {kind} of the plant; it has {', '.join(known)}")
    symbol = known[found].symbol if what == "output" else known[found]
    if isinstance(key, Symbol) and key is not symbol:
        raise ModelError(
            f"{name}: the {what} {found!r} is a symbol of another plant; give that of the plant, or its name"
        )
    if symbol.signal.size != 1:
        raise ModelError(f"{name}: the {what} {found!r} has {symbol.signal.size} elements; declare them as scalars")
    return found


def _name(key: Any) -> str:
    """Return the name of a symbol, or what was given in its place."""
    signal = getattr(key, "signal", None)
    return signal.name if isinstance(signal, Signal) else str(key)


def _for_each(name: str, what: str, given: Any, names: list[str]) -> dict[str, Any]:
    """Return one value for each output."""
    if not isinstance(given, Mapping):
        return dict.fromkeys(names, given)
    values = {_name(key): value for key, value in given.items()}
    if set(values) != set(names):
        raise ModelError(
            f"{name}: {what} is given for {sorted(values)}, and the outputs are {sorted(names)}; give one for each"
        )
    return values


def _number(name: str, output: str, what: str, value: Any) -> float:
    least = "more than 0" if what == "lambda" else "0 or more"
    if not is_number(value) or value < 0 or (value == 0 and what == "lambda"):
        raise ModelError(f"{name}: {what} of {output!r} is {value!r}; give a finite number, {least}")
    return float(value)


def _within(name: str, signal: Signal, given: Any) -> Ends | None:
    if given is None:
        return None
    try:
        low, high = (float(item) for item in given)
    except (TypeError, ValueError):
        low, high = math.nan, math.nan
    if not signal.low[0] <= low < high <= signal.high[0]:
        raise ModelError(
            f"{name}: {signal.name!r} is to be held within {given!r}; give (low, high) inside its range {signal.low[0]:g} .. "
            f"{signal.high[0]:g}"
        )
    return low, high


def _derived(name: str, plant: Plant, state: State, command: Symbol, later: list[Symbol]) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return q', f and g of q'' = f + g u."""
    output, moved = state.signal.name, command.signal.name
    if state.attitude:
        raise ModelError(
            f"{name}: the output {output!r} is an attitude, which has no q'' of its own; take angles or a rate"
        )
    rates = plant.without_noise(plant.dynamics_expression())
    rate = rates[state.error_at]
    by_time = []
    for other in plant.states:
        if other.attitude and ca.depends_on(rate, other.symbol):
            raise ModelError(
                f"{name}: the rate of {output!r} depends on the attitude {other.signal.name!r}, along which it is not "
                "differentiated; take an output whose rate is a state"
            )
        by_time.append(ca.SX(4, 1) if other.attitude else rates[other.error_at])
    early = [symbol.signal.name for symbol in plant.inputs if ca.depends_on(rate, symbol)]
    if early:
        raise ModelError(
            f"{name}: the input {early[0]!r} moves already the rate of {output!r}, and the law is for q'' = f + g u; take the "
            "state that it moves two integrations later"
        )
    second = ca.jtimes(rate, plant.x, ca.vertcat(*by_time))
    g = _without_calls(plant, ca.jacobian(second, command))
    if g.nnz() == 0:
        raise ModelError(
            f"{name}: the input {moved!r} does not move the second derivative of {output!r}; name one that does"
        )
    if ca.depends_on(g, command) or kink_in(second, ca.SX(command)):
        raise ModelError(
            f"{name}: the second derivative of {output!r} is not affine in {moved!r}, so that it is not f + g u; declare what it "
            "is affine in as the input"
        )
    ahead = [symbol.signal.name for symbol in later if ca.depends_on(second, symbol)]
    if ahead:
        raise ModelError(
            f"{name}: the second derivative of {output!r} depends on {ahead[0]!r}, the command of a later output; name that "
            "output first, or give a plant in which they do not depend on each other"
        )
    return rate, ca.substitute(second, command, ca.SX(0)), ca.densify(g)


def _without_calls(plant: Plant, derivative: ca.SX) -> ca.SX:
    """Return a derivative without the calls of piecewise functions that CasADi differentiates along nothing, and keeps."""
    symbols = [ca.SX(item) for item in (*[s.symbol for s in plant.states], *plant.inputs, *plant.parameters)]
    function = ca.Function("derivative", symbols, [ca.densify(derivative)])
    if not any(function.instruction_id(k) == ca.OP_CALL for k in range(function.n_instructions())):
        return derivative
    return ca.sparsify(Subexpressions(symbols, [derivative]).rebuilt(0, {}))


def _floor(
    name: str, plant: Plant, state: State, g: ca.SX, least: float | None, before: list[_Channel]
) -> float | None:
    """Return what g is held at, or None where its ranges say that it never vanishes."""
    output = state.signal.name
    if least is not None and (not is_number(least) or least == 0):
        raise ModelError(
            f"{name}: least of {output!r} is {least!r}; give a number that is not zero, with the sign of g"
        )
    low, high = _bounds_of(g, plant, before)
    if least is not None:
        # held by a bound that g never passes, it would be another number than g, everywhere, maybe of the other sign
        if least > high or least < low:
            raise ModelError(
                f"{name}: least of {output!r} is {least:g}, and what the command is multiplied by in its second derivative, "
                f"{equation_text(g, plant.symbol_names())[0]}, is by its ranges in {low:.4g} .. {high:.4g}, so that it would "
                "always be held; give a number in there, with its sign"
            )
        return float(least)
    if low <= 0 <= high or not math.isfinite(1 / low) or not math.isfinite(1 / high):
        text = equation_text(g, plant.symbol_names())[0]
        raise ModelError(
            f"{name}: what the command is multiplied by in the second derivative of {output!r}, {text}, may vanish: by its ranges "
            f"it is in {low:.4g} .. {high:.4g}; narrow the ranges, or give least={{{output!r}: ...}}, where to hold it"
        )
    return None


def _bounds_of(g: ca.SX, plant: Plant, before: list[_Channel]) -> Interval:
    """Return where g is, for the ranges of the plant and the limits of the commands that were found."""
    symbols = [*[s.symbol for s in plant.states], *plant.inputs, *plant.parameters]
    held = {own.command.signal.name: [own.limits] for own in before if own.limits is not None}
    ranges = [held.get(item.signal.name) or list(zip(*_range(item.signal), strict=True)) for item in symbols]
    return bounds(g, symbols, ranges)[0]


def _uses(channels: list[_Channel], symbol: ca.SX) -> bool:
    return any(ca.depends_on(ca.vertcat(own.rate, own.f, own.g), symbol) for own in channels)


def _needed(plant: Plant, channels: list[_Channel]) -> list[Signal]:
    """Return the states and inputs of the plant that the law asks for; not the commands, which it finds itself."""
    outputs = {own.name for own in channels}
    commands = {own.command.signal.name for own in channels}
    states = [s.signal for s in plant.states if s.signal.name in outputs or _uses(channels, s.symbol)]
    others = [item.signal for item in plant.inputs if item.signal.name not in commands and _uses(channels, item)]
    return [*states, *others]


def _range(signal: Signal) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return signal.low, signal.high


def _declare_references(block: Block, plant: Plant, own: _Channel) -> tuple[Symbol, Symbol, Symbol]:
    """Declare q_d, q_d', q_d''; the range of q_d' is that of the state that is q', if it is one."""
    signal = own.state.signal
    rate = own.rate_state(plant)
    ends = (rate.low, rate.high) if rate else None
    aims = (-MOST_TURNED, MOST_TURNED) if signal.angle else _range(signal)
    per, per_square = (f"{signal.unit}/s", f"{signal.unit}/s^2") if signal.unit else ("", "")
    return (
        block.input(f"reference_{own.name}", unit=signal.unit, range=aims, doc=f"what {own.name} is to follow"),
        block.input(f"reference_rate_{own.name}", unit=per, range=ends, doc="its rate"),
        block.input(f"reference_acceleration_{own.name}", unit=per_square, doc="its second derivative"),
    )


def _law(
    block: Block, own: _Channel, pairs: list[tuple[ca.SX, ca.SX]], taken: Mapping[str, Symbol],
    aim: tuple[Symbol, Symbol, Symbol], outputs: dict[str, ca.SX], signals: list[Signal], limits: dict[str, Any],
) -> None:  # fmt: skip
    """Add the law of one output, and what its command is to those that come after."""
    q, signal, moved = own.name, own.state.signal, own.command.signal
    per, per_square = (f"{signal.unit}/s", f"{signal.unit}/s^2") if signal.unit else ("", "")
    coefficient, mu, K = (
        block.parameter(
            f"{word}_{q}",
            own.numbers[word],
            unit=unit,
            doc=meaning,
            range=(0, rounded_up(LARGEST * max(1.0, own.numbers[word]))),
        )
        for word, unit, meaning in (
            ("lambda", "1/s", "slope of the surface s = e' + lambda e"),
            ("mu", "1/s", "how fast s decays beside the switching term"),
            ("gain", per_square, "K of the switching term"),
        )
    )
    width = None
    if own.switching.kind != "sign":
        ends = (rounded_up(own.switching.width / LARGEST), rounded_up(LARGEST * own.switching.width))
        width = block.parameter(
            f"width_{q}", own.switching.width, unit=per, range=ends, doc="width of the switching term"
        )
    old, new = ca.vertcat(*[first for first, _ in pairs]), ca.vertcat(*[second for _, second in pairs])
    rate, f, g = ca.vertsplit(ca.substitute(ca.vertcat(own.rate, own.f, own.g), old, new))
    wide = _held_at(own)
    if wide is not None:
        outputs[f"input_gain_{q}"] = g
        limits[f"input_gain_{q}"] = (wide[0], None) if wide[0] > 0 else (None, wide[1])
        signals.append(Signal(f"input_gain_{q}", low=(wide[0],), high=(wide[1],), doc=f"g of {q}, held at its least"))
        g = ca.fmax(g, wide[0]) if wide[0] > 0 else ca.fmin(g, wide[1])
    e = taken[q] - aim[0]
    e = wrap(e) if own.wraps else e
    slope = rate - aim[1]
    s = slope + coefficient * e
    term = K * own.switching(s, width)
    command = (aim[2] - term - mu * s - f - coefficient * slope) / g
    outputs |= {moved.name: command, f"surface_{q}": s, f"switching_gain_{q}": ca.fabs(term)}
    low, high = own.limits or (moved.low[0], moved.high[0])
    if own.limits is not None:
        limits[moved.name] = own.limits
        command = ca.fmin(ca.fmax(command, low), high)
    pairs.append((own.command, command))
    signals += [
        Signal(
            moved.name,
            1,
            moved.unit,
            (low,),
            (high,),
            f"{moved.doc or 'command'}; keeps its last value when a call is refused",
        ),
        Signal(f"surface_{q}", 1, per, doc=f"s of {q}"),
        Signal(f"switching_gain_{q}", 1, per_square, low=(0.0,), doc=f"|K sigma(s)| of {q}"),
    ]


def _held_at(own: _Channel) -> Ends | None:
    """Return what g is held within."""
    if own.least is None:
        return None
    return (own.least, WIDE) if own.least > 0 else (-WIDE, own.least)


def _texts(plant: Plant, channels: list[_Channel]) -> list[str]:
    """Return q'' of each channel as text."""
    names = plant.symbol_names()
    return [
        f"{equation_text(own.f, names)[0]} + ({equation_text(own.g, names)[0]}) {own.command.signal.name}"
        for own in channels
    ]


def _oracle(plant: Plant, channels: list[_Channel]) -> reference.SlidingMode:
    """Lower the plant's rates, and tell the oracle which rows are asked for: f and g it finds itself."""
    rates = ca.densify(plant.without_noise(plant.dynamics_expression()))
    columns, start = {}, 0
    for symbol in plant.inputs:
        columns[symbol.signal.name] = start
        start += symbol.signal.size
    return reference.SlidingMode(
        numpy_callable(ca.Function("rates", [plant.x, plant.u, plant.p], [rates])),
        tuple((s.signal.name, s.signal.size, s.error_at.stop - s.error_at.start) for s in plant.states),
        tuple((item.signal.name, item.signal.size) for item in plant.inputs),
        tuple((item.signal.name, item.signal.size) for item in plant.parameters),
        tuple(
            reference.Channel(
                own.name, own.state.error_at.start, own.command.signal.name, columns[own.command.signal.name],
                own.wraps, own.switching.kind,
                own.switching.system.reference() if own.switching.system is not None else None, _held_at(own), own.limits,
            )
            for own in channels
        ),
    )  # fmt: skip


def _far(plant: Plant, own: _Channel, channels: list[_Channel]) -> float:
    """Return an acceleration for which a command that is held leaves its limits; 0 where none is."""
    if own.limits is None:
        return 0.0
    largest = max(map(abs, _bounds_of(own.g, plant, channels)))
    return 1.5 * max(map(abs, own.limits)) * (largest if math.isfinite(largest) else 1.0)


def _following(
    plant: Plant, taken: Mapping[str, Symbol], aims: Mapping[str, tuple[Symbol, ...]], channels: list[_Channel]
) -> Calls:
    """Return steps in which states wander over what is ordinary of their ranges, and references beside them."""
    moving = {own.name: own.rate_state(plant) for own in channels}
    widths = {own.name: own.switching.width or 0.1 for own in channels}
    far = {own.name: _far(plant, own, channels) for own in channels}
    spans = {
        name: [middle_of(ends, NEAR) for ends in zip(symbol.signal.low, symbol.signal.high, strict=True)]
        for name, symbol in taken.items()
    }

    def calls(rng: Any, steps: int) -> Iterator[tuple[str, dict[str, Any]]]:
        yield "init", {}
        drive = {name: np.zeros(len(ends)) for name, ends in spans.items()}
        for k in range(steps):
            inputs = {}
            for name, ends in spans.items():
                drive[name] = 0.8 * drive[name] + 0.6 * rng.normal(size=len(ends))
                inputs[name] = np.array([c + half * np.tanh(x) for (c, half), x in zip(ends, drive[name], strict=True)])
            for name, (value, rate, acceleration) in aims.items():
                moved = moving[name]
                middle = inputs[moved.name] if moved is not None and moved.name in inputs else 0.0
                beyond = far[name] * (-1) ** (k // 8) if k % 8 == 7 else 0.0
                for symbol, about in ((value, inputs[name]), (rate, middle), (acceleration, beyond)):
                    wanted = about + 2 * widths[name] * np.tanh(rng.normal())
                    inputs[symbol.signal.name] = np.clip(np.ravel(wanted), symbol.signal.low, symbol.signal.high)
            yield "step", inputs

    return calls
