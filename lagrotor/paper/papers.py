"""A paper as a folder with a catalogue, scripts and a record of verdicts, and the audit of the paper.

`Paper("my-paper").audit()["3.2"]` is the verdict on one equation; `Paper("my-paper").evaluate()` tests the claims.
"""

import time
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any, overload

from lagrotor.errors import InputError, ProofError
from lagrotor.files import write_text
from lagrotor.paper import record
from lagrotor.paper.audit import Audit
from lagrotor.paper.catalogue import Catalogue, section_glossary
from lagrotor.paper.claim_tests import ClaimTest, Result
from lagrotor.paper.equation_statements import Stated, statement
from lagrotor.paper.ledger import decide
from lagrotor.paper.scripts import Scripts
from lagrotor.paper.theorems import can_prove
from lagrotor.paper.verdicts import AGREES, LineVerdict, Statement, Verdict
from lagrotor.renamed import accept_old_keywords
from lagrotor.result_display import Printed

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Paper(Catalogue, Printed):
    """A paper whose equations and claims can be tested.

    The folder has `paper.toml` and `equations.toml`; `claims.toml`, `figures.toml`, `symbols.py`, `derivations/`, `figures/`
    and the record of verdicts, `recorded.toml`, are optional.

    Attributes
    ----------
    folder : Path
        The folder.
    modules : dict[str, ModuleType], default {}
        The modules of the folder that have been imported so far.
    scripts_in : Path or None, optional
        The folder with `derivations/` and `figures/`, if these are not in `folder`.

    Raises
    ------
    InputError
        If the files do not fit together; the message names the file.

    Examples
    --------
    >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
    >>> len(PAPER.equations), len(PAPER.claims)
    (68, 24)
    >>> PAPER.equation("5.22").title
    'x coordinate of the two tips in time'
    """

    _shown = (
        ("title", "title"),
        ("folder", "folder"),
        ("equations", lambda p: len(p.equations)),
        ("claims", lambda p: len(p.claims) or None),
        ("verdicts on record", lambda p: len(p.recorded) or "none"),
    )

    scripts_in: Path | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return opened, (self.folder, self.scripts_in)

    @cached_property
    def scripts(self) -> Scripts:
        """The derivations and the scripts of the figures."""
        return Scripts(self.scripts_in or self.folder, self.importable)

    @property
    def record_file(self) -> Path:
        """The file of the verdicts on record."""
        return self.folder / "recorded.toml"

    @property
    def recorded(self) -> dict[str, record.OnRecord]:
        """The verdicts on record by id; an empty dictionary if there is no record."""
        return record.recorded(self.record_file)

    @overload
    def audit(self, identifier: str, progress: Progress | None = None) -> Verdict: ...
    @overload
    def audit(self, identifier: None = None, progress: Progress | None = None) -> Audit: ...
    def audit(self, identifier: str | None = None, progress: Progress | None = None) -> Audit | Verdict:
        """Judge every equation of the paper, or the one with the given id.

        If one equation is judged, only its own derivation runs. `reaches_result` is then computed from the record of the last
        whole audit.

        Parameters
        ----------
        identifier : str or None, optional
            The id of one equation.
        progress : Callable[[str], None] or None, optional
            Called with the name of each script before it runs.

        Returns
        -------
        Audit or Verdict
            The verdicts on all equations, or the one verdict.

        Raises
        ------
        InputError
            If the paper does not have the equation, or if no derivation states it.
        ScriptError
            If a script fails.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> verdict = PAPER.audit("6.01")
        >>> verdict.verdict, verdict.correction_verdict, verdict.reaches_result
        ('refuted', 'holds', False)
        """
        check_scripts(self)
        if identifier is not None:
            return self._audit_one(identifier, progress)
        return audit_of(self, (v for stem in self.stating_scripts for v in judge_script(self, stem, progress)))

    @property
    def stating_scripts(self) -> list[str]:
        """The names of the derivations that state equations, without folder and `.py`."""
        return self.scripts.names("derivations", self.about.equations_in)

    def stated(self, stem: str) -> list[Stated]:
        """Return the equations that one derivation states, as it returned them from `verdict`.

        Parameters
        ----------
        stem : str
            Name of the derivation, without folder and `.py`.

        Returns
        -------
        list[Stated]
            The statements in the order of the derivation.
        """
        return self.scripts.executed("derivations", stem).values_of(Stated)

    def statements(self, stem: str) -> list[Statement]:
        """Return the equations that one derivation states, each combined with its printed lines.

        Parameters
        ----------
        stem : str
            Name of the derivation, without folder and `.py`.

        Returns
        -------
        list[Statement]
            The statements in the order of the derivation.

        Raises
        ------
        InputError
            If a statement does not fit the paper; the message names file and line.
        """
        statements = []
        for stated_equation in self.stated(stem):
            try:
                statements.append(statement(stated_equation, self))
            except InputError as error:
                _, line = self.scripts.stating.get(stated_equation.id, (stem, 1))
                raise InputError(f"{self.scripts.path('derivations', stem)}:{line}: {error}") from None
        return statements

    def _decide(self, statement: Statement) -> Verdict:
        """Return the verdict on a statement; raise ProofError, with file and line, if its correction does not hold."""
        verdict = decide(statement, section_glossary(self, self.equation(statement.id).section))
        if verdict.correction_verdict in ("refuted", "undecided"):
            stem, line = self.scripts.stating.get(statement.id, ("", 1))
            wrong = next(member for member in verdict.correction_lines if member.verdict == verdict.correction_verdict)
            raise ProofError(
                f"{self.scripts.path('derivations', stem)}:{line}: {statement.id}: its correction is "
                f"{verdict.correction_verdict} for {wrong.relation.quantity}: {wrong.reason or wrong.difference}"
            )
        return self._with_recorded_theorems(verdict)

    def _with_recorded_theorems(self, verdict: Verdict) -> Verdict:
        """Return the verdict; if python-flint is missing, replace its theorems by those on record."""
        if can_prove() or not any(line.relation.theorem for line in verdict.lines):
            return verdict
        row, lines = self.recorded.get(verdict.id), list(verdict.lines)
        for i, line in enumerate(lines):
            theorems = row.theorems_of(line.relation.quantity) if row and line.relation.theorem else ()
            relation = replace(line.relation, theorem=theorems[0] if theorems else None)
            proved = theorems and line.verdict in AGREES
            lines[i] = (
                LineVerdict(relation, "proved", dimensions=line.dimensions)
                if proved
                else replace(line, relation=relation)
            )
        everything = all(line.verdict == "proved" for line in lines)
        changed_fields: dict[str, Any] = {"verdict": "proved", "premises": ()} if everything else {}
        return replace(verdict, lines=tuple(lines), **changed_fields)

    def _audit_one(self, identifier: str, progress: Progress | None) -> Verdict:
        self.equation(identifier)
        if identifier not in self.scripts.stating:
            raise InputError(f"equation {identifier} is not yet judged: state it in a derivation by `verdict`")
        stem, _ = self.scripts.stating[identifier]
        if progress:
            progress(stem)
        verdict = self._unless_unconfirmed(self._decide(next(s for s in self.statements(stem) if s.id == identifier)))
        on_record = self.recorded
        answers = {i: row.verdict for i, row in on_record.items()} | {identifier: verdict.verdict}
        return self._set_reach(verdict, answers, {i: row.uses or () for i, row in on_record.items()})

    def _unless_unconfirmed(self, verdict: Verdict) -> Verdict:
        """Return the verdict; if the equation's reading is not confirmed, return 'undecided' with the verdict as evidence."""
        entry = self.equation(verdict.id)
        if verdict.verdict == "definition" or entry.is_confirmed:
            return verdict
        if entry.read == "gone":
            reason = "the source of the paper no longer has this equation"
        else:
            holding = {"holds": "hold", "holds-if": "hold under its premises", "holds-to-order": "hold to its order"}
            reason = (
                f"it would {holding.get(verdict.verdict, f'be {verdict.verdict}')}, but its reading is not confirmed: compare it "
                f"with the print, then confirm it by `lagrotor readings {self.folder.name} --confirm {verdict.id}`"
            )
        return replace(verdict, verdict="undecided", correction_verdict=None, evidence=(reason, *verdict.evidence))

    def _set_reach(self, verdict: Verdict, answers: Mapping[str, str], uses: Mapping[str, Iterable[str]]) -> Verdict:
        """Set `reaches_result` if the equation is refuted, from the verdicts and the used equations by id."""
        if verdict.verdict != "refuted":
            return verdict
        reaches = record.reaches_result(verdict.id, self.about.results, answers, uses)
        return replace(verdict, reaches_result=reaches)

    @cached_property
    def claim_tests(self) -> dict[str, ClaimTest]:
        """The tests of the claims by id, in the paper's order; the first access runs the derivations that define them.

        Raises
        ------
        InputError
            If a claim is tested twice or is not in `claims.toml`.
        """
        if not self.claims:
            return {}
        tests: dict[str, ClaimTest] = {}
        for stem in self.scripts.names("derivations", self.about.claims_in):
            for test in self.scripts.executed("derivations", stem).values_of(ClaimTest):
                if test.id not in self.claims or test.id in tests:
                    wrong = "is tested twice" if test.id in tests else "is not in claims.toml"
                    raise InputError(f"{self.scripts.path('derivations', stem)}: claim {test.id} {wrong}")
                tests[test.id] = test
        return {identifier: tests[identifier] for identifier in self.claims if identifier in tests}

    def measured(self, identifier: str) -> Result:
        """Test one claim.

        Parameters
        ----------
        identifier : str
            The claim's id.

        Returns
        -------
        Result
            The result; without python-flint it has the theorems on record.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> PAPER.measured("C03").finding.outcome
        'confirmed'
        """
        with self.importable():
            result = self.claim_tests[identifier].result
        return result if can_prove() else with_theorems_on_record(self, result)

    @accept_old_keywords
    def evaluate(self, progress: Progress | None = None, ids: Collection[str] | None = None) -> list[Result]:
        """Test all claims, or those with the given ids.

        Parameters
        ----------
        progress : Callable[[str], None] or None, optional
            Called with the id of each claim before its test.
        ids : Collection[str] or None, optional
            Ids of the claims to be tested; by default all are tested.

        Returns
        -------
        list[Result]
            The results in the paper's order.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> [result.finding.outcome for result in PAPER.evaluate(ids=["C03", "C16"])]
        ['confirmed', 'confirmed-if']
        """
        results = []
        for identifier in self.claim_tests:
            if ids is None or identifier in ids:
                if progress:
                    progress(f"claim {identifier}")
                results.append(self.measured(identifier))
        return results

    @accept_old_keywords
    def changes(self, results: Iterable[Verdict | Result], only: Iterable[str] = ()) -> list[str]:
        """Compare verdicts and results with those on record.

        Parameters
        ----------
        results : Iterable[Verdict or Result]
            Verdicts on equations and results of claims.
        only : Iterable[str], default ()
            The ids that are compared; by default all ids of the paper.

        Returns
        -------
        list[str]
            One sentence for each difference; an empty list if there is no record.

        Examples
        --------
        >>> from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
        >>> PAPER.changes([PAPER.audit("2.01")], ["2.01"])
        []
        """
        ids = tuple(only) or (*self.equations, *self.claims)
        return record.changes(self._rows_of(results), self.recorded, ids)

    def _rows_of(self, results: Iterable[Verdict | Result]) -> dict[str, record.OnRecord]:
        return {(r.test.id if isinstance(r, Result) else r.id): record.row_of(r, self.equations) for r in results}

    @accept_old_keywords
    def renew_record(self, results: Iterable[Verdict | Result]) -> Path:
        """Write verdicts and results into the record. The rows of the paper's other ids stay as they are.

        Parameters
        ----------
        results : Iterable[Verdict or Result]
            Verdicts on equations and results of claims.

        Returns
        -------
        Path
            The file of the record.
        """
        rows = self.recorded | self._rows_of(results)
        current = {i: rows[i] for i in (*self.equations, *self.claims) if i in rows}
        return write_text(self.record_file, record.record_text(current))


@cache
def opened(folder: Path, scripts_in: Path | None = None) -> Paper:
    """Return the paper of a folder, always the same object within a process, so that each script runs once."""
    return Paper(folder, scripts_in=scripts_in)


def audit_of(paper: Paper, verdicts: Iterable[Verdict]) -> Audit:
    """Return the audit of a paper with the given verdicts; equations without a verdict are listed in `waiting`."""
    in_order = tuple(with_reach(paper, verdicts))
    judged = {verdict.id for verdict in in_order}
    return Audit(in_order, tuple(i for i in paper.equations if i not in judged))


def check_scripts(paper: Paper) -> None:
    """Raise InputError, with file and line, if symbols cannot be read, or an equation is unknown or stated twice."""
    _ = paper.glossary
    for identifier, (stem, line) in paper.scripts.stating.items():
        if identifier not in paper.equations:
            raise InputError(f"{paper.scripts.path('derivations', stem)}:{line}: there is no equation {identifier!r}")


def judge_script(paper: Paper, stem: str, progress: Progress | None = None) -> list[Verdict]:
    """Return the verdicts on the equations of one derivation. Their `seconds` include equal shares of the script's time."""
    if progress:
        progress(stem)
    began = time.perf_counter()
    statements = paper.statements(stem)
    share = (time.perf_counter() - began) / max(len(statements), 1)
    verdicts = [paper._unless_unconfirmed(paper._decide(statement)) for statement in statements]
    return [replace(verdict, seconds=verdict.seconds + share) for verdict in verdicts]


def with_reach(paper: Paper, verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Sort verdicts into the paper's order and set `reaches_result` of the refuted ones; raise InputError for a duplicate."""
    by_id: dict[str, Verdict] = {}
    for verdict in verdicts:
        if verdict.id in by_id:
            raise InputError(f"{paper.folder}: equation {verdict.id} is judged twice: keep one of its verdicts")
        by_id[verdict.id] = verdict
    answers = {i: v.verdict for i, v in by_id.items()}
    uses = {i: v.statement.depends_on for i, v in by_id.items()}
    return [paper._set_reach(by_id[i], answers, uses) for i in paper.equations if i in by_id]


def with_theorems_on_record(paper: Paper, result: Result) -> Result:
    """Add the theorems on record to the result of a claim's test that ran without python-flint."""
    row = paper.recorded.get(result.test.id)
    if result.test.prove is None or row is None:
        return result
    parts = [replace(part, theorems=row.theorems_of(part.says)) for part in result.finding.parts]
    return replace(result, finding=replace(result.finding, parts=tuple(parts)))
