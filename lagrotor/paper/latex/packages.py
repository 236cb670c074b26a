r"""Commands of common packages (physics, siunitx, bm, mathtools, braket …), in terms of what amsmath has."""

import re
from collections.abc import Iterable
from itertools import zip_longest

from lagrotor.paper.latex.expansion import Expander, Package
from lagrotor.paper.latex.tokens import Token, latex_of, tokenize


def _as(template: str, count: int = 1) -> Package:
    """A command of `count` arguments that stands for the template."""

    def take(expander: Expander) -> Iterable[Token]:
        expander.star()
        text = template
        for place in range(1, count + 1):
            text = text.replace(f"#{place}", latex_of(expander.argument()))
        return tokenize(text)

    return take


def _is(text: str) -> Package:
    """A command without arguments that stands for the text."""
    return lambda expander: tokenize(text)


def _between(left: str, right: str) -> Package:
    r"""\abs{x}, \abs\Big{x}, \abs[\big]{x}: brackets that grow."""

    def take(expander: Expander) -> Iterable[Token]:
        expander.star()
        expander.optional()
        _pass_size(expander)
        return tokenize(rf"\left{left} {latex_of(expander.argument())} \right{right}")

    return take


def _pass_size(expander: Expander) -> None:
    r"""Take \big before a bracket, which grows by itself."""
    expander.skip_spaces()
    if (following := expander.peek()) is not None and re.fullmatch(r"\\[bB]igg?", following.text):
        expander.next()


def _quantity(expander: Expander) -> Iterable[Token]:
    r"""\qty(…), \qty[…], \qty|…|, \qty{…}; \qty{9.81}{m/s} of siunitx where two arguments in braces follow."""
    expander.star()
    _pass_size(expander)
    if (inside := _braced(expander)) is not None:
        if "siunitx" in expander.loaded and expander.begins("{"):
            return _with_unit(inside, expander.argument())
        return tokenize(rf"\left\{{ {inside} \right\}}")
    for left, right in (("(", ")"), ("[", "]"), ("|", "|")):
        if (given := expander.delimited(left, right)) is not None:
            return tokenize(rf"\left{left} {latex_of(given)} \right{right}")
    return ()


def _derivative(mark: str, two: bool = False) -> Package:
    r"""\dv{x}, \dv{f}{x}, \dv[2]{f}{x}, \dv{x}(f); with partial marks also \pdv{f}{x}{y}; two: \pd{f}{x} of commath."""

    def take(expander: Expander) -> Iterable[Token]:
        slash = expander.star()
        order = latex_of(expander.optional() or ()).strip()
        first = latex_of(expander.argument())
        rest: list[str] = []
        while len(rest) < (2 if mark == r"\partial" and not two else 1) and expander.begins("{"):
            rest.append(latex_of(expander.argument()))
        order = "" if len(rest) > 1 else order  # of both letters it is 2, whatever is given
        if not rest:
            inside = expander.delimited("(", ")") if expander.begins("(") else None
            operand = "" if inside is None else rf"\left( {latex_of(inside)} \right)"
            return tokenize(_quotient(mark, "", [(first, order)], order) + operand)
        return tokenize(_quotient(mark, first, [(each, order) for each in rest], order or str(len(rest)), slash))

    return take


def _quotient(mark: str, of: str, by: list[tuple[str, str]], order: str, slash: bool = False) -> str:
    """The derivative of `of` by variables, each with its order."""
    power = f"^{{{order}}}" if order not in ("", "1") else ""
    below = " ".join(f"{mark} {each}" + (f"^{{{times}}}" if times not in ("", "1") else "") for each, times in by)
    if slash:
        return rf"\left.{mark}{power} {of}\middle/{below}\right."
    return rf"\frac{{{mark}{power} {of}}}{{{below}}}"


def _braced(expander: Expander) -> str | None:
    """What is in braces where these come next."""
    return latex_of(expander.argument()) if expander.begins("{") else None


def _listed_derivative(mark: str, package: str) -> Package:
    r"""\diffp[2,3]{f}{x,y}[a] of diffcoeff, \diffp*{f}{{x^2}{y}}{a} of esdiff, \pdv[order={2,3}]{f}{x,y} of derivative."""

    def take(expander: Expander) -> Iterable[Token]:
        star = expander.star()
        _ = expander.star("!") or expander.star("/")
        option = latex_of(expander.optional() or ()).strip()
        if package == "derivative":
            said = re.search(r"order\s*=\s*(?:\{([^{}]*)\}|([^,]*))", option)
            option = said[1] or said[2] if said else ""
        orders = [each.strip() for each in option.split(",")]
        of = latex_of(expander.argument())
        expander.star("/")
        variables = expander.argument()
        if package == "esdiff":
            parts = [latex_of(part) for part in _groups(variables)]
            raised = [re.fullmatch(r"(.*?)\^\{?(\w+)\}?", part) for part in parts]
            by = [(m[1], m[2]) if m else (part, "") for m, part in zip(raised, parts, strict=True)]
        else:
            names = [re.sub(r"^\{(.*)\}$", r"\1", each.strip()) for each in latex_of(variables).split(",")]
            by = [(name, order) for name, order in zip_longest(names, orders[: len(names)], fillvalue="")]
        if len(by) == 1 and package == "esdiff":
            by = [(by[0][0], orders[0] or by[0][1])]
        times = [order or "1" for _, order in by]
        total = str(sum(map(int, times))) if all(map(str.isdecimal, times)) else "+".join(times)
        appended = star and package != "esdiff"
        made = _quotient(mark, "" if appended else of, by, total) + (f" {of}" if appended else "")
        held = (expander.argument() if star else None) if package == "esdiff" else None
        if package == "diffcoeff":
            held = expander.optional()
        at = rf"_{{{latex_of(held)}}}" if held is not None else ""
        if at or (package == "derivative" and expander.begins("_")):
            made = rf"\left({made}\right)" if mark == r"\partial" else rf"\left.{made}\right|"
        return tokenize(made + at)

    return take


def _groups(tokens: list[Token]) -> Iterable[list[Token]]:
    """What is in braces, group by group; all where there is none."""
    if not any(each.kind == "open" for each in tokens[:1]):
        return [tokens]
    parts: list[list[Token]] = []
    depth = 0
    for each in tokens:
        depth -= each.kind == "close"
        if depth:
            parts[-1].append(each)
        elif each.kind == "open":
            parts.append([])
        depth += each.kind == "open"
    return parts


def _indices(expander: Expander) -> Iterable[Token]:
    r"""\Gamma\indices{^k_i_j} of tensor as \Gamma^{k}_{i j}."""
    held = re.findall(r"([_^])\s*(\{[^{}]*\}|\\[A-Za-z]+|\S)", latex_of(expander.argument()))
    rows = {sign: " ".join(part.strip("{}") for each, part in held if each == sign) for sign in "^_"}
    return tokenize("".join(f"{sign}{{{row}}}" for sign, row in rows.items() if row))


def _differential(expander: Expander) -> Iterable[Token]:
    r"""\dd x, \dd{x}, \dd[3]{x}, \dd(x); \odif{x,y} of derivative, \dl{x,y} of diffcoeff."""
    order = latex_of(expander.optional() or ()).strip().removeprefix("order").lstrip(" =")
    head = rf"\,\mathrm{{d}}^{{{order}}}" if order else r"\,\mathrm{d}"
    if not expander.begins("{"):
        return tokenize(f"{head} ")
    return tokenize("".join(f"{head} {each}" for each in latex_of(expander.argument()).split(",")))


def _operator(body: str) -> Package:
    r"""\grad f, \curl{E}, \div(…)."""

    def take(expander: Expander) -> Iterable[Token]:
        return tokenize(f"{body} {_braced(expander) or ''}")

    return take


def _function(name: str) -> Package:
    r"""\sin(x), \sin[2](x) of physics: the optional argument is a power."""

    def take(expander: Expander) -> Iterable[Token] | None:
        if not expander.begins("["):
            return None
        power = latex_of(expander.optional() or ())
        return [Token("command", name, 0), *tokenize(f"^{{{power}}}")]

    return take


def _text(expander: Expander) -> Iterable[Token] | None:
    r"""\text{\boldmath $u$} is \boldsymbol{u}, \text{$u$} is {u}; other words stay."""
    if not expander.begins("{"):
        return None
    inside = expander.argument()
    formula = re.fullmatch(r"\{?\s*(\\boldmath)?\s*\{?\s*\$([^$]*)\$\s*\}*", latex_of(inside).strip())
    if formula is None:
        return [Token("primitive", r"\text", 0), Token("open", "{", 0), *inside, Token("close", "}", 0)]
    return tokenize(("\\boldsymbol{" if formula[1] else "{") + formula[2] + "}")


_UNITS = {
    "metre": "m", "meter": "m", "second": "s", "kilogram": "kg", "gram": "g", "newton": "N", "joule": "J", "watt": "W",
    "hertz": "Hz", "radian": "rad", "kelvin": "K", "ampere": "A", "volt": "V", "pascal": "Pa", "coulomb": "C", "tesla": "T",
    "degree": r"^\circ", "ohm": r"\Omega", "mole": "mol", "minute": "min", "hour": "h", "litre": "L", "liter": "L",
    "electronvolt": "eV", "percent": r"\%", "henry": "H", "farad": "F", "celsius": "C", "candela": "cd",
}  # fmt: skip
_PREFIXES = {"kilo": "k", "mega": "M", "giga": "G", "milli": "m", "micro": "u", "nano": "n", "centi": "c", "pico": "p"}
_POWERS = {"squared": "2", "cubed": "3"}


def _unit(tokens: Iterable[Token]) -> str:
    r"""\metre\per\second\squared as \mathrm{m\,s^{-2}}; m/s^2 as it is."""
    given = list(tokens)
    if not any(t.kind == "command" for t in given):
        return rf"\mathrm{{{latex_of(given).replace('.', chr(92) + ',')}}}"
    parts: list[str] = []
    per, prefix, before = False, "", ""
    for token in given:
        word = token.text.lstrip("\\")
        if word == "per":
            per = True
        elif word in _PREFIXES:
            prefix = _PREFIXES[word]
        elif word in ("square", "cubic"):
            before = "2" if word == "square" else "3"
        elif word in _POWERS and parts:
            sign = "-" if parts[-1].endswith("^{-1}") else ""
            parts[-1] = f"{parts[-1].removesuffix('^{-1}')}^{{{sign}{_POWERS[word]}}}"
        elif word in _UNITS or token.kind == "text":
            name = prefix + _UNITS.get(word, word.strip())
            power = ("-" if per else "") + (before or ("1" if per else ""))
            parts += [f"{name}^{{{power}}}" if power else name] if name else []
            per, prefix, before = False, "", ""
        else:
            return rf"\mathrm{{{latex_of(given)}}}"
    joined = r"\,".join(parts)
    return rf"\mathrm{{{joined}}}"


def _number(text: str) -> str:
    """3.2e-5 as 3.2 times a power of ten."""
    text = text.replace(" ", "").replace(",", ".")
    match = re.fullmatch(r"([+-]?[\d.]+)[eE]([+-]?\d+)", text)
    return rf"{match[1]}\times 10^{{{int(match[2])}}}" if match else text


def _with_unit(number: str, unit: Iterable[Token]) -> list[Token]:
    return tokenize(rf"{_number(number)}\,{_unit(unit)}")


def _si(expander: Expander) -> Iterable[Token]:
    expander.optional()
    number = latex_of(expander.argument())
    expander.optional()
    return _with_unit(number, expander.argument())


def _num(expander: Expander) -> Iterable[Token]:
    expander.optional()
    return tokenize(_number(latex_of(expander.argument())))


def _only_unit(expander: Expander) -> Iterable[Token]:
    expander.optional()
    return tokenize(_unit(expander.argument()))


def _between_states(expander: Expander) -> Iterable[Token]:
    r"""\expval{A}, \expval{A}{\psi} of physics."""
    expander.star()
    inner = latex_of(expander.argument())
    if (state := _braced(expander)) is None:
        return tokenize(rf"\left\langle {inner} \right\rangle ")
    return tokenize(rf"\left\langle {state} \middle| {inner} \middle| {state} \right\rangle ")


def _product_of_states(expander: Expander) -> Iterable[Token]:
    r"""\braket{a}{b} of physics, \braket{a|b} of braket."""
    expander.star()
    bra = latex_of(expander.argument())
    ket = _braced(expander)
    parts = [bra, ket] if ket else re.split(r"(?<!\\)\||\\(?:mid|vert)(?![A-Za-z])", bra)
    inside = r" \middle| ".join(parts)
    return tokenize(rf"\left\langle {inside} \right\rangle ")


_FUNCTIONS = (
    r"\sin", r"\cos", r"\tan", r"\csc", r"\sec", r"\cot", r"\sinh", r"\cosh", r"\tanh", r"\arcsin", r"\arccos", r"\arctan",
    r"\exp", r"\log", r"\ln",
)  # fmt: skip

_PHYSICS: dict[str, Package] = {
    **dict.fromkeys((r"\dv", r"\derivative"), _derivative(r"\mathrm{d}")),
    **dict.fromkeys((r"\pdv", r"\pderivative", r"\partialderivative"), _derivative(r"\partial")),
    **dict.fromkeys((r"\fdv", r"\functionalderivative"), _derivative(r"\delta")),
    **dict.fromkeys((r"\dd", r"\differential"), _differential),
    **dict.fromkeys((r"\qty", r"\quantity"), _quantity),
    **dict.fromkeys((r"\vb", r"\vectorbold"), _as(r"\mathbf{#1}")),
    **dict.fromkeys((r"\va", r"\vectorarrow"), _as(r"\vec{\mathbf{#1}}")),
    **dict.fromkeys((r"\vu", r"\vectorunit"), _as(r"\hat{\mathbf{#1}}")),
    **dict.fromkeys((r"\abs", r"\absolutevalue"), _between("|", "|")),
    r"\norm": _between(r"\|", r"\|"),
    r"\pqty": _between("(", ")"),
    r"\bqty": _between("[", "]"),
    r"\vqty": _between("|", "|"),
    r"\Bqty": _between(r"\{", r"\}"),
    r"\order": _as(r"\mathcal{O}\left(#1\right)"),
    **dict.fromkeys((r"\eval", r"\evaluated"), _as(r"\left. #1 \right|")),
    **dict.fromkeys((r"\vdot", r"\vnabla"), _is(r"\cdot ")),
    **dict.fromkeys((r"\cross", r"\cp", r"\crossproduct"), _is(r"\times ")),
    r"\grad": _operator(r"\nabla"),
    r"\div": _operator(r"\nabla\cdot"),
    r"\curl": _operator(r"\nabla\times"),
    r"\laplacian": _operator(r"\nabla^{2}"),
    **dict.fromkeys((r"\comm", r"\commutator"), _as(r"\left[ #1, #2 \right]", 2)),
    **dict.fromkeys((r"\pb", r"\poissonbracket", r"\acomm"), _as(r"\left\{ #1, #2 \right\}", 2)),
    r"\qq": _as(r"\quad\text{#1}\quad "),
    **{
        rf"\q{word}": _is(rf"\quad\text{{{word}}}\quad ")
        for word in ("and", "or", "if", "for", "since", "with", "then")
    },
    r"\qc": _is(r",\quad "),
    **dict.fromkeys((r"\var", r"\variation"), _is(r"\delta ")),
    r"\matrixquantity": _between("(", ")"),
    r"\mqty": lambda expander: _matrix(expander),
    r"\pmqty": _as(r"\begin{pmatrix}#1\end{pmatrix}"),
    r"\bmqty": _as(r"\begin{bmatrix}#1\end{bmatrix}"),
    r"\vmqty": _as(r"\begin{vmatrix}#1\end{vmatrix}"),
    r"\ket": _as(r"\left| #1 \right\rangle "),
    r"\bra": _as(r"\left\langle #1 \right|"),
    **dict.fromkeys((r"\braket", r"\ip", r"\innerproduct"), _product_of_states),
    **dict.fromkeys((r"\ev", r"\expval", r"\expectationvalue"), _between_states),
    **dict.fromkeys(
        (r"\mel", r"\matrixel", r"\matrixelement"), _as(r"\left\langle #1 \middle| #2 \middle| #3 \right\rangle ", 3)
    ),
    **dict.fromkeys(
        (r"\ketbra", r"\dyad", r"\op", r"\outerproduct"), _as(r"\left| #1 \right\rangle\left\langle #2 \right| ", 2)
    ),
    **{name: _function(name) for name in _FUNCTIONS},
}


def _matrix(expander: Expander) -> Iterable[Token]:
    for left, right, name in (("(", ")", "pmatrix"), ("[", "]", "bmatrix"), ("|", "|", "vmatrix")):
        if (given := expander.delimited(left, right)) is not None:
            return tokenize(rf"\begin{{{name}}}{latex_of(given)}\end{{{name}}}")
    return tokenize(rf"\begin{{matrix}}{latex_of(expander.argument())}\end{{matrix}}")


_SIUNITX: dict[str, Package] = {
    r"\SI": _si,
    r"\num": _num,
    **dict.fromkeys((r"\si", r"\unit"), _only_unit),
    r"\ang": _as(r"#1^\circ "),
}
_BRAKET: dict[str, Package] = {
    **dict.fromkeys((r"\ket", r"\Ket"), _as(r"\left| #1 \right\rangle ")),
    **dict.fromkeys((r"\bra", r"\Bra"), _as(r"\left\langle #1 \right| ")),
    **dict.fromkeys((r"\braket", r"\Braket"), _product_of_states),
    r"\ketbra": _as(r"\left| #1 \right\rangle\left\langle #2 \right| ", 2),
}
_COMMATH: dict[str, Package] = {
    **dict.fromkeys((r"\od", r"\dod", r"\tod"), _derivative(r"\mathrm{d}", two=True)),
    **dict.fromkeys((r"\pd", r"\dpd", r"\tpd"), _derivative(r"\partial", two=True)),
    r"\abs": _between("|", "|"),
    r"\norm": _between(r"\|", r"\|"),
    r"\del": _between("(", ")"),
    r"\sbr": _between("[", "]"),
    r"\cbr": _between(r"\{", r"\}"),
    r"\eval": _as(r"\left. #1 \right|"),
}
_DERIVATIVES = {
    "esdiff": {r"\diff": r"\mathrm{d}", r"\diffp": r"\partial"},
    "diffcoeff": {r"\diff": r"\mathrm{d}", r"\diffp": r"\partial", r"\dl": ""},
    "derivative": {r"\odv": r"\mathrm{d}", r"\pdv": r"\partial", r"\fdv": r"\delta", r"\odif": ""},
}  # a command of derivatives: its mark; of differentials: none
_SMALL: dict[str, Package] = {
    **dict.fromkeys((r"\bm", r"\pmb"), _as(r"\boldsymbol{#1}")),
    r"\coloneqq": _is(":= "),
    r"\vcentcolon": _is(":"),
    r"\eqqcolon": _is("=: "),
    **dict.fromkeys((r"\mathclap", r"\mathllap", r"\mathrlap", r"\smashoperator", r"\lefteqn"), _as("#1")),
    **dict.fromkeys((r"\Aboxed", r"\boxed", r"\fbox"), _as("#1")),
    **dict.fromkeys((r"\hspace", r"\mspace", r"\phantom", r"\hphantom"), _as(r"\,")),
    **dict.fromkeys((r"\vspace", r"\vphantom", r"\color"), _as("")),
    **dict.fromkeys((r"\mathstrut", r"\displaylimits", r"\hfil"), _is("")),
    **dict.fromkeys((r"\dif", r"\diff"), _is(r"\,\mathrm{d}")),
    r"\indices": _indices,
    r"\textcolor": _as("#2", 2),
    **dict.fromkeys((r"\smash", r"\tcbhighmath"), lambda expander: (expander.optional(), expander.argument())[1]),
    r"\MoveEqLeft": lambda expander: (expander.optional(), ())[1],
    r"\IEEEeqnarraymulticol": _as("#3", 3),
    **dict.fromkeys((r"\mbox", r"\hbox", r"\textnormal", r"\textrm", r"\textit", r"\text"), _text),
    r"\pmatrix": _as(r"\begin{pmatrix}#1\end{pmatrix}"),
    r"\matrix": _as(r"\begin{matrix}#1\end{matrix}"),
    r"\mathchoice": _as("#1", 4),
    r"\lbrack": _is("["),
    r"\rbrack": _is("]"),
}


def commands(loaded: Iterable[str], everything: bool = False) -> dict[str, Package]:
    """The commands of the packages that a source loads; those of all packages where its preamble is not known."""
    names = set(loaded)
    found = dict(_SMALL)
    if everything:
        del found[r"\diff"]  # \diff{f}{x} is a derivative of esdiff and diffcoeff
    if everything or "siunitx" in names:
        found |= _SIUNITX
    if everything or "braket" in names:
        found |= _BRAKET
    for package in names & _DERIVATIVES.keys():
        found |= {
            name: _differential if mark == "" else _listed_derivative(mark, package)
            for name, mark in _DERIVATIVES[package].items()
        }
    if "commath" in names:
        found |= _COMMATH
    if everything or names & {"physics", "physics2"}:
        found |= _PHYSICS
        if not names & {"physics", "physics2"}:
            del found[r"\div"]  # the sign of division
    elif "siunitx" in names:
        found[r"\qty"] = _quantity
    return found
