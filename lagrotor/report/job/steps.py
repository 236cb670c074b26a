"""The steps of the main job: each derivation, claim and figure by itself, what it is made from and what it gives."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lagrotor.paper import audit, scripts
from lagrotor.paper.claim_tests import claim_tests
from lagrotor.paper.ledger import Verdict
from lagrotor.paper.notebook import Remark
from lagrotor.paper.tables import Table
from lagrotor.pictures import figures
from lagrotor.report.interactive import interactive as interactive_module
from lagrotor.report.job.reach import made_from
from lagrotor.report.page.derivation_pages import derivation_html, title


@dataclass(frozen=True)
class Derived:
    """What a derivation gives: verdicts, what it found besides, tables, and itself as a part of the page."""

    stem: str
    title: str
    verdicts: tuple[Verdict, ...]
    remarks: tuple[tuple[str, str], ...]
    tables: tuple[Table, ...]
    html: str


@dataclass(frozen=True)
class Step:
    """One step: `run(*args, folder)` makes its product, writing its files into the folder of the figures."""

    name: str
    run: Callable[..., Any]
    args: tuple[str, ...]
    source: Path

    @property
    def made_from(self) -> str:
        """Digest of all that the product is made from."""
        return made_from(self.source)


def derive(stem: str, folder: Path) -> Derived:
    """Run a derivation and judge what it states."""
    verdicts = audit.judged(stem)
    script = scripts.executed("derivations", stem)
    remarks = tuple((remark.title, remark.text) for remark in script.shown(Remark))
    tables = script.names.get("tables", ()) if stem[0] in "mpb" else ()
    html = derivation_html(stem, {v.id: v.verdict for v in verdicts})
    return Derived(stem, title(stem), tuple(verdicts), remarks, tuple(tables), html)


def measure(identifier: str, folder: Path) -> dict[str, float]:
    """The numbers of one claim's test."""
    return dict(claim_tests()[identifier].result.measured)


def draw(key: str, folder: Path) -> figures.Picture:
    """Draw one figure."""
    return figures.draw(key, folder)


def model(folder: Path) -> str:
    """The interactive model, as a part of the page."""
    return interactive_module.interactive()


def steps() -> Iterator[Step]:
    """Every step of the main job."""
    for stem in scripts.names("derivations"):
        yield Step(f"derivation {stem}", derive, (stem,), scripts.folder("derivations") / f"{stem}.py")
    for identifier, test in claim_tests().items():
        yield Step(f"claim {identifier}", measure, (identifier,), Path(test.measure.__code__.co_filename))
    for key, stem in figures.stems().items():
        yield Step(f"figure {key}", draw, (key,), scripts.folder("figures") / f"{stem}.py")
    yield Step("model", model, (), Path(interactive_module.__file__))
