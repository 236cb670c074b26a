"""The main job: judge every equation, draw every figure, write the report, and only then replace the last one."""

import json
import os
import shutil
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import InputError, LagrotorError
from ..numerics.files import write_text
from ..paper import audit, catalogue, scripts, tables, trials
from ..paper.ledger import Verdict
from ..paper.trials import Result
from . import figures
from .content import Report
from .errata import latex_document
from .markdown import errata_blocks, markdown
from .page import page

RECORDED = Path(catalogue.__file__).with_name("recorded.json")
CONTENTS = {
    "index.html",
    "report.md",
    "verdicts.json",
    "claims.json",
    "measured.json",
    "errata.md",
    "errata.tex",
    "figures",
}


def reproduce(target: Path, step: Callable[[str], None]) -> Report:
    """Judge, draw and write everything into the folder `target`; `step` is told what begins.

    Raises InputError when `target` cannot be written or is no report. Until all is done the old report stays.
    """
    began = time.perf_counter()
    with replaced(target) as folder:
        verdicts = audit.audit(step)
        heard = trials.hear_all(step)
        findings = audit.findings("s")
        step("tables")
        side_by_side = tables.tables()
        pictures = []
        (folder / "figures").mkdir()
        for stem in scripts.names("derivations", "t"):
            step(stem)
            scripts.run("derivations", stem)
        for key in figures.stems():
            step(f"figure {key}")
            pictures.append(figures.draw(key, folder / "figures"))
        step("report")
        found = outcomes(verdicts, heard)
        changed = changes(found, recorded())
        seconds = time.perf_counter() - began
        report = Report(
            tuple(verdicts),
            tuple(pictures),
            tuple(changed),
            seconds,
            tuple(heard),
            tuple(findings),
            tuple(side_by_side),
            tuple(tables.tables("p")),
            tuple(audit.findings("t")),
        )
        write_text(folder / "index.html", page(report))
        write_text(folder / "report.md", markdown(report))
        write_text(folder / "verdicts.json", audit.to_json(verdicts) + "\n")
        write_text(folder / "claims.json", trials.to_json(heard) + "\n")
        write_text(folder / "errata.md", "\n\n".join(errata_blocks(verdicts)) + "\n")
        write_text(folder / "errata.tex", latex_document(verdicts))
        measured = {picture.stem: picture.measured for picture in pictures}
        write_text(folder / "measured.json", json.dumps(measured, indent=1) + "\n")
    return report


def steps() -> int:
    """How many times `reproduce` calls its `step`."""
    run = sum(len(scripts.names("derivations", prefix)) for prefix in "st")
    return run + len(trials.listed()) + len(figures.stems()) + 2


def recorded() -> dict[str, str] | None:
    """The verdicts on record, id → verdict; None when there are none yet. Raises LagrotorError for a broken file."""
    try:
        found = json.loads(RECORDED.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except ValueError as error:
        raise LagrotorError(f"{RECORDED} cannot be read ({error}): restore it") from None
    return dict(found)


def outcomes(verdicts: Iterable[Verdict] = (), heard: Iterable[Result] = ()) -> dict[str, str]:
    """Id → verdict or outcome, in the form that is recorded."""
    return {v.id: v.verdict for v in verdicts} | {r.trial.id: r.finding.outcome for r in heard}


def changes(found: dict[str, str], on_record: dict[str, str] | None, only: Iterable[str] = ()) -> list[str]:
    """A sentence for each id in `only`, or of all, whose verdict differs from the recorded one."""
    if on_record is None:
        return []
    asked = set(only) or found.keys() | on_record.keys()
    return [
        f"{i}: recorded {on_record.get(i, 'nothing')}, found {found.get(i, 'nothing')}"
        for i in (*catalogue.equations(), *catalogue.claims())
        if i in asked and on_record.get(i) != found.get(i)
    ]


def check_target(target: Path) -> Path:
    """The folder with its links followed; raises InputError unless it can be made, or is empty, or is a report."""
    folder = target.resolve()
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{target} is a file: choose a folder")
    if not folder.parent.is_dir():
        raise InputError(f"{target}: the folder {folder.parent} is missing: make it first")
    if not os.access(folder.parent, os.W_OK):
        raise InputError(f"{target}: {folder.parent} cannot be written to: choose another folder")
    if folder.is_dir() and {entry.name for entry in folder.iterdir()} not in (set(), CONTENTS):
        raise InputError(f"{target} holds other files than a report: choose a new or an empty folder")
    return folder


def _alive(process: str) -> bool:
    """Whether a process of that number is running."""
    try:
        os.kill(int(process), 0)
    except (ValueError, OverflowError, ProcessLookupError):
        return False
    except PermissionError:
        return True
    return True


@contextmanager
def replaced(target: Path) -> Iterator[Path]:
    """A new folder that takes the place of `target` when the block ends well, and is removed when it does not."""
    target = check_target(target)
    # Two runs at once each fill a folder of their own; the last to end is the one that stays.
    new, old = target.with_name(f".{target.name}.new-{os.getpid()}"), target.with_name(f".{target.name}.old")
    for left in target.parent.glob(f".{target.name}.new-*"):
        if not _alive(left.name.rpartition("-")[2]):
            shutil.rmtree(left, ignore_errors=True)
    if old.exists() and not target.exists():  # a run that was killed between the two renames below
        old.rename(target)
    shutil.rmtree(new, ignore_errors=True)
    try:
        new.mkdir()
        yield new
        if target.exists():
            shutil.rmtree(old, ignore_errors=True)
            target.rename(old)
        try:
            new.rename(target)
        except BaseException:
            if old.exists() and not target.exists():
                old.rename(target)
            raise
    finally:
        shutil.rmtree(new, ignore_errors=True)
        if target.exists():
            shutil.rmtree(old, ignore_errors=True)
