"""Straight-line programs: common subexpressions, number of operations, derivatives; `printers` writes them as code.

A `Program` is a list of named stages and the outputs made of them. A stage names a quantity of the derivation, for
example a matrix element or a pivot, so that its products are not expanded. Common subexpressions are extracted afterwards.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter

import sympy as sp
from sympy.simplify.cse_main import tree_cse

from lagrotor.algebra import derivative
from lagrotor.algebra.name_clashes import check_names
from lagrotor.errors import InputError, SingularError

Stage = tuple[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Program:
    """A straight-line program, arguments → stages → outputs. A stage may use the arguments and the stages before it. If `shared`
    is true, the stages already share their common parts; then only equal subexpressions are sought, in linear time. The
    expressions in `positive` are positive where the program is well conditioned."""

    arguments: tuple[sp.Symbol, ...]
    stages: tuple[Stage, ...]
    outputs: tuple[sp.Expr, ...]
    shared: bool = False
    positive: tuple[sp.Expr, ...] = ()

    def __post_init__(self) -> None:
        defined = set(self.arguments)
        check_names("Program", self.arguments, tuple(name for name, _ in self.stages))
        for name, expression in (*self.stages, *((None, e) for e in (*self.outputs, *self.positive))):
            if missing := expression.free_symbols - defined:
                check_names("Program", self.arguments, tuple(missing))
                raise SingularError(
                    f"Program: {sorted(map(str, missing))} is used before it is defined: add it to the arguments"
                )
            if name in defined:
                raise InputError(f"Program: {name} names two quantities: rename the symbol of the system")
            if name:
                defined.add(name)

    def __hash__(self) -> int:
        """Return a hash of arguments and outputs; each integration looks up its program, and hashing all stages takes longer."""
        return hash((self.arguments, self.outputs))


@lru_cache(maxsize=16)
def reduce_common(program: Program) -> tuple[Sequence[Stage], Sequence[sp.Expr]]:
    """Compute each subexpression that occurs more than once in a program only once.

    Return the intermediate results (symbol, expression), each after those that it uses, and the outputs in their symbols.
    """
    stages, outputs = list(program.stages), list(program.outputs)
    if program.shared:
        stages = _ordered(dict(stages), outputs)
    names, expressions = [name for name, _ in stages], [*(e for _, e in stages), *outputs]
    if program.shared and not _repeats(expressions):
        return stages, outputs
    symbols = sp.numbered_symbols("c_", exclude=names, real=True)  # also names of stages that no expression uses
    if program.shared:
        common, reduced = tree_cse(expressions, symbols, order="none")
    else:
        common, reduced = sp.cse(expressions, symbols=symbols)
    body = dict(common) | dict(zip(names, reduced[: len(names)], strict=True))
    return _ordered(body, reduced[len(names) :]), reduced[len(names) :]


def _ordered(body: Mapping[sp.Symbol, sp.Expr], outputs: Sequence[sp.Expr]) -> list[Stage]:
    """Return the stages that an output needs, each after the stages that it uses. `body` maps the name of each stage to its
    expression."""
    order: dict[sp.Symbol, None] = {}
    queue = [(s, False) for e in reversed(outputs) for s in _named(e, body)]
    while queue:
        name, ready = queue.pop()
        if ready:
            order[name] = None
        elif name not in order:
            queue += [(name, True), *((s, False) for s in _named(body[name], body) if s not in order)]
    return [(name, body[name]) for name in order]


def _repeats(expressions: Sequence[sp.Expr]) -> bool:
    """Return True if a subexpression occurs twice; a symbol with a minus sign costs nothing in a sum and does not count."""
    stack, visited = list(expressions), set[sp.Basic]()
    while stack:
        e = stack.pop()
        if e.is_Atom or (e.is_Mul and len(e.args) == 2 and e.args[0] is sp.S.NegativeOne and e.args[1].is_Atom):
            continue
        if e in visited:
            return True
        visited.add(e)
        stack += e.args
    return False


def _named(expression: sp.Expr, body: Mapping[sp.Symbol, sp.Expr]) -> list[sp.Symbol]:
    return sorted((s for s in expression.free_symbols if s in body), key=attrgetter("name"), reverse=True)


def operations(program: Program) -> int:
    """Count the arithmetic operations and function calls of one evaluation; each common subexpression counts once.

    Parameters
    ----------
    program : Program
        The stages and outputs.

    Returns
    -------
    int
        The number of operations.
    """
    stages, outputs = reduce_common(program)
    return sum(_count(e) for e in (*(e for _, e in stages), *outputs))


def _count(expression: sp.Expr) -> int:
    """Count the operations of an expression as `sympy.count_ops` does, without its search for a fraction in products that have
    none."""
    stack, count = [expression], 0
    while stack:
        e = stack.pop()
        factors = e.args[1:] if e.is_Mul and e.args[0] is sp.S.NegativeOne else e.args
        if e.is_Symbol:
            continue
        if e.is_Mul and not any(f.is_Pow or f.is_Number or isinstance(f, sp.exp) for f in factors):
            count += len(e.args) - 1  # a sign counts as a factor
            stack += factors
        elif e.is_Add and not any(f.is_Number for f in e.args):
            signs = [f.is_Mul and f.args[0].is_Number and bool(f.args[0] < 0) for f in e.args]
            count += len(e.args) - 1 + all(signs) - sum(signs)  # a difference costs as much as a sum
            stack += e.args
        else:
            count += int(sp.count_ops(e))
    return count


def tangent_program(
    program: Program, slopes: Mapping[sp.Symbol, Sequence[sp.Expr]], arguments: tuple[sp.Symbol, ...]
) -> Program:
    """Return the program of the outputs, followed by k derivatives of each output along k directions. `slopes` gives the k
    derivatives of each argument that changes. Forward differentiation takes at most about k + 1 times the operations."""
    stages, outputs = reduce_common(program)
    derivatives, count = {s: list(row) for s, row in slopes.items()}, len(next(iter(slopes.values())))
    both: list[Stage] = []

    def along(e: sp.Expr) -> list[sp.Expr]:
        partial = {s: derivative(e, s) for s in sorted(e.free_symbols, key=str) if s in derivatives}
        return [sp.Add(*(d * derivatives[s][j] for s, d in partial.items())) for j in range(count)]

    for name, e in stages:
        both.append((name, e))
        derivatives[name] = along(e)
        for j, slope in enumerate(derivatives[name]):
            if not slope.is_Atom:
                derivatives[name][j] = sp.Symbol(f"d{j}_{name}", real=True)
                both.append((derivatives[name][j], slope))
    whole = (*outputs, *(slope for e in outputs for slope in along(e)))
    return Program(arguments, tuple(both), whole)


def solve_symmetric(matrix: sp.Matrix, right: sp.Matrix, prefix: str) -> tuple[list[Stage], sp.Matrix]:
    """Solve matrix · x = right by L D Lᵀ without pivoting, for a positive definite matrix. Return the stages of the solution,
    whose names begin with `prefix`, and x, shape (n, r). Golub & Van Loan, Matrix Computations, 4.1."""
    n, columns = right.shape
    stages: list[Stage] = []

    def keep(tag: str, expression: sp.Expr) -> sp.Expr:
        if expression.is_Atom:
            return expression
        symbol = sp.Symbol(f"{prefix}_{tag}", real=True)
        stages.append((symbol, expression))
        return symbol

    work, x, pivots = matrix.tolist(), right.tolist(), list[sp.Expr]()
    lower: list[list[sp.Expr]] = [[] for _ in range(n)]  # each row as far as it is known

    def reduced(e: sp.Expr, i: int, factors: Sequence[sp.Expr]) -> sp.Expr:
        """Return e − Σ lower[i][k] · factors[k]."""
        products = [-l * f for l, f in zip(lower[i], factors, strict=False) if l != 0 and f != 0]
        return sp.Add(e, *products) if products else e

    for j in range(n):
        scaled = [l * d for l, d in zip(lower[j], pivots, strict=True)]
        pivot = reduced(work[j][j], j, scaled)
        if pivot == 0:
            raise SingularError(f"solve_symmetric: pivot {j} is zero: the matrix is not positive definite; reorder it")
        pivots.append(keep(f"d{j}", pivot))
        for i in range(j + 1, n):
            lower[i].append(keep(f"l{i}_{j}", reduced(work[i][j], i, scaled) / pivots[j]))
    for col in range(columns):
        for j in range(n):
            x[j][col] = keep(f"y{j}_{col}", reduced(x[j][col], j, [row[col] for row in x[:j]]))
        for j in reversed(range(n)):
            products = [-lower[i][j] * x[i][col] for i in range(j + 1, n) if lower[i][j] != 0]
            x[j][col] = keep(f"x{j}_{col}", sp.Add(x[j][col] / pivots[j], *products))
    return stages, sp.Matrix(n, columns, [e for row in x for e in row])
