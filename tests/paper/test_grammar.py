"""The one reader of expressions: what it reads, and that nothing that it reads can run."""

from contextlib import suppress
from pathlib import Path

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from lagrotor.errors import InputError
from lagrotor.paper import Paper, judge
from lagrotor.paper.grammar import Letters, read, vector
from lagrotor.paper.proof import form

x, y = sp.symbols("x y", real=True)
r = vector("r")
NAMES = {"x": x, "y": y, "r": r}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1/3 + 0.5*x", sp.Rational(1, 3) + x / 2),
        ("-x**2 + 2*(x - y)", -(x**2) + 2 * (x - y)),
        ("1e-3*x", x / 1000),
        ("1_000*x", 1000 * x),
        ("sin(x)**2\n + cos(x)", sp.sin(x) ** 2 + sp.cos(x)),
        ("(r.T*r)[0]", None),
        ("r.T*r", r.T * r),
        ("diff(x**2*y, x).subs(x, 3)", 6 * y),
        ("rate(x**2, (x,), (y,))", 2 * x * y),
        ("Rational(1, 2) + Integer(2)", sp.Rational(5, 2)),
        ("exp(1) - pi", sp.E - sp.pi),
        ("+x", x),
    ],
)
def test_formulas_are_read(text: str, value: object) -> None:
    if value is None:
        with pytest.raises(InputError, match="is no part of an expression"):
            read(text, NAMES, "here")
    else:
        assert read(text, NAMES, "here") == value


# Each would call something, or reach what is no formula, if it were evaluated.
HOSTILE = [
    "open('{mark}', 'w')",
    "().__class__.__bases__[0].__subclasses__()",
    "x.__class__",
    "(lambda: 0)()",
    "(x := 3)",
    "f'{{open(1)}}'",
    "'x'",
    "eval('1')",
    "getattr(x, y)",
    "x.subs({{x: 1}})",
    "sin(x, evaluate=False)",
    "x[0]",
    "x < y",
    "x @ y",
    "x ^ y",
    "2.5J",
    "...",
    "True",
    "x(3)",
    "x = y",
    "9**9**9",
    "2**x**10000",
    "(9**999)**999",
    "10**-100000",
    "1" * 500,
    "eye(10**8)",
    "(" * 5000 + "x" + ")" * 5000,
    "",
    "\0",
]


KEPT = ("(9**999)**999",)  # printed as it stands, without being computed


@pytest.mark.parametrize("text", HOSTILE)
def test_what_is_no_formula_is_refused_and_does_not_run(text: str, tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    written = text.format(mark=mark) if "{" in text else text
    for door in (
        lambda: read(written, NAMES, "here"),
        lambda: judge(written, x * y),
        lambda: form(written, x=x, y=y).value(Letters()),
        *((lambda: form(written, x=x, y=y).tex(Letters()),) if text not in KEPT else ()),
    ):
        with pytest.raises(InputError):
            door()
    assert not mark.exists()


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("equations.toml", "members = [\"__import__('pathlib').Path('{mark}').touch()\"]"),
        ("equations.toml", "members = [\"x\"]\nsmall = \"open('{mark}', 'w')\""),
        ("equations.toml", "members = [\"x\"]\nread_off = \"open('{mark}', 'w')\""),
        ("equations.toml", "members = [\"x\"]\nscene = {{ x = \"open('{mark}', 'w')\" }}"),
        ("equations.toml", 'members = ["x"]\nscene = {{ "open(\'{mark}\', \'w\')" = "1" }}'),
    ],
)
def test_a_papers_file_cannot_run(file: str, line: str, tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    (tmp_path / "paper.toml").write_text('title = "T"\n[sections]\n1 = "S"\n')
    head = '[letters.1]\nreal = "x"\n[[equation]]\nid = "1.1"\nsection = "1"\ntitle = "t"\nlatex = "x"\n'
    (tmp_path / file).write_text(f"{head}[[equation.line]]\nquantity = 'x'\n{line.format(mark=mark)}\n")
    with pytest.raises(InputError):
        Paper(tmp_path).lines("1.1")
    assert not mark.exists()


leaves = st.sampled_from([("x", x), ("y", y), ("2", sp.Integer(2)), ("0.25", sp.Rational(1, 4)), ("pi", sp.pi)])
SIGNS = {"+": sp.Add, "-": lambda a, b: a - b, "*": sp.Mul, "/": lambda a, b: a / b}
written = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(
            lambda t: (f"({t[0][0]}) {t[1]} ({t[2][0]})", SIGNS[t[1]](t[0][1], t[2][1]))
        ),
        inner.map(lambda t: (f"sin({t[0]})", sp.sin(t[1], evaluate=not t[1].has(sp.sin)))),
        inner.map(lambda t: (f"-({t[0]})", -t[1])),
        st.tuples(inner, st.integers(-3, 3)).map(lambda t: (f"({t[0][0]})**{t[1]}", t[0][1] ** t[1])),
    ),
    max_leaves=8,
)


@given(written)
def test_a_formula_is_what_its_operators_make_of_it(pair: tuple[str, sp.Expr]) -> None:
    text, value = pair
    assert read(text, NAMES, "here") == value


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused(text: str) -> None:
    with suppress(InputError):
        assert isinstance(read(text, NAMES, "here"), sp.Basic | sp.MatrixBase)
