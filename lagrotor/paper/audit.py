"""What an audit gives: the verdicts of a paper in its order, and which of its equations are not yet judged."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from lagrotor.errors import InputError
from lagrotor.paper.tables import Table
from lagrotor.paper.verdicts import Verdict, verdict_table

NOT_YET = "not-yet-judged"


@dataclass(frozen=True)
class Audit:
    """The verdicts of an audit in the paper's order, by id: `audit["5.22"]`. waiting: ids that no derivation states."""

    verdicts: tuple[Verdict, ...]
    waiting: tuple[str, ...] = ()

    def __getitem__(self, identifier: str) -> Verdict:
        for verdict in self.verdicts:
            if verdict.id == identifier:
                return verdict
        if identifier in self.waiting:
            raise InputError(f"equation {identifier} is not yet judged: no derivation states it")
        raise InputError(f"equation {identifier!r} is not in the paper: {', '.join(self.ids)}")

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __len__(self) -> int:
        return len(self.verdicts)

    @property
    def ids(self) -> tuple[str, ...]:
        """Ids of the equations, those that are judged first."""
        return (*(verdict.id for verdict in self.verdicts), *self.waiting)

    @property
    def counts(self) -> dict[str, int]:
        """How many equations have each verdict, the most frequent first, those not yet judged last."""
        counts = dict(Counter[str](verdict.verdict for verdict in self.verdicts).most_common())
        return counts | ({NOT_YET: len(self.waiting)} if self.waiting else {})

    def __repr__(self) -> str:
        return (
            f"<Audit of {len(self.ids)} equations: {', '.join(f'{n} {answer}' for answer, n in self.counts.items())}>"
        )

    def _repr_html_(self) -> str:
        table = verdict_table(self.verdicts)
        rows = tuple((identifier, NOT_YET, "") for identifier in self.waiting)
        return Table(table.title, table.head, (*table.rows, *rows))._repr_html_()
