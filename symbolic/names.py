"""Which names may become C identifiers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from .errors import ModelError

_C_AND_CPP_KEYWORDS = frozenset(
    """
    auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while
    alignas alignof and and_eq asm atomic_cancel bitand bitor bool catch char8_t char16_t char32_t class compl concept
    consteval constexpr constinit const_cast co_await co_return co_yield decltype delete dynamic_cast explicit export
    false friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public
    reinterpret_cast requires static_assert static_cast template this thread_local throw true try typeid typename
    typeof typeof_unqual using virtual wchar_t xor xor_eq
    """.split()
)

# Macros of <math.h>, <complex.h>, <errno.h>, Arduino.h, AVR, CMSIS, Windows and POSIX headers: a struct field of that
# name would be replaced by the preprocessor in somebody's build.
_MACROS = frozenset(
    """
    I J PI HALF_PI TWO_PI DEG_TO_RAD RAD_TO_DEG EULER F E M_E M_PI M_PI_2 M_PI_4 NAN INFINITY HUGE_VAL NULL EOF
    HIGH LOW INPUT OUTPUT DEFAULT EXTERNAL INTERNAL CHANGE RISING FALLING SERIAL DISPLAY LSBFIRST MSBFIRST
    min max abs round sq bit bitSet bitClear bitRead bitWrite constrain radians degrees lowByte highByte interrupts
    noInterrupts near far small huge interface unix linux i386 arm errno assert offsetof stdin stdout stderr signgam
    isnan isinf isfinite isnormal signbit fpclassify complex imaginary _Complex_I setjmp major minor makedev
    __I __O __IO TRUE FALSE ERROR OK SUCCESS BIT UNUSED RESET SET ENABLE DISABLE
    """.split()
)

_STANDARD_MACROS = re.compile(
    r"""U?INT\w*_(MAX|MIN|C) | (U?CHAR|SCHAR|U?SHRT|U?LONG|U?LLONG|SIZE|PTRDIFF|WCHAR|WINT|SIG_ATOMIC)_(MAX|MIN|BIT)
    | (DBL|FLT|LDBL|FE|FP|LC|SEEK)_[A-Z0-9_]+ | DECIMAL_DIG | EXIT_(SUCCESS|FAILURE) | SIG(ABRT|FPE|ILL|INT|SEGV|TERM)
    | SIG_(DFL|ERR|IGN) | (PRI|SCN)[diouxX](LEAST|FAST)?(8|16|32|64|MAX|PTR) | HUGE_VAL[FL] | MATH_ERR(NO|EXCEPT)
    | E(DOM|RANGE|ILSEQ) | BUFSIZ | CLOCKS_PER_SEC | FILENAME_MAX | FOPEN_MAX | L_tmpnam | TMP_MAX | MB_CUR_MAX
    | MB_LEN_MAX | RAND_MAX | NDEBUG | math_errhandling | va_(start|arg|end|copy) | noreturn
    | is(greater|greaterequal|less|lessequal|lessgreater|unordered)
    | u?int(_least|_fast)?(8|16|32|64)_t | u?int(max|ptr)_t | size_t | ptrdiff_t | fpos_t | time_t | clock_t | div_t
    | float_t | double_t | jmp_buf | va_list | fenv_t | fexcept_t | mbstate_t | wint_t | FILE""",
    re.VERBOSE,
)

_HEADERS = frozenset(
    """
    assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic
    stdbool stdckdint stdbit stddef stdint stdio stdlib stdnoreturn string strings tgmath threads time uchar wchar wctype
    unistd pthread features arduino
    """.split()
)
"""Headers that a file of the block's name would hide from its own C."""

_HEADERS_OF_THE_PACKAGE = frozenset("test_vectors example_main fuzz_main machine_main fmi2functions".split())

_PREFIXES_OF_MACROS = {"fe": "FE_OVERFLOW of <fenv.h>", **{word: f"{word.upper()}_OK of <unistd.h>" for word in "rwxf"}}

_WORDS_BEHIND_THE_PREFIX = frozenset(
    """
    model status_text core main library batch series higher place gain downdate is_bounded is_held hold_variances
    hold_factors math H PARAMS_DEFAULT OK GATED CLAMPED SKIPPED RECOVERED BAD_INPUT BAD_PARAM NOT_POSITIVE OVERFLOW
    """.split()
)
"""What the emitter writes behind a block's name and an underscore, beside entries and parts."""

_ENDS_OF_THE_PREFIXED = ("_t", "_core")
_STARTS_OF_THE_PREFIXED = ("math_", "batch_")

_FUNCTIONS_THE_C_CALLS = frozenset(
    """
    sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp expm1 log log1p pow sqrt cbrt fabs floor ceil
    fmin fmax fmod hypot copysign erf main
    """.split()
)

_WORDS_OF_THE_GENERATED_C = frozenset(
    """
    before after params in out state status answer latest spare gate work own highest taken i delta nis row_variance
    row_noise spare_covariance covariance white_residual white_h white_r
    """.split()
)

_ARDUINO_BINARY_CONSTANT = re.compile(r"B[01]{1,8}")
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def why_not_a_name(name: str, kind: str = "") -> str | None:
    """Say why `name` cannot be used in the generated C, or None if it can.

    Parameters
    ----------
    name : str
        The proposed name.
    kind : str
        What is being named: a block also names files and macros, an entry a function.
    """
    if not isinstance(name, str) or not name:
        return "is not a word"
    if name.startswith("_") or "__" in name:
        return "is reserved for C and C++ compilers (a leading or a double underscore)"
    if not _IDENTIFIER.fullmatch(name):
        return "is not a C identifier (letters, digits and underscores, a letter first)"
    if name.endswith("_"):
        return "is reserved for C and C++ compilers once a word is put behind it (a trailing underscore)"
    if len(name) > 48:
        return "is longer than 48 characters"
    if name in _C_AND_CPP_KEYWORDS:
        return "is a keyword of C or C++"
    if name in _MACROS or _ARDUINO_BINARY_CONSTANT.fullmatch(name):
        return "is a macro in common C headers, which would replace it"
    if _STANDARD_MACROS.fullmatch(name):
        return "is a macro or a type of the standard C headers"
    if name in _FUNCTIONS_THE_C_CALLS or (name.endswith("f") and name[:-1] in _FUNCTIONS_THE_C_CALLS):
        return "is a function that the generated C calls"
    if name in _WORDS_OF_THE_GENERATED_C:
        return "is a word that the generated C uses itself"
    return _why_no_block(name) if kind == "block" else _why_no_entry(name) if kind == "entry" else None


def _why_no_block(name: str) -> str | None:
    low = name.lower()  # on some systems Math.h is math.h
    if low in _HEADERS:
        return f"would make a header {name}.h, which hides <{low}.h> of the C library"
    if low in _HEADERS_OF_THE_PACKAGE or low.endswith("_main"):
        return "is what plantc calls files of its own"
    if low in _PREFIXES_OF_MACROS:
        return f"would make the macro {_PREFIXES_OF_MACROS[low]} once more"
    return None


def _why_no_entry(name: str) -> str | None:
    own = name in _WORDS_BEHIND_THE_PREFIX
    if own or name.endswith(_ENDS_OF_THE_PREFIXED) or name.startswith(_STARTS_OF_THE_PREFIXED):
        return "is what the generated C calls a type or a function of its own, behind the block's name"
    return None


def check_name(kind: str, name: str, owner: str) -> str:
    """Return `name`, or raise a ModelError that says what is wrong with it and proposes another.

    Parameters
    ----------
    kind : str
        What is being named, such as ``"state"``.
    name : str
        The proposed name.
    owner : str
        The plant or block, for the message.
    """
    reason = why_not_a_name(name, kind)
    if reason is None:
        return name
    stem = re.sub(r"[^A-Za-z0-9]+", "_", str(name)).strip("_").lower() or kind
    word = kind.split()[-1]
    candidates = [stem, f"{stem}_{word}", f"{word}_{stem}", f"{word}_{stem[:32]}".strip("_"), f"{word}_1"]
    proposal = next(item for item in candidates if item != name and why_not_a_name(item, kind) is None)
    raise ModelError(f"{owner}: the {kind} name {name!r} {reason}; call it {proposal!r}, say")


def check_unique(names: Iterable[tuple[str, str]], owner: str) -> None:
    """Raise a ModelError if two of the (name, what it is) pairs share a name."""
    seen: dict[str, str] = {}
    for name, what in names:
        if name in seen:
            raise ModelError(
                f"{owner}: {what} and {seen[name]} would both be called {name!r} in the generated C; rename one of them"
            )
        seen[name] = what


def name_of(key: Any) -> str:
    """Return the name of a symbol, or of a state of a plant, or the name itself.

    Raises
    ------
    ModelError
        If it is something else.
    """
    found = key if isinstance(key, str) else getattr(getattr(key, "signal", None), "name", None)
    if not isinstance(found, str):
        raise ModelError(f"{key!r} stands where a symbol of the plant or its name is needed; give one")
    return found
