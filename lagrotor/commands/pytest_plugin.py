"""A pytest plugin: `pytest my-paper --lagrotor my-paper` makes a test of each recorded verdict and outcome."""

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
    """Append a test for each verdict of each paper."""
    for folder in session.config.getoption("--lagrotor"):
        items += _OnePaper.from_parent(session, name=str(folder), path=Path(folder).resolve()).collect()


class _OnePaper(pytest.Collector):
    def collect(self) -> Iterator["RecordedAnswer"]:
        """Yield the equations and claims that are judged or recorded."""
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
    """One verdict, or the outcome of one claim, compared with the record."""

    def __init__(self, *, paper: "Paper", **settings: Any) -> None:
        super().__init__(**settings)
        self.paper = paper

    def runtest(self) -> None:
        """Judge the equation or test the claim, and compare with the record."""
        answer, why = self._answer()
        changes = self.paper.changes([answer] if answer else [], [self.name])
        if not self.paper.recorded:
            changes = [f"{self.name}: nothing is on record: lagrotor audit --record and lagrotor claims --record"]
        if changes:
            raise ChangedError("\n".join([*changes, why]))

    def _answer(self) -> "tuple[Verdict | Result | None, str]":
        """Return the present answer and its reason."""
        from lagrotor.paper.audit import in_words

        if self.name in self.paper.scripts.stating:
            verdict = self.paper.audit(self.name)
            return verdict, "\n".join((in_words(verdict, self.paper), *verdict.evidence))
        if self.name in self.paper.claim_tests:
            result = self.paper.measured(self.name)
            return result, result.finding.explanation
        return None, "no derivation and no claim's test gives a verdict on it"

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """Return the reason, or the message of an error of the package."""
        from lagrotor.errors import LagrotorError

        if isinstance(excinfo.value, ChangedError | LagrotorError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the file and name under which pytest lists the test."""
        return self.paper.folder / "equations.toml", None, f"{self.paper.folder.name} {self.name}"


class ChangedError(AssertionError):
    """A verdict that differs from the recorded one."""
