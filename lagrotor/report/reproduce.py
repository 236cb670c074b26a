"""The main job: judge every equation, draw every figure, write the report, and only then replace the last one."""

import json
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from lagrotor.files import write_text
from lagrotor.paper import audit, claim_tests, scripts, tables
from lagrotor.paper.claim_tests import Result
from lagrotor.paper.ledger import Verdict
from lagrotor.paper.notebook import findings
from lagrotor.paper.record import OnRecord, changes, recorded
from lagrotor.paper.scripts import beside
from lagrotor.pictures import figures
from lagrotor.pictures.figures import Picture
from lagrotor.report import reuse
from lagrotor.report.api import api_page
from lagrotor.report.content import Report
from lagrotor.report.errata import latex_document
from lagrotor.report.folder import TIMES, check_target, replaced
from lagrotor.report.formulas.mathml_latex import converter
from lagrotor.report.interactive.interactive import interactive
from lagrotor.report.markdown import errata_blocks, markdown
from lagrotor.report.page import page
from lagrotor.report.reuse import Kept, digest
from lagrotor.report.supplement import supplement

# Derivations that state no equation: tables, benchmarks, theory past the paper, the table of it.
_BESIDES = "mbtp"
Progress = Callable[[int], AbstractContextManager[Callable[[str], None]]]


@dataclass(frozen=True)
class Outcome:
    """What a run found, in numbers: verdict → how many, claims likewise; a sentence for each change; what was taken.

    taken: names of the parts that are those of the last run; ["report"] when all of it is.
    """

    equations: dict[str, int]
    waiting: int
    claims: dict[str, int]
    figures: int
    changes: list[str]
    taken: list[str]
    seconds: float


def reproduce(target: Path, progress: Progress) -> Outcome:
    """Judge, draw and write everything into the folder `target`, taking from the last report what has not changed.

    `progress(total)` gives the function that is told what begins. Raises InputError when `target` cannot be written or
    is no report. Until all is done the old report stays.
    """
    began, on_record, old = time.perf_counter(), recorded(), check_target(target)
    made_from = json.dumps([reuse.inputs(), {i: row.verdict for i, row in on_record.items()}, converter()])
    whole = digest(reuse.foundation(), made_from, beside("CITATION.cff").read_bytes())
    if found := Kept(old, old).last("report", whole):
        return Outcome(**found, taken=["report"], seconds=time.perf_counter() - began)
    with replaced(target) as new:
        kept, marks = Kept(old, new), list[tuple[str, float]]()
        (new / "figures").mkdir()
        with progress(_steps(kept)) as told:

            def step(name: str) -> None:
                marks.append((name, time.perf_counter()))
                told(name)

            report = _find(kept, on_record, step)
            step("interactive model")
            interactive()
            step("report")
            _write(new, report)
        found = {
            "equations": report.counts,
            "waiting": len(report.waiting),
            "claims": report.outcomes,
            "figures": len(report.pictures),
            "changes": list(report.changes),
        }
        kept.keep("report", whole, found, (path for path in new.rglob("*") if path.is_file()))
        kept.write()
        ends = pairwise([*marks, ("", time.perf_counter())])
        seconds = {name: round(end - start, 3) for (name, start), (_, end) in ends}
        _write_json(new / TIMES, {"seconds": seconds, "taken from the last run": kept.taken})
    return Outcome(**found, taken=kept.taken, seconds=time.perf_counter() - began)


def _steps(kept: Kept) -> int:
    """How many times `step` will be called."""
    claims = sum(kept.last(f"claim {i}", reuse.foundation()) is None for i in claim_tests.claim_tests())
    drawn = sum(kept.last(f"figure {key}", _figure_from(stem)) is None for key, stem in figures.stems().items())
    return sum(len(scripts.names("derivations", prefix)) for prefix in f"s{_BESIDES}") + claims + drawn + 2


def _find(kept: Kept, on_record: dict[str, OnRecord], step: Callable[[str], None]) -> Report:
    """Everything that the report tells."""
    verdicts = audit.audit(progress=lambda stem: step(f"derivation {stem}"))
    results = _claims(kept, step)
    for prefix in _BESIDES:
        for stem in scripts.names("derivations", prefix):
            step(f"derivation {stem}")
            scripts.run("derivations", stem)
    return Report(
        verdicts=tuple(verdicts),
        pictures=tuple(_draw(kept, step)),
        changes=tuple(changes(outcomes(verdicts, results), on_record)),
        claims=tuple(results),
        findings=tuple(findings("s")),
        tables=tuple(tables.tables("m1")),
        past=tuple(tables.tables("p")),
        theory=tuple(findings("t")),
        speed=tuple(tables.tables("b")),
        stability=tuple(tables.tables("m3")),
        versions=tuple(reuse.versions().items()),
        inputs=tuple(reuse.inputs().items()),
    )


def _claims(kept: Kept, step: Callable[[str], None]) -> list[Result]:
    """Every claim, its measured numbers those of the last run where they can be taken; they are decided anew."""
    results = []
    for identifier, test in claim_tests.claim_tests().items():
        name = f"claim {identifier}"
        measured = kept.take(name, reuse.foundation())
        if measured is None:
            step(name)
            results.append(test.result)
            kept.keep(name, reuse.foundation(), dict(results[-1].measured))
        else:
            results.append(Result(test, measured, test.decide(measured), 0.0))
    return results


def _figure_from(stem: str) -> str:
    return digest(reuse.foundation(), (scripts.folder("figures") / f"{stem}.py").read_bytes())


def _draw(kept: Kept, step: Callable[[str], None]) -> Iterator[Picture]:
    """Every figure, the last run's where it can be taken."""
    folder = kept.new / "figures"
    for key, stem in figures.stems().items():
        name = f"figure {key}"
        told = kept.take(name, _figure_from(stem))
        if told is None:
            step(name)
            picture = figures.draw(key, folder)
            told = {field: value for field, value in asdict(picture).items() if field not in ("svg", "png")}
            kept.keep(name, _figure_from(stem), told, (picture.svg, picture.png))
        yield Picture(**told, svg=folder / f"{stem}.svg", png=folder / f"{stem}.png")


def _write(folder: Path, report: Report) -> None:
    write_text(folder / "index.html", page(report))
    write_text(folder / "api.html", api_page())
    write_text(folder / "report.md", markdown(report))
    write_text(folder / "report.tex", supplement(report))
    write_text(folder / "errata.md", "\n\n".join(["# Errata", *errata_blocks(report.verdicts)]) + "\n")
    write_text(folder / "errata.tex", latex_document(report.verdicts))
    _write_json(folder / "verdicts.json", [_timeless(audit.record(verdict)) for verdict in report.verdicts])
    _write_json(folder / "claims.json", [_timeless(claim_tests.record(result)) for result in report.claims])
    _write_json(folder / "measured.json", {picture.stem: picture.measured for picture in report.pictures})


def _timeless(record: dict[str, Any]) -> dict[str, Any]:
    """A record without its duration, which is another on each run."""
    return {name: value for name, value in record.items() if name != "seconds"}


def _write_json(file: Path, found: Any) -> None:
    write_text(file, json.dumps(found, indent=1, ensure_ascii=False) + "\n")


def outcomes(verdicts: Iterable[Verdict] = (), results: Iterable[Result] = ()) -> dict[str, str]:
    """Id → verdict or outcome, in the form that is recorded."""
    return {v.id: v.verdict for v in verdicts} | {r.test.id: r.finding.outcome for r in results}
