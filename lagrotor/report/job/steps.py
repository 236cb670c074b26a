"""The steps of the main job: each derivation, claim and figure by itself, what it is made from and what it gives; and the whole
audit, in as many processes as there are cores.
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from lagrotor.errors import LagrotorWarning
from lagrotor.paper.audit import Audit
from lagrotor.paper.papers import Paper, Progress, audit_of, check_scripts, judge_script
from lagrotor.paper.proof import Remark
from lagrotor.paper.tables import Table
from lagrotor.paper.verdicts import Verdict
from lagrotor.pictures import figures
from lagrotor.report.job.dependencies import scripts_named, source_digest, values_taken
from lagrotor.report.job.processes import cores, results, values
from lagrotor.report.page.html_elements import derivation_html, title


@dataclass(frozen=True)
class Derived:
    """The result of a derivation: verdicts, remarks, tables, its part of the page, and the values that other scripts take
    from it, by name."""

    stem: str
    title: str
    verdicts: tuple[Verdict, ...]
    remarks: tuple[tuple[str, str], ...]
    tables: tuple[Table, ...]
    html: str
    values: dict[str, Any]


@dataclass(frozen=True)
class JobStep:
    """One step: `run(paper, part, folder)` makes its product, writing its files into the folder of the figures."""

    name: str
    run: Callable[[Paper, str, Path], Any]
    paper: Paper
    part: str
    source: Path

    @property
    def needs(self) -> tuple[str, ...]:
        """Stems of the derivations whose values the step takes."""
        return scripts_named(self.source, self.paper)

    @property
    def made_from(self) -> str:
        """Digest of all that the product is made from."""
        return source_digest(self.source, self.paper)


def derive(paper: Paper, stem: str, folder: Path) -> Derived:
    """Run a derivation and judge what it states; what its runs warn of is said on its page."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        verdicts = judge_script(paper, stem)
        script = paper.scripts.executed("derivations", stem)
    remarks = tuple((remark.title, remark.text) for remark in script.values_of(Remark))
    tables = tuple(table for table in script.names.get("tables", ()) if isinstance(table, Table))
    html = derivation_html(script, {v.id: v.verdict for v in verdicts})
    taken = values(script.names, values_taken(stem, paper))
    return Derived(stem, title(script, stem), tuple(verdicts), remarks, tables, html, taken)


def measure(paper: Paper, identifier: str, folder: Path) -> dict[str, float]:
    """The numbers of one claim's test."""
    return dict(paper.measured(identifier).measured)


def draw_step(paper: Paper, key: str, folder: Path) -> figures.Picture:
    """Draw one figure."""
    return figures.draw_figure(key, folder, paper.scripts)


def model(paper: Paper, module: str, folder: Path) -> str:
    """The interactive model, as a part of the page."""
    with paper.importable():
        return str(import_module(module).interactive())


def steps(paper: Paper) -> Iterator[JobStep]:
    """Every step of the main job."""
    scripts = paper.scripts
    for stem in scripts.names("derivations"):
        yield JobStep(f"derivation {stem}", derive, paper, stem, scripts.path("derivations", stem))
    for identifier, test in paper.claim_tests.items():
        yield JobStep(f"claim {identifier}", measure, paper, identifier, Path(test.measure.__code__.co_filename))
    for key, stem in figures.stems(scripts).items():
        yield JobStep(f"figure {key}", draw_step, paper, key, scripts.path("figures", stem))
    if paper.about.model:
        with paper.importable():
            source = Path(str(import_module(paper.about.model).__file__))
        yield JobStep("model", model, paper, paper.about.model, source)


_FEW = 8  # scripts that are judged before other processes would have begun


def audit_in_processes(paper: Paper, progress: Progress, jobs: int | None = None) -> Audit:
    """Judge every equation; jobs: how many processes, None: as many as there are cores, one for few scripts.

    `progress` is called with the name of each script before it runs. Raises what `Paper.audit` raises.
    """
    stems = paper.stating_scripts
    jobs = (1 if len(stems) < _FEW else cores()) if jobs is None else jobs
    if jobs == 1:
        return paper.audit(progress=progress)
    check_scripts(paper)
    needs = {stem: set(scripts_named(paper.scripts.path("derivations", stem), paper)) & set(stems) for stem in stems}
    judgements: dict[str, tuple[list[Verdict], dict[str, Any]]] = {}

    def given(stem: str) -> tuple[dict[str, dict[str, Any]]] | None:
        return (
            ({needed: judgements[needed][1] for needed in needs[stem]},) if needs[stem] <= judgements.keys() else None
        )

    for stem, product in results(stems, partial(_judge_script, paper), jobs, progress, given):
        judgements[stem] = product
    return audit_of(paper, (verdict for stem in stems for verdict in judgements[stem][0]))


def _judge_script(paper: Paper, stem: str, given: dict[str, dict[str, Any]]) -> tuple[list[Verdict], dict[str, Any]]:
    """The verdicts on what one script states, and the values that others take from it."""
    with paper.scripts.remote_values(given):
        verdicts = judge_script(paper, stem)
        return verdicts, values(paper.scripts.executed("derivations", stem).names, values_taken(stem, paper))
