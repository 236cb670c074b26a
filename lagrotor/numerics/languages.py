"""Programs as source in other languages: C, CasADi, JAX, Julia and MATLAB.

One printer writes expressions for all of them. A `Language` is a table of what differs: the names of functions, powers,
assignments, elements of arrays. A `Module` is a list of functions with the same arguments (t, x, p), and `MODULES` has for each
language the function that writes the module as files.
"""

import keyword
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import prod
from typing import Literal

import sympy as sp

from lagrotor.errors import InputError
from lagrotor.numerics.codegen import Program, reduce_common

LanguageName = Literal["c", "casadi", "jax", "julia", "matlab"]
_MOST_FACTORS = 8  # the highest power that is written as a product
_LONGEST_NAME = 50  # characters; MATLAB allows 63
_CIRCULAR = ("sin", "cos", "tan", "sinh", "cosh", "tanh")
_PLAIN = (*_CIRCULAR, *(f"a{name}" for name in _CIRCULAR), "exp", "log", "sqrt", "floor", "sign")


def _named(prefix: str, **others: str) -> dict[str, str]:
    """Return the table of functions of a language: a function has its usual name after the prefix, or one in `others`."""
    usual = dict(zip(_PLAIN, _PLAIN, strict=True))
    return {name: f"{prefix}{text}" for name, text in (usual | {"ceiling": "ceil", "atan2": "atan2"} | others).items()}


@dataclass(frozen=True)
class Language:
    """The syntax of one language: function names, a power, an assignment, and an element of an array."""

    functions: Mapping[str, str]
    power: str
    assignment: str = "{} = {}"
    element: str = "{}[{}]"
    first: int = 0


_C = Language(
    _named("", Abs="fabs", Max="fmax", Min="fmin", sign="(double)SIGN"), "pow({}, {})", "const double {} = {};"
)
_CASADI = Language(_named("ca.", Abs="fabs", Max="fmax", Min="fmin"), "({})**({})")
_JAX = Language(
    _named(
        "jnp.",
        **{f"a{name}": f"arc{name}" for name in _CIRCULAR},
        atan2="arctan2",
        Abs="abs",
        Max="maximum",
        Min="minimum",
    ),
    "({})**({})",
)
_JULIA = Language(_named("", Abs="abs", Max="max", Min="min", atan2="atan"), "({})^({})", first=1)
_MATLAB = Language(_named("", Abs="abs", Max="max", Min="min"), "({})^({})", "{} = {};", "{}({})", first=1)

# Functions that are written by others, in every language.
_REWRITTEN: dict[type, Callable[..., sp.Expr]] = {
    sp.sech: lambda x: 2 * sp.exp(-sp.Abs(x)) / (1 + sp.exp(-2 * sp.Abs(x))),  # cosh would overflow
    sp.csch: lambda x: 1 / sp.sinh(x),
    sp.coth: lambda x: 1 / sp.tanh(x),
    sp.sec: lambda x: 1 / sp.cos(x),
    sp.csc: lambda x: 1 / sp.sin(x),
    sp.cot: lambda x: 1 / sp.tan(x),
    sp.acot: lambda x: sp.atan(1 / x),
    sp.asec: lambda x: sp.acos(1 / x),
    sp.acsc: lambda x: sp.asin(1 / x),
    sp.acoth: lambda x: sp.atanh(1 / x),
    sp.asech: lambda x: sp.acosh(1 / x),
    sp.acsch: lambda x: sp.asinh(1 / x),
    sp.Heaviside: lambda x, at_zero: (1 + sp.sign(x)) / 2,
    sp.DiracDelta: lambda x: sp.S.Zero,  # the slope of a sign beside its jump
}

# Keywords of C, of C++ with what compilers define, of Julia, of MATLAB and Octave; then names in the files.
_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register restrict
return short signed sizeof static struct switch typedef union unsigned void volatile while
alignas alignof and and_eq asm bitand bitor bool catch char16_t char32_t class compl concept constexpr const_cast decltype
delete dynamic_cast explicit export false friend mutable namespace new noexcept not not_eq nullptr operator or or_eq private
protected public reinterpret_cast requires static_assert static_cast template this thread_local throw true try typeid typename
typeof using virtual wchar_t xor xor_eq linux unix
abstract baremodule begin elseif end finally function global import in isa let local macro module outer primitive quote type
where pi im
classdef endfunction endif endfor endwhile endswitch otherwise parfor persistent spmd until unwind_protect end_try_catch
end_unwind_protect ans eps reshape zeros
ca jnp jax eye math pow fabs fmax fmin abs max min ceil atan2 t x p a d i j column SIGN NAN INFINITY DOMAIN SING
OVERFLOW UNDERFLOW
"""
_RESERVED = {*keyword.kwlist, *_WORDS.split(), *_PLAIN}


@dataclass(frozen=True)
class Function:
    """A function of a module.

    Its program has the arguments t, entries of x and of p, and entries of one more array if `extra` names one. A function that
    is `linear` in that array is written as the matrix of its columns, one for each entry. `symbols` has the symbol of the module
    for each argument of the program.
    """

    name: str
    says: str
    program: Program
    symbols: Mapping[sp.Symbol, sp.Symbol]
    output: str
    shape: tuple[int, ...]
    extra: str = ""
    linear: bool = False

    @property
    def arguments(self) -> tuple[str, ...]:
        return ("t", "x", "p", *((self.extra,) if self.extra and not self.linear else ()))


@dataclass(frozen=True)
class Module:
    """Functions with a common state and common parameters. `places` has the array, the index and the identifier of each symbol,
    the time excepted. `origin` is the first line of the comment at the top, and `says` explains entries of arrays in words."""

    name: str
    functions: tuple[Function, ...]
    places: Mapping[sp.Symbol, tuple[str, int, str]]
    origin: str
    says: Mapping[sp.Symbol, str]

    def head(self, language: Language) -> list[str]:
        """Return the lines of the comment at the top: the origin, and the entries of the arrays in words."""
        places = ((self.places[s], text) for s, text in self.says.items())
        entries = (f"{language.element.format(name, i + language.first)}  {text}" for (name, i, _), text in places)
        return [self.origin, *(" ".join(line.split()) for line in entries)]


def identifiers(texts: Iterable[str], reserved: Iterable[str] = ()) -> list[str]:
    """Return a different identifier for each text, which no language reserves: letters, digits and underscores."""
    used = _RESERVED.union(reserved)
    return [_identifier(text, used) for text in texts]


def _identifier(text: str, used: set[str]) -> str:
    """Return an identifier that is not used, and mark it as used."""
    spelt = "".join(c if c.isascii() else _spelt(c) for c in text)
    stem = re.sub(r"\W", "_", spelt, flags=re.ASCII).strip("_")[:_LONGEST_NAME]
    if not stem[:1].isalpha() or re.match(r"(M|FP|HUGE)_|s\d+$", stem):  # constants of C, stages of programs
        stem = f"v_{stem}"
    name, number = stem, 2
    while name in used:
        name, number = f"{stem}_{number}", number + 1
    used.add(name)
    return name


def _spelt(character: str) -> str:
    """Return the name of a Greek letter, or the number of any other character."""
    words = unicodedata.name(character, "").split()
    return words[-1].lower() if words[:1] == ["GREEK"] else f"u{ord(character):x}"


@dataclass
class _Writer:
    """A printer of expressions, which writes assignments where an expression needs a base twice."""

    language: Language
    names: dict[sp.Symbol, str]
    lines: list[str] = field(default_factory=list)
    made: int = 0

    def keep(self, text: str) -> str:
        name, self.made = f"s{self.made}", self.made + 1
        self.lines.append(self.language.assignment.format(name, text))
        return name

    def factor(self, e: sp.Expr) -> str:
        text = self.text(e)
        return text if re.fullmatch(r"[\w.]+(\(\w*\))?", text) else f"({text})"

    def text(self, e: sp.Expr) -> str:
        if e.is_Symbol:
            return self.names[e]
        if e.is_Add:
            terms = sorted((self.text(term) for term in e.args), key=lambda text: text[0] == "-")
            return terms[0] + "".join(f" - {term[1:]}" if term[0] == "-" else f" + {term}" for term in terms[1:])
        if e.is_Mul:
            return self._product(e)
        if e.is_Pow:
            return self._power(e)
        if e.is_number and e.is_finite and not e.args:
            return repr(float(e))
        if form := _REWRITTEN.get(e.func):
            return self.text(form(*e.args))
        if e.func in (sp.Max, sp.Min) and len(e.args) > 2:
            return self.text(e.func(e.func(*e.args[:2], evaluate=False), *e.args[2:], evaluate=False))
        if isinstance(e, sp.Derivative | sp.Subs):
            raise InputError(
                "export: the derivative of a step, as of floor(x), has no code: write the case that applies"
            )
        if e.func.__name__ not in self.language.functions:
            raise InputError(f"export: {e} has no code in the other language: write it with elementary functions")
        arguments = ", ".join(self.text(x) for x in e.args)
        return f"{self.language.functions[e.func.__name__]}({arguments})"

    def _product(self, e: sp.Expr) -> str:
        number, above, below = sp.S.One, list[sp.Expr](), list[sp.Expr]()
        for f in e.args:
            if f.is_Number:
                number *= f
            elif f.is_Pow and f.exp.is_Number and f.exp.is_negative:
                below.append(sp.Pow(f.base, -f.exp))
            else:
                above.append(f)
        size = [repr(float(abs(number)))] * (abs(number) != 1 or not above)
        text = "*".join([*size, *map(self.factor, above)])
        if below:
            divisor = "*".join(map(self.factor, below))
            text += f"/({divisor})" if len(below) > 1 else f"/{divisor}"
        return f"-{text}" if number.is_negative else text

    def _power(self, e: sp.Expr) -> str:
        n = e.exp
        if n.is_Number and n.is_negative:
            return f"1.0/{self.factor(sp.Pow(e.base, -n))}"
        if n == sp.Rational(1, 2):
            return f"{self.language.functions['sqrt']}({self.text(e.base)})"
        if n.is_Rational and n.q <= 2 and n < _MOST_FACTORS:
            base = self.text(e.base) if e.base.is_Symbol else self.keep(self.text(e.base))
            root = [f"{self.language.functions['sqrt']}({base})"] * (n.q == 2)
            return "*".join([base] * int(sp.floor(n)) + root)
        return self.language.power.format(self.text(e.base), self.text(n))


def _body(module: Module, function: Function, language: Language) -> tuple[list[str], list[str]]:
    """Return the lines that compute a function, and the texts of its outputs."""
    stages, outputs = reduce_common(function.program)
    used = set().union(*(e.free_symbols for e in (*(e for _, e in stages), *outputs)))
    writer = _Writer(language, {})
    for argument, symbol in function.symbols.items():
        array, index, name = module.places.get(symbol, ("", 0, "t"))
        writer.names[argument] = name
        if array and argument in used:
            element = language.element.format(array, index + language.first)
            writer.lines.append(language.assignment.format(name, element))
    for name, e in stages:
        writer.names[name] = writer.names[e] if e.is_Symbol else writer.keep(writer.text(e))
    return writer.lines, [writer.text(e) for e in outputs]


def _indented(lines: Iterable[str]) -> str:
    return "".join(f"    {line}\n" for line in lines)


def _c_module(module: Module) -> dict[str, str]:
    name, upper = module.name, module.name.upper()
    head = "".join(f" * {line}\n" for line in module.head(_C)).replace("*/", "* /")
    head = f"/*{head[2:]} */\n"
    arrays = [array for array, _, _ in module.places.values()]
    lengths = {"STATES": arrays.count("x"), "PARAMETERS": arrays.count("p")}
    lengths |= {f"{f.name.upper()}_LENGTH": prod(f.shape) for f in module.functions}
    header = f"{head}\n#ifndef {upper}_H\n#define {upper}_H\n\n"
    header += "".join(f"#define {upper}_{length} {number}\n" for length, number in lengths.items())
    header += '\n#ifdef __cplusplus\nextern "C" {\n#endif\n'
    source = f'{head}\n#include "{name}.h"\n\n#include <math.h>\n\n'
    source += "#define SIGN(z) (((z) > 0.0) - ((z) < 0.0))\n"
    for f in module.functions:
        lines, outputs = _body(module, f, _C)
        extra = f", const double *{f.extra}" if f.extra else ""
        says = f"{f.says}{' Rows come one after the other.' if len(f.shape) == 2 else ''}"
        common = "(double t, const double *x, const double *p"
        written = "\n".join((*lines, *outputs))
        unused = [f"(void){s};" for s in ("t", "x", "p", f.extra) if s and not re.search(rf"\b{s}\b", written)]
        result = "column" if f.linear else f.output
        ends = [f"{result}[{i}] = {e};" for i, e in enumerate(outputs)]
        signature = f"void {name}_{f.name}{common}{'' if f.linear else extra}, double *{f.output})"
        header += f"\n/* {says} */\n{signature};\n"
        if f.linear:
            n, rows = f.shape[1], f.shape[0]
            column = f"{name}_{f.name}_column"
            source += f"\nstatic void {column}{common}{extra}, double *{result})\n"
            source += f"{{\n{_indented([*unused, *lines, *ends])}}}\n\n{signature}\n{{\n"
            loop = [f"double {f.extra}[{n}] = {{0.0}}, column[{rows}];", "int i, j;", f"for (j = 0; j < {n}; j++) {{"]
            loop += [
                f"    {f.extra}[j] = 1.0;",
                f"    {column}(t, x, p, {f.extra}, column);",
                f"    {f.extra}[j] = 0.0;",
            ]
            loop += [f"    for (i = 0; i < {rows}; i++)", f"        {f.output}[i * {n} + j] = column[i];", "}"]
            source += f"{_indented(loop)}}}\n"
        else:
            source += f"\n{signature}\n{{\n{_indented([*unused, *lines, *ends])}}}\n"
    header += f"\n#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {upper}_H */\n"
    return {f"{name}.h": header, f"{name}.c": source}


def _python_module(
    language: Language, suffix: str, imports: str, result: Callable[[Function, str], str], module: Module
) -> dict[str, str]:
    """Return the Python module. `result` returns the text of a function's value, given the texts of its outputs."""
    text = "".join(f"# {line}\n" for line in module.head(language)) + f"\n{imports}\n"
    for f in module.functions:
        lines, outputs = _body(module, f, language)
        helper = f"_{f.name}_column" if f.linear else f"{module.name}_{f.name}"
        arguments = ", ".join((*f.arguments, *((f.extra,) if f.linear else ())))
        column = replace(f, shape=f.shape[:1], linear=False)
        text += f"\n\ndef {helper}({arguments}):\n"
        text += "" if f.linear else f'    """{f.says}"""\n'
        text += _indented([*lines, f"return {result(column if f.linear else f, ', '.join(outputs))}"])
        if f.linear:
            text += f"\n\ndef {module.name}_{f.name}(t, x, p):\n" + f'    """{f.says}"""\n'
            text += f"    return {result(f, helper)}\n"
    return {f"{module.name}{suffix}.py": text}


def _casadi_value(f: Function, outputs: str) -> str:
    if f.linear:
        n = f.shape[1]
        return f"ca.horzcat(*[{outputs}(t, x, p, [float(i == j) for i in range({n})]) for j in range({n})])"
    if not f.shape:
        return outputs
    column = f"ca.vertcat({outputs})"
    return column if len(f.shape) == 1 else f"ca.reshape({column}, {f.shape[1]}, {f.shape[0]}).T"


def _jax_value(f: Function, outputs: str) -> str:
    if f.linear:
        return f"jax.vmap(lambda d: {outputs}(t, x, p, d), out_axes=1)(jnp.eye({f.shape[1]}))"
    if not f.shape:
        return f"jnp.asarray({outputs})"
    array = f"jnp.array([{outputs}], dtype=float)"
    return array if len(f.shape) == 1 else f"{array}.reshape({f.shape[0]}, {f.shape[1]})"


_JAX_IMPORTS = """# Long programs are slow unless XLA_FLAGS=--xla_disable_hlo_passes=fusion is set before JAX is imported.
import jax
import jax.numpy as jnp

jax.config.update("jax_enable_x64", True)  # without it JAX computes with 7 digits"""


def _julia_module(module: Module) -> dict[str, str]:
    text = "".join(f"# {line}\n" for line in module.head(_JULIA))
    for f in module.functions:
        lines, outputs = _body(module, f, _JULIA)
        arguments = ", ".join(("x", "p", "t", *f.arguments[3:]))
        says, name = f"\n# {f.says}\n", f"{module.name}_{f.name}"
        if f.linear:
            n = f.shape[1]
            ends = [f"{f.output}[{i + 1}, j] = {e}" for i, e in enumerate(outputs)]
            text += f"\nfunction _{name}_column!({f.output}, x, p, t, {f.extra}, j)\n"
            text += f"{_indented([*lines, *ends, 'return nothing'])}end\n"
            loop = [f"for j in 1:{n}", f"    {f.extra} = [i == j ? 1.0 : 0.0 for i in 1:{n}]"]
            loop += [f"    _{name}_column!({f.output}, x, p, t, {f.extra}, j)", "end", f"return {f.output}"]
            text += f"{says}function {name}!({f.output}, {arguments})\n{_indented(loop)}end\n"
        elif not f.shape:
            text += f"{says}function {name}({arguments})\n{_indented([*lines, f'return {outputs[0]}'])}end\n"
        else:
            n = f.shape[-1]
            places = [f"{i // n + 1}, {i % n + 1}" if len(f.shape) == 2 else str(i + 1) for i in range(len(outputs))]
            ends = [f"{f.output}[{place}] = {e}" for place, e in zip(places, outputs, strict=True)]
            text += f"{says}function {name}!({f.output}, {arguments})\n"
            text += f"{_indented([*lines, *ends, f'return {f.output}'])}end\n"
    return {f"{module.name}.jl": text}


def _matlab_module(module: Module) -> dict[str, str]:
    files = dict[str, str]()
    head = "".join(f"% {line}\n" for line in module.head(_MATLAB))
    for f in module.functions:
        lines, outputs = _body(module, f, _MATLAB)
        name, n = f"{module.name}_{f.name}", prod(f.shape[1:])
        column = f"[{'; '.join(f'({e})' for e in outputs)}]"
        value = f"reshape({column}, {n}, {f.shape[0]}).'" if len(f.shape) == 2 and not f.linear else column
        text = f"function {f.output} = {name}({', '.join(f.arguments)})\n% {f.says}\n%\n{head}\n"
        if f.linear:
            loop = [f"{f.output} = zeros({f.shape[0]}, {n});", f"{f.extra} = zeros({n}, 1);", f"for j = 1:{n}"]
            loop += [f"    {f.extra}(j) = 1;", f"    {f.output}(:, j) = {f.name}_column(t, x, p, {f.extra});"]
            text += _indented([*loop, f"    {f.extra}(j) = 0;", "end"]) + "end\n\n"
            text += f"function column = {f.name}_column(t, x, p, {f.extra})\n"
        text += _indented([*lines, f"{'column' if f.linear else f.output} = {value};"]) + "end\n"
        files[f"{name}.m"] = text
    return files


MODULES: Mapping[LanguageName, Callable[[Module], dict[str, str]]] = {
    "c": _c_module,
    "casadi": partial(_python_module, _CASADI, "_casadi", "import casadi as ca", _casadi_value),
    "jax": partial(_python_module, _JAX, "_jax", _JAX_IMPORTS, _jax_value),
    "julia": _julia_module,
    "matlab": _matlab_module,
}
