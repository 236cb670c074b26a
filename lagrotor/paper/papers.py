"""A paper as a folder: its catalogue, its scripts, its record; and the audit that judges what the scripts state.

`Paper("my-paper").audit()["3.2"]` is one verdict; `Paper("my-paper").evaluate()` tests the claims.
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
from lagrotor.paper.catalogue import Catalogue
from lagrotor.paper.claim_tests import ClaimTest, Result
from lagrotor.paper.equation_statements import Stated, statement
from lagrotor.paper.ledger import decide
from lagrotor.paper.scripts import Scripts
from lagrotor.paper.theorems import can_prove
from lagrotor.paper.verdicts import AGREES, LineVerdict, Statement, Verdict

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Paper(Catalogue):
    """A folder with `paper.toml`, `equations.toml`, and, where there are any, `claims.toml`, `figures.toml`, `symbols.py`,
    `derivations/`, `figures/`, and the record of verdicts, `recorded.toml`.

    Attributes
    ----------
    scripts_in : Path or None, optional
        The folder that holds `derivations/` and `figures/`, where it is another.

    Raises
    ------
    InputError
        For a folder whose parts do not fit together; the message names the file.
    """

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
        """The verdicts on record, by id; empty when there are none yet."""
        return record.recorded(self.record_file)

    @overload
    def audit(self, identifier: str, progress: Progress | None = None) -> Verdict: ...
    @overload
    def audit(self, identifier: None = None, progress: Progress | None = None) -> Audit: ...
    def audit(self, identifier: str | None = None, progress: Progress | None = None) -> Audit | Verdict:
        """Judge every equation, or one.

        One equation runs its own derivation only; whether its error reaches a result of the paper is then taken from the
        record of the last whole audit.

        Parameters
        ----------
        identifier : str or None, optional
            Of the one.
        progress : Progress or None, optional
            Called with the name of each script before it runs.

        Raises
        ------
        InputError
            For an equation that the paper does not have, or that no derivation states.
        ScriptError
            For a script that fails.
        """
        self.check_scripts()
        if identifier is not None:
            return self._one(identifier, progress)
        return self.audit_of(v for stem in self.stating_scripts for v in self.judged(stem, progress))

    def audit_of(self, verdicts: Iterable[Verdict]) -> Audit:
        """The audit that consists of these verdicts."""
        found = tuple(self.with_reach(verdicts))
        judged = {verdict.id for verdict in found}
        return Audit(found, tuple(i for i in self.equations if i not in judged))

    def check_scripts(self) -> None:
        """Check, before anything runs, that letters can be read and that no equation has two verdicts or is unknown.

        Raises
        ------
        InputError
            With file and line otherwise.
        """
        _ = self.glossary
        for identifier, (stem, line) in self.scripts.stating.items():
            if identifier not in self.equations:
                raise InputError(
                    f"{self.scripts.path('derivations', stem)}:{line}: there is no equation {identifier!r}"
                )

    @property
    def stating_scripts(self) -> list[str]:
        """Stems of the derivations that state equations."""
        return self.scripts.names("derivations", self.about.equations_in)

    def derived_in(self, identifier: str) -> str | None:
        """The script that derives an equation, derivations/….py; None where none does."""
        place = self.scripts.stating.get(identifier)
        return f"derivations/{place[0]}.py" if place else None

    def stated(self, stem: str) -> list[Stated]:
        """What one derivation states of the paper's equations."""
        return self.scripts.executed("derivations", stem).shown(Stated)

    def statements(self, stem: str) -> list[Statement]:
        """What one derivation states, beside the print.

        Raises
        ------
        InputError
            With file and line where it does not fit.
        """
        statements = []
        for each in self.stated(stem):
            try:
                statements.append(self.statement(each))
            except InputError as error:
                _, line = self.scripts.stating.get(each.id, (stem, 1))
                raise InputError(f"{self.scripts.path('derivations', stem)}:{line}: {error}") from None
        return statements

    def statement(self, stated: Stated) -> Statement:
        """What a derivation states, beside the print.

        Raises
        ------
        InputError
            Where it does not fit the paper.
        """
        return statement(stated, self)

    def judged(self, stem: str, progress: Progress | None = None) -> list[Verdict]:
        """The verdicts on what one script states. Seconds include an equal share of its script's."""
        if progress:
            progress(stem)
        began = time.perf_counter()
        statements = self.statements(stem)
        share = (time.perf_counter() - began) / max(len(statements), 1)
        verdicts = [self._would_be(self._decided(each)) for each in statements]
        return [replace(verdict, seconds=verdict.seconds + share) for verdict in verdicts]

    def _decided(self, statement: Statement) -> Verdict:
        """The verdict on a statement. Raises ProofError, with file and line, where its correction does not hold."""
        verdict = decide(statement, self.meanings(self.equation(statement.id).section))
        if verdict.correction_verdict in ("refuted", "undecided"):
            stem, line = self.scripts.stating.get(statement.id, ("", 1))
            wrong = next(each for each in verdict.correction_lines if each.verdict == verdict.correction_verdict)
            raise ProofError(
                f"{self.scripts.path('derivations', stem)}:{line}: {statement.id}: its correction is "
                f"{verdict.correction_verdict}: {wrong.relation.quantity}: {wrong.reason or wrong.difference}"
            )
        return self._on_record(verdict)

    def _on_record(self, verdict: Verdict) -> Verdict:
        """The verdict; where theorems cannot be proved here, with those on record of lines that agree."""
        if can_prove() or not any(line.relation.theorem for line in verdict.lines):
            return verdict
        row, lines = self.recorded.get(verdict.id), list(verdict.lines)
        for i, line in enumerate(lines):
            known = row.theorems_of(line.relation.quantity) if row and line.relation.theorem else ()
            relation = replace(line.relation, theorem=known[0] if known else None)
            proved = known and line.verdict in AGREES
            lines[i] = (
                LineVerdict(relation, "proved", dimensions=line.dimensions)
                if proved
                else replace(line, relation=relation)
            )
        everything = all(line.verdict == "proved" for line in lines)
        said: dict[str, Any] = {"verdict": "proved", "premises": ()} if everything else {}
        return replace(verdict, lines=tuple(lines), **said)

    def with_reach(self, verdicts: Iterable[Verdict]) -> list[Verdict]:
        """Verdicts in the paper's order, the refuted ones with whether a result of the paper falls with them.

        Raises
        ------
        InputError
            For an equation that is judged twice.
        """
        found: dict[str, Verdict] = {}
        for verdict in verdicts:
            if verdict.id in found:
                raise InputError(f"{self.folder}: equation {verdict.id} is judged twice: keep one of its verdicts")
            found[verdict.id] = verdict
        answers = {i: v.verdict for i, v in found.items()}
        uses = {i: v.statement.depends_on for i, v in found.items()}
        return [self._followed(found[i], answers, uses) for i in self.equations if i in found]

    def _one(self, identifier: str, progress: Progress | None) -> Verdict:
        self.equation(identifier)
        if identifier not in self.scripts.stating:
            raise InputError(f"equation {identifier} is not yet judged: no derivation states it")
        stem, _ = self.scripts.stating[identifier]
        if progress:
            progress(stem)
        verdict = self._would_be(self._decided(next(s for s in self.statements(stem) if s.id == identifier)))
        on_record = self.recorded
        answers = {i: row.verdict for i, row in on_record.items()} | {identifier: verdict.verdict}
        return self._followed(verdict, answers, {i: row.uses or () for i, row in on_record.items()})

    def _would_be(self, verdict: Verdict) -> Verdict:
        """The verdict; of a reading that its author has not confirmed, what it would be, as evidence only."""
        entry = self.equation(verdict.id)
        if verdict.verdict == "definition" or entry.is_confirmed:
            return verdict
        if entry.read == "gone":
            said = "its source no longer has it"
        else:
            holding = {"holds": "hold", "holds-if": "hold under its premises", "holds-to-order": "hold to its order"}
            said = (
                f"it would {holding.get(verdict.verdict, f'be {verdict.verdict}')}: its reading is not confirmed; when you have "
                f"compared it with the print: lagrotor readings {self.folder.name} --confirm {verdict.id}"
            )
        return replace(verdict, verdict="undecided", correction_verdict=None, evidence=(said, *verdict.evidence))

    def _followed(self, verdict: Verdict, answers: Mapping[str, str], uses: Mapping[str, Iterable[str]]) -> Verdict:
        """The verdict on a refuted equation with whether a result of the paper falls with it."""
        if verdict.verdict != "refuted":
            return verdict
        reaches = record.reaches_result(verdict.id, self.about.results, answers, uses)
        return replace(verdict, reaches_result=reaches)

    @cached_property
    def claim_tests(self) -> dict[str, ClaimTest]:
        """Every test that a script shows, by claim, in the paper's order. Nothing is run but the scripts that show them.

        Raises
        ------
        InputError
            For a claim that is tested twice or is not in claims.toml.
        """
        if not self.claims:
            return {}
        tests: dict[str, ClaimTest] = {}
        for stem in self.scripts.names("derivations", self.about.claims_in):
            for test in self.scripts.executed("derivations", stem).shown(ClaimTest):
                if test.id not in self.claims or test.id in tests:
                    wrong = "is tested twice" if test.id in tests else "is not in claims.toml"
                    raise InputError(f"{self.scripts.path('derivations', stem)}: claim {test.id} {wrong}")
                tests[test.id] = test
        return {identifier: tests[identifier] for identifier in self.claims if identifier in tests}

    def measured(self, identifier: str) -> Result:
        """One claim after its test; where theorems cannot be proved here, with those on record that its run bears out."""
        with self.importable():
            result = self.claim_tests[identifier].result
        return result if can_prove() else self.with_theorems_on_record(result)

    def with_theorems_on_record(self, result: Result) -> Result:
        """The parts of a claim with their theorems that are on record, where the run bears them out."""
        row = self.recorded.get(result.test.id)
        if result.test.prove is None or row is None:
            return result
        parts = [replace(part, theorems=row.theorems_of(part.says)) for part in result.finding.parts]
        return replace(result, finding=replace(result.finding, parts=tuple(parts)))

    def evaluate(self, progress: Progress | None = None, wanted: Collection[str] | None = None) -> list[Result]:
        """Every claim (or the wanted ones) in the paper's order; `progress` gets each claim's id before its run."""
        results = []
        for identifier in self.claim_tests:
            if wanted is None or identifier in wanted:
                if progress:
                    progress(f"claim {identifier}")
                results.append(self.measured(identifier))
        return results

    def changes(self, found: Iterable[Verdict | Result], only: Iterable[str] = ()) -> list[str]:
        """A sentence for each difference from what is on record, of all ids or of those in `only`."""
        ids = tuple(only) or (*self.equations, *self.claims)
        return record.changes(self._rows_of(found), self.recorded, ids)

    def _rows_of(self, found: Iterable[Verdict | Result]) -> dict[str, record.OnRecord]:
        return {(r.test.id if isinstance(r, Result) else r.id): record.row_of(r, self.equations) for r in found}

    def renew_record(self, found: Iterable[Verdict | Result]) -> Path:
        """Write what was found into the record; what else is on record, of ids that the paper still has, stays."""
        rows = self.recorded | self._rows_of(found)
        kept = {i: rows[i] for i in (*self.equations, *self.claims) if i in rows}
        return write_text(self.record_file, record.record_text(kept))


@cache
def opened(folder: Path, scripts_in: Path | None = None) -> Paper:
    """The paper of a folder, the same one within a process, so that each of its scripts is run once."""
    return Paper(folder, scripts_in=scripts_in)
