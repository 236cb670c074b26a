"""A pytest plugin: `pytest my-paper --lagrotor my-paper` tests that each verdict and outcome equals the recorded one."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from lagrotor.paper.claim_tests import Result
    from lagrotor.paper.papers import Paper
    from lagrotor.paper.verdicts import Verdict


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option --lagrotor DIR, which may be repeated."""
    says = "test that the verdicts on a paper are those on record"
    parser.getgroup("lagrotor").addoption("--lagrotor", action="append", default=[], metavar="DIR", help=says)


def pytest_collection_modifyitems(session: pytest.Session, items: list[pytest.Item]) -> None:
    """Append to the tests of a session one test for each verdict of each paper that --lagrotor names."""
    for folder in session.config.getoption("--lagrotor"):
        items += _OnePaper.from_parent(session, name=str(folder), path=Path(folder).resolve()).collect()


class _OnePaper(pytest.Collector):
    def collect(self) -> Iterator["RecordedAnswer"]:
        """Yield one test for each equation and claim that is judged or has a recorded verdict."""
        from lagrotor.errors import LagrotorError
        from lagrotor.paper.papers import opened

        try:
            paper = opened(self.path)
            judged, recorded = {*paper.scripts.stating, *paper.claim_tests}, paper.recorded
        except LagrotorError as error:
            raise pytest.UsageError(str(error)) from None
        ids = [i for i in (*paper.equations, *paper.claims) if i in judged or i in recorded]
        for identifier in (*ids, *(i for i in recorded if i not in ids)):
            yield RecordedAnswer.from_parent(self, name=identifier, paper=paper)


class RecordedAnswer(pytest.Item):
    """The test that the verdict on one equation, or the outcome of one claim, equals the recorded one."""

    def __init__(self, *, paper: "Paper", **settings: Any) -> None:
        super().__init__(**settings)
        self.paper = paper

    def runtest(self) -> None:
        """Judge the equation, or test the claim. Raise ChangedError if the result differs from the record."""
        answer, why = self._answer()
        changes = self.paper.changes([answer] if answer else [], [self.name])
        if not self.paper.recorded:
            helps = "run lagrotor audit --record and lagrotor claims --record"
            changes = [f"{self.name}: no verdict is on record: {helps}"]
        if changes:
            raise ChangedError("\n".join([*changes, why]))

    def _answer(self) -> "tuple[Verdict | Result | None, str]":
        """Return the present verdict or outcome, None if nothing decides it, and the reason in words."""
        from lagrotor.paper.audit import in_words

        if self.name in self.paper.scripts.stating:
            verdict = self.paper.audit(self.name)
            return verdict, "\n".join((in_words(verdict, self.paper), *verdict.evidence))
        if self.name in self.paper.claim_tests:
            result = self.paper.measured(self.name)
            return result, result.finding.explanation
        return None, "neither a derivation nor the test of a claim decides it"

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """Return the text that pytest prints for a failure; for an error of lagrotor it is the message alone."""
        from lagrotor.errors import LagrotorError

        if isinstance(excinfo.value, ChangedError | LagrotorError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the file, the line (None) and the name under which pytest lists the test."""
        return self.paper.folder / "equations.toml", None, f"{self.paper.folder.name} {self.name}"


class ChangedError(AssertionError):
    """The error of a test whose verdict differs from the recorded one, or has no record."""
