"""The steps of the job, one for each derivation, claim and figure; and the audit of all equations in parallel processes."""

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
    """The result of running a derivation.

    verdicts: those on its equations. remarks: its findings, (title, text). tables: its tables. html: the derivation as
    HTML. values: name → value that other scripts import; if one of a stored derivation is missing, the script that imports it
    runs the derivation.
    """

    stem: str
    title: str
    verdicts: tuple[Verdict, ...]
    remarks: tuple[tuple[str, str], ...]
    tables: tuple[Table, ...]
    html: str
    values: dict[str, Any]


@dataclass(frozen=True)
class JobStep:
    """One step of the job. `run(paper, key, folder)` returns its result and writes its files into the folder of figures.

    name: such as "claim C08". key: the stem, id or key in the name. source: the script that the step runs.
    """

    name: str
    run: Callable[[Paper, str, Path], Any]
    paper: Paper
    key: str
    source: Path

    @property
    def derivations(self) -> tuple[str, ...]:
        """The names of the steps whose values this step imports, such as "derivation t5_floquet"."""
        return tuple(f"derivation {stem}" for stem in scripts_named(self.source, self.paper))

    @property
    def made_from(self) -> str:
        """The digest of all inputs on which the result of the step depends."""
        return source_digest(self.source, self.paper)


def derive(paper: Paper, stem: str, folder: Path) -> Derived:
    """Run a derivation, decide its equations, and return the result; warnings of its simulations appear in its HTML."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LagrotorWarning)
        verdicts = judge_script(paper, stem)
        script = paper.scripts.executed("derivations", stem)
    remarks = tuple((remark.title, remark.text) for remark in script.values_of(Remark))
    tables = tuple(table for table in script.names.get("tables", ()) if isinstance(table, Table))
    html = derivation_html(script, {v.id: v.verdict for v in verdicts})
    exported = values(script.names, values_taken(stem, paper))
    return Derived(stem, title(script, stem), tuple(verdicts), remarks, tables, html, exported)


def measure(paper: Paper, identifier: str, folder: Path) -> dict[str, float]:
    """Return the numbers that the test of one claim measures, by name."""
    with paper.importable():
        return paper.claim_tests[identifier].measured


def draw_step(paper: Paper, key: str, folder: Path) -> figures.Picture:
    return figures.draw_figure(key, folder, paper.scripts)


def model(paper: Paper, module: str, folder: Path) -> str:
    """Return the interactive model as HTML."""
    with paper.importable():
        return str(import_module(module).interactive())


def steps(paper: Paper) -> Iterator[JobStep]:
    """Yield every step of the job: derivations, claims, figures and, if the paper has one, the interactive model."""
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


_FEW = 8  # fewer scripts run faster in one process


def audit_in_processes(paper: Paper, progress: Progress, jobs: int | None = None) -> Audit:
    """Decide every equation of a paper in `jobs` processes and return the audit.

    None means one process per core, or a single one for few scripts. `progress` is called with the name of each script.
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


def _judge_script(paper: Paper, stem: str, imported: dict[str, dict[str, Any]]) -> tuple[list[Verdict], dict[str, Any]]:
    """Return the verdicts of one script, and the values that other scripts import from it, by name."""
    with paper.scripts.remote_values(imported):
        verdicts = judge_script(paper, stem)
        return verdicts, values(paper.scripts.executed("derivations", stem).names, values_taken(stem, paper))
