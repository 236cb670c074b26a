"""The folder of a report: which files it may contain, and its replacement once a new report is complete."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.report.content import BESIDE
from lagrotor.report.job.dependencies import TIMES

CERTIFICATES = "certificates"  # only with `--certify`
# The times are the only file that may differ between two runs of the same inputs.
CONTENTS = {*BESIDE, "pages", "figures", "errata.tex", CERTIFICATES, TIMES}
_OF_VERSION_0_2 = {"made.json", "products"}
# Files that pdflatex writes; they are deleted with the report.
_COMPILED = {
    f"{stem}.{kind}" for stem in ("report", "errata") for kind in ("aux", "log", "out", "toc", "pdf", "synctex.gz")
}


def check_target(target: Path) -> Path:
    """Return the absolute path of the folder for a report.

    Raises InputError if the folder cannot be created, or if it has contents other than a report.
    """
    folder = target.resolve()
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{target} is a file: choose a folder")
    if not folder.parent.is_dir():
        raise InputError(f"{target}: the folder {folder.parent} is missing: make it first")
    if not os.access(folder.parent, os.W_OK):
        raise InputError(f"{target}: {folder.parent} cannot be written to: choose another folder")
    entries = {entry.name for entry in folder.iterdir()} if folder.is_dir() else set()
    if extra := sorted(entries - CONTENTS - _COMPILED - _OF_VERSION_0_2):
        raise InputError(f"{target} holds {extra[0]}, which is no part of a report: choose a new or an empty folder")
    if entries and (missing := sorted({"index.html", "verdicts.json"} - entries)):
        raise InputError(f"{target} is no report: {missing[0]} is missing: choose a new or an empty folder")
    return folder


def _alive(process: str) -> bool:
    """Return True if a process with this number is running; False if the text is no number."""
    try:
        os.kill(int(process), 0)
    except (ValueError, OverflowError, ProcessLookupError):
        return False
    except PermissionError:
        return True
    return True


@contextmanager
def _alone(target: Path) -> Iterator[None]:
    """Lock the folder `target` inside the `with` block. Raises InputError if another run has locked it."""
    lock = target.with_name(f".{target.name}.lock")
    while True:
        try:
            handle = os.open(lock, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
            break
        except FileExistsError:
            with suppress(FileNotFoundError):
                owner = lock.read_text(encoding="ascii", errors="replace").strip()
                if _alive(owner) or not owner:
                    raise InputError(
                        f"{target} is being written by another run (process {owner or 'starting'}): wait until it ends, or "
                        "choose another folder"
                    ) from None
                lock.unlink()  # a killed run left it
    try:
        os.write(handle, str(os.getpid()).encode())
        os.close(handle)
        yield
    finally:
        lock.unlink(missing_ok=True)


@contextmanager
def replacement(target: Path) -> Iterator[Path]:
    """Yield a new folder, which replaces the folder `target` if the `with` block succeeds.

    Raises InputError if another run is writing there.
    """
    target = check_target(target)
    with _alone(target):
        yield from _rename_over(target)


def _rename_over(target: Path) -> Iterator[Path]:
    new, old = target.with_name(f".{target.name}.new-{os.getpid()}"), target.with_name(f".{target.name}.old")
    for stale in target.parent.glob(f".{target.name}.new-*"):
        if not _alive(stale.name.rpartition("-")[2]):
            shutil.rmtree(stale, ignore_errors=True)
    if old.exists() and not target.exists():  # a run was killed between the two renames below
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
