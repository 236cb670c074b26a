"""`pytest my-paper --lagrotor my-paper`: each verdict and each outcome on record is a test, which fails with the reason."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from lagrotor.paper.claim_tests import Result
    from lagrotor.paper.papers import Paper
    from lagrotor.paper.verdicts import Verdict


def pytest_addoption(parser: pytest.Parser) -> None:
    """--lagrotor DIR, as often as there are papers."""
    says = "test that the verdicts on a paper are those on record"
    parser.getgroup("lagrotor").addoption("--lagrotor", action="append", default=[], metavar="DIR", help=says)


def pytest_collection_modifyitems(session: pytest.Session, items: list[pytest.Item]) -> None:
    """A test for each verdict of each paper, after the others."""
    for folder in session.config.getoption("--lagrotor"):
        items += _OnePaper.from_parent(session, name=str(folder), path=Path(folder).resolve()).collect()


class _OnePaper(pytest.Collector):
    def collect(self) -> Iterator["RecordedAnswer"]:
        """The equations that are stated or on record, and the claims that are tested or on record."""
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
    """One verdict, or the outcome of one claim, against the record."""

    def __init__(self, *, paper: "Paper", **settings: Any) -> None:
        super().__init__(**settings)
        self.paper = paper

    def runtest(self) -> None:
        """Judge the equation, or test the claim."""
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
        return None, "no derivation states it and no claim's test shows it"

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """The reason alone; of an error of the package its message."""
        from lagrotor.errors import LagrotorError

        if isinstance(excinfo.value, ChangedError | LagrotorError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the place where the equation is printed."""
        return self.paper.folder / "equations.toml", None, f"{self.paper.folder.name} {self.name}"


class ChangedError(AssertionError):
    """A verdict that is not the one on record."""
