"""The job `lagrotor reproduce`: decide every equation, test every claim, draw every figure, and write the report.

The steps run in parallel. Results of an earlier run are reused if their inputs have not changed. The report
has the same bytes for any number of processes.
"""

import json
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from lagrotor.files import write_text
from lagrotor.paper import audit, claim_tests
from lagrotor.paper.catalogue import ReportPart
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.papers import Paper, with_reach, with_theorems_on_record
from lagrotor.paper.scripts import beside
from lagrotor.pictures.figures import Picture
from lagrotor.proofs.coq.coq_check import certify
from lagrotor.report.content import Report, ResultSection
from lagrotor.report.errata import latex_document
from lagrotor.report.job import dependencies
from lagrotor.report.job.cache import (
    Cache,
    derived_as_json,
    derived_from_json,
    picture_as_json,
    picture_from_json,
)
from lagrotor.report.job.dependencies import TIMES, digest
from lagrotor.report.job.folder import CERTIFICATES, check_target, replacement
from lagrotor.report.job.processes import cores, results
from lagrotor.report.job.steps import Derived, JobStep, derive, draw_step, steps
from lagrotor.report.page.pages import FOLDER, html_files
from lagrotor.report.text_forms import errata_sheet, markdown, supplement

# A function of the number of steps and of the line to show first. It gives the function that is called as each step begins.
StepProgress = Callable[[int, str], AbstractContextManager[Callable[[str], None]]]


@dataclass(frozen=True)
class JobOutcome:
    """The outcome of a run: how many equations and claims have each verdict, and how many equations are not judged.

    changes: a sentence for each verdict that differs from the recorded one. reused: names of the steps whose results were
    taken from an earlier run, ["report"] if the whole report was. seconds: the duration of the run.
    """

    equations: dict[str, int]
    waiting: int
    claims: dict[str, int]
    figures: int
    changes: list[str]
    reused: list[str]
    seconds: float


def reproduce(
    paper: Paper, target: Path, progress: StepProgress, jobs: int | None = None, certificates: bool = False
) -> JobOutcome:
    """Compute or reuse the result of every step, and write the report into the folder `target`.

    An old report stays there until the new one is complete.

    jobs: number of processes; None: one per core, one in a debugger. certificates: True to write Coq proofs of exact verdicts.
    Raises InputError if `target` cannot be written, is not a report, or is being written by another run. An interrupt says how
    many results the next run will reuse.
    """
    began, on_record, old = time.perf_counter(), paper.recorded, check_target(target)
    made_from = json.dumps(
        [
            dependencies.inputs(paper),
            {i: row.verdict for i, row in on_record.items()},
            dependencies.converters(),
            certificates,
        ]
    )
    whole = digest(made_from, *map(str, dependencies.versions().items()), beside("CITATION.cff").read_bytes())
    cache = Cache(paper)
    last = cache.take("report", whole)
    if last and last["files"].items() <= _digests(old).items():
        return JobOutcome(**last["outcome"], reused=["report"], seconds=time.perf_counter() - began)
    all_steps, kept = list(steps(paper)), set[str]()
    try:
        with replacement(target) as new:
            (new / "figures").mkdir()
            products, seconds, reused = _make(cache, all_steps, new / "figures", progress, jobs or cores(), old, kept)
            report = _report(paper, products)
            start = time.perf_counter()
            if certificates:
                rows = certify(report.verdicts, paper, new / CERTIFICATES)
                files = {row.id: f"{CERTIFICATES}/{row.file}" for row in rows if row.file}
                report = replace(report, certificates=files)
            _write(new, report)
            outcome: dict[str, Any] = {
                "equations": report.counts,
                "waiting": len(report.waiting),
                "claims": report.outcomes,
                "figures": len(report.pictures),
                "changes": list(report.changes),
            }
            cache.keep("report", whole, {"outcome": outcome, "files": _digests(new)})
            seconds["report"] = round(time.perf_counter() - start, 3)
            _write_json(new / TIMES, {"seconds": seconds, "taken from earlier runs": reused})
    except BaseException as stop:
        if not isinstance(stop, Exception):  # an interrupt or a termination, which the command reports
            says = f"{len(kept)} of {len(all_steps)} results are kept, and the same command goes on from there"
            stop.args = (says if kept else "no result is kept yet, and the same command begins again",)
        raise
    return JobOutcome(**outcome, reused=reused, seconds=time.perf_counter() - began)


def _digests(folder: Path) -> dict[str, str]:
    """Return a map from the relative path of each file of a report, except the computing times, to its digest."""
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    return {name: digest(path.read_bytes()) for name, path in files.items() if name != TIMES}


def _make(
    cache: Cache,
    all_steps: list[JobStep],
    folder: Path,
    progress: StepProgress,
    jobs: int,
    old: Path,
    kept: set[str],
) -> tuple[dict[str, Any], dict[str, float], list[str]]:
    """Run all steps whose results are not in the cache; `folder` is for figures, `old` the folder of the last report.

    Return step → result, step → computing time in s of those that ran, and the names of the steps that did not run. The names
    of the steps whose results the cache holds are added to `kept` during the run.
    """
    products: dict[str, Any] = dict.fromkeys(step.name for step in all_steps)
    for step in all_steps:
        if (product := cache.take(step.name, step.made_from)) is not None:
            products[step.name] = _restored(step, product, folder)
            kept.add(step.name)
    reused = [step.name for step in all_steps if step.name in kept]
    expected = _seconds(cache.paper.folder) | _seconds(old)
    pending = [step for step in longest_first(all_steps, expected) if step.name not in reused]
    jobs = min(jobs, max(len(pending), 1))
    time_left = partial(_time_left, pending, expected, jobs)
    first = f"{len(pending)} of {len(all_steps)} results to compute, with --jobs {jobs}"
    if expects := time_left({}):
        first += f": about {expects}, by the times of an earlier run"
    seconds: dict[str, float] = {}

    def given(step: JobStep) -> tuple[dict[str, dict[str, Any]]] | None:
        needed = [products[name] for name in step.derivations]
        return None if None in needed else ({product.stem: product.values for product in needed},)

    timed = partial(_run_timed, folder=folder)
    with progress(len(pending) + 1, first) as begins:

        def show(name: str) -> None:
            left = time_left(seconds)
            begins(f"{name}; about {left} left" if left else name)

        for step, (product, took) in results(pending, timed, jobs, lambda step: show(step.name), given):
            products[step.name], seconds[step.name] = product, round(took, 3)
            if cache.keep(step.name, step.made_from, _stored(product)):
                kept.add(step.name)
        show("report")
    return products, {step.name: seconds[step.name] for step in all_steps if step.name in seconds}, reused


def _time_left(pending: list[JobStep], expected: Mapping[str, float], jobs: int, seconds: Mapping[str, float]) -> str:
    """Return the remaining time of a run with its unit, such as "40 s"; "" if the expected time of a pending step is unknown.

    `expected` and `seconds` map steps to their computing times in an earlier run and, if they have ended, in this run. The ratio
    of the two shows how fast this run is.
    """
    if not {"report", *(step.name for step in pending)} <= expected.keys():
        return ""
    slower = (1 + sum(seconds.values())) / (1 + sum(expected[name] for name in seconds))
    rest = [step for step in pending if step.name not in seconds]
    steps = max(sum(expected[step.name] for step in rest) / jobs, max(_to_end(rest, expected).values(), default=0.0))
    left = slower * (steps + expected["report"])
    return f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} minutes"


def _stored(product: Any) -> Any:
    """Return the result of a step in the form that the cache keeps."""
    if isinstance(product, Picture):
        return picture_as_json(product)
    return derived_as_json(product) if isinstance(product, Derived) else product


def _restored(step: JobStep, data: Any, folder: Path) -> Any:
    """Return the result of a step from its stored form; the files of a figure are written into `folder`."""
    if step.run is draw_step:
        return picture_from_json(data, folder)
    return derived_from_json(data) if step.run is derive else data


def _run_timed(step: JobStep, imported: dict[str, dict[str, Any]], folder: Path) -> tuple[Any, float]:
    """Run a step; return its result and its computing time in s. `imported` holds values of other derivations."""
    began = time.perf_counter()
    with step.paper.scripts.remote_values(imported):
        product = step.run(step.paper, step.key, folder)
    return product, time.perf_counter() - began


def longest_first(all_steps: list[JobStep], seconds: Mapping[str, float]) -> list[JobStep]:
    """Sort steps by the computing time from their beginning to the end of all steps that import their values, longest first.

    `seconds` are the computing times of an earlier run; a step that is not among them takes their mean.
    """
    to_end = _to_end(all_steps, seconds)
    return sorted(all_steps, key=lambda step: -to_end[step.name])


def _to_end(all_steps: list[JobStep], seconds: Mapping[str, float]) -> dict[str, float]:
    """Return for each step the computing time from its beginning to the end of all steps that import its values."""
    mean = sum(seconds.values()) / len(seconds) if seconds else 1.0
    to_end = {step.name: seconds.get(step.name, mean) for step in all_steps}
    for _ in all_steps:  # a chain of imports is not longer
        last, to_end = to_end, {step.name: seconds.get(step.name, mean) for step in all_steps}
        for step in all_steps:
            for name in to_end.keys() & step.derivations:
                to_end[name] = max(to_end[name], seconds.get(name, mean) + last[step.name])
        if to_end == last:
            break
    return to_end


def _seconds(folder: Path) -> dict[str, float]:
    """Return step → computing time in s from the file of times in a folder; empty if it is missing or damaged."""
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
        took = json.loads((folder / TIMES).read_text(encoding="utf-8"))["seconds"]
        return {str(name): float(seconds) for name, seconds in took.items()}
    return {}


def _report(paper: Paper, products: dict[str, Any]) -> Report:
    derived = [product for product in products.values() if isinstance(product, Derived)]
    verdicts = with_reach(paper, (verdict for product in derived for verdict in product.verdicts))
    tested = _claim_results(paper, products)
    pictures = [product for product in products.values() if isinstance(product, Picture)]
    result_sections = [_result_section(entry, derived, pictures) for entry in paper.about.part]
    return Report(
        paper=paper,
        verdicts=tuple(verdicts),
        pictures=tuple(pictures),
        changes=tuple(paper.changes([*verdicts, *tested])),
        claims=tuple(tested),
        result_sections=tuple(s for s in result_sections if s.tables or s.remarks or s.pictures),
        derivations=tuple((product.stem, product.title, product.html) for product in derived),
        model=products.get("model", ""),
        versions=tuple(dependencies.versions().items()),
        inputs=tuple(dependencies.inputs(paper).items()),
    )


def _result_section(entry: ReportPart, derived: list[Derived], pictures: list[Picture]) -> ResultSection:
    """Return a section of the report with the tables, findings and figures that `entry` of paper.toml selects."""
    return ResultSection(
        entry.name,
        entry.heading,
        tuple(table for product in derived if product.stem.startswith(entry.tables) for table in product.tables),
        tuple(remark for product in derived if product.stem.startswith(entry.remarks) for remark in product.remarks),
        tuple(picture for picture in pictures if picture.key.rstrip("0123456789") in entry.figures),
    )


def _claim_results(paper: Paper, products: dict[str, Any]) -> list[Result]:
    """Return the result of every claim, decided by its measured numbers and by recorded theorems.

    The theorems are not proved again here; `lagrotor claims` does this.
    """
    results = [Result(test, m := products[f"claim {i}"], test.decide(m), 0.0) for i, test in paper.claim_tests.items()]
    return [with_theorems_on_record(paper, result) for result in results]


def _write(folder: Path, report: Report) -> None:
    files = html_files(report)
    (folder / FOLDER).mkdir()
    for name, text in files.items():
        write_text(folder / name, text)
    write_text(folder / "report.md", markdown(report))
    write_text(folder / "report.tex", supplement(report))
    write_text(folder / "errata.md", errata_sheet(report))
    write_text(folder / "errata.tex", latex_document(report.verdicts, report.paper))
    rows = [_timeless(audit.verdict_data(verdict, report.paper)) for verdict in report.verdicts]
    _write_json(folder / "verdicts.json", rows + list(map(audit.waiting, report.waiting)))
    claims = [claim_tests.claim_data(result, report.paper.claims[result.test.id]) for result in report.claims]
    _write_json(folder / "claims.json", list(map(_timeless, claims)))
    _write_json(folder / "measured.json", {picture.stem: picture.measured for picture in report.pictures})


def _timeless(record: dict[str, Any]) -> dict[str, Any]:
    """Return a record without its entry `seconds`, the duration, which differs between runs."""
    return {name: value for name, value in record.items() if name != "seconds"}


def _write_json(file: Path, data: Any) -> None:
    write_text(file, json.dumps(data, indent=1, ensure_ascii=False) + "\n")
