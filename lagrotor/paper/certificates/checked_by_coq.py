"""Certificates checked by Coq's kernel: `coqc` compiles the files, several at once.

In each are the lemmas that all begin with, and theorems.
"""

import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count
from pathlib import Path

from lagrotor.errors import LagrotorError
from lagrotor.files import read_text
from lagrotor.paper.certificates.certificate import PREAMBLE, CertifiedLine
from lagrotor.paper.certificates.certificate_folder import CertifiedEquation, read_certificates

# The seconds after which a file counts as rejected.
_LONGEST = 300
# Files are compiled together, in so many parts for each core.
_BATCHES = 4
# Words that a sentence begins with after the preamble: nothing is assumed, no notation is changed, and no name is taken but
# those of lines, since a lemma `sin` would be another sine in all that follows.
_SENTENCES = frozenset(["Theorem", "Proof", "Qed"])
_NAME = re.compile(r"(line|correction)_\d+(_\w+)?")
# The end of a sentence; the next may begin with the marks of its place in a proof.
_END = re.compile(r"(?:(?<!\.)|\.\.)\.(?:\s|\Z)|[{}]")
_MARKS = " \t\r\n+-*"
_TO_INSTALL = "install Debian's packages coq and libcoq-interval (apt-get install coq libcoq-interval)"


@dataclass(frozen=True)
class Checked:
    """What Coq said of one line. status: accepted, rejected, or skipped; why: what it rejected, or why there is nothing."""

    id: str
    line: CertifiedLine
    status: str
    why: str = ""


def missing_coq() -> str:
    """Why nothing can be checked here; empty where Coq and its Interval are installed."""
    if shutil.which("coqc") is None:
        return f"coqc is not on the PATH: {_TO_INSTALL}"
    with tempfile.TemporaryDirectory() as folder:
        failed = _compiled(Path(folder), "needed.v", PREAMBLE)
    return f"coqc has no Interval library ({failed}): {_TO_INSTALL}" if failed else ""


def check_certificates(folder: Path, begins: Callable[[str], None] = lambda name: None) -> list[Checked]:
    """Check every certificate of a folder, as many at once as there are cores; `begins` is called with each id.

    Raises InputError for a folder without certificates, LagrotorError where there is no Coq.
    """
    rows = read_certificates(folder)
    if why := missing_coq():
        lines = sum(bool(line.theorems) for row in rows for line in row.lines)
        raise LagrotorError(f"nothing was checked, {lines} lines were skipped: {why}")

    texts = [read_text(folder / row.file) if row.file else "" for row in rows]
    cores = cpu_count() or 1
    place = sorted(range(len(rows)), key=lambda i: len(texts[i]))
    batches = [place[first :: _BATCHES * cores] for first in range(_BATCHES * cores)]

    def checked(batch: list[int]) -> dict[int, list[Checked]]:
        for i in batch:
            begins(rows[i].id)
        failures = _failures_of([(rows[i], texts[i]) for i in batch])
        return {i: list(_lines(rows[i], failed)) for i, failed in zip(batch, failures, strict=True)}

    with ThreadPoolExecutor(cores) as pool:
        found = {i: lines for part in pool.map(checked, batches) for i, lines in part.items()}
    return [each for i in range(len(rows)) for each in found[i]]


def _lines(row: CertifiedEquation, failed: Mapping[str, str]) -> Iterator[Checked]:
    for line in row.lines:
        if not line.theorems:
            yield Checked(row.id, line, "skipped", line.why_not)
        elif wrong := next((failed[name] for name in ("", *line.theorems) if name in failed), ""):
            yield Checked(row.id, line, "rejected", wrong)
        else:
            yield Checked(row.id, line, "accepted")


def _failures_of(files: Sequence[tuple[CertifiedEquation, str]]) -> list[dict[str, str]]:
    """Of each file its theorems that are rejected, with the reason; "" for the whole file.

    Coq takes longer to load its libraries than to check most files: these are compiled together, each as a module, and one by
    one where one of them is rejected.
    """
    wrong = [_malformed(row, text) for row, text in files]
    sound = [(row, text) for (row, text), reason in zip(files, wrong, strict=True) if text and not reason]
    together = PREAMBLE
    for row, text in sound:
        name = row.file.removesuffix(".v")
        together += f"\nModule {name}.\n{text.partition(PREAMBLE)[2]}\nEnd {name}.\n"
    with tempfile.TemporaryDirectory() as folder:
        accepted = len(sound) > 1 and not _compiled(Path(folder), "together.v", together)
    return [
        {"": reason} if reason else {} if accepted or not text else _failures(row, text)
        for (row, text), reason in zip(files, wrong, strict=True)
    ]


def _malformed(row: CertifiedEquation, text: str) -> str:
    """What is wrong with a file as a text; empty where nothing is, or there is no file."""
    if text and (other := foreign_word(text)):
        return f"the file holds {other}, which is no part of a certificate"
    for name in (name for line in row.lines for name in line.theorems):
        if len(re.findall(rf"^Theorem {re.escape(name)}\b", text, re.MULTILINE)) != 1:
            return f"the file does not hold one theorem {name}"
    return ""


def _failures(row: CertifiedEquation, text: str) -> dict[str, str]:
    """Theorem -> why Coq rejects it; "" for the whole file. A theorem that is rejected is left out of the next attempt."""
    failed: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        while error := _compiled(Path(folder), row.file, text):
            place = re.match(r"line (\d+)", error)
            before = "\n".join(text.split("\n")[: int(place[1])]) if place else ""
            begun = re.findall(r"^Theorem (\w+)", before, re.MULTILINE)
            if not begun or begun[-1] in failed:
                return {"": error}
            failed[begun[-1]] = error
            text = re.sub(rf"^Theorem {begun[-1]}\b.*?\bQed\.$", "", text, count=1, flags=re.MULTILINE | re.DOTALL)
    return failed


def _compiled(folder: Path, name: str, text: str) -> str:
    """What coqc objects to, as line n: the message; empty where it accepts."""
    (folder / name).write_text(text, encoding="utf-8")
    try:
        run = subprocess.run(["coqc", "-q", name], cwd=folder, capture_output=True, text=True, timeout=_LONGEST)
    except subprocess.TimeoutExpired:
        return f"it takes more than {_LONGEST} s"
    if run.returncode == 0:
        return ""
    said = " ".join((run.stderr or run.stdout).split())
    return re.sub(r'^File "[^"]*", (line \d+), characters [\d-]+: (?:Error: )?', r"\1: ", said)[:300] or "coqc failed"


def foreign_word(text: str) -> str:
    """What in a file is neither the preamble, nor a theorem about a line, nor a comment; empty where all is."""
    before, preamble, plain = _without_comments(text).partition(PREAMBLE)
    if not preamble or before.strip():
        return "another beginning than the preamble of certificates"
    if '"' in text:  # also in a comment, where Coq reads one
        return "a string"
    starts = (re.match(r"\w+|.", sentence.lstrip(_MARKS)) for sentence in _END.split(plain))
    other = [start[0] for start in starts if start and start[0] not in _SENTENCES and not start[0][0].islower()]
    names = re.findall(r"\bTheorem\s+([^\s:({]+)", plain)
    other += [f"a theorem {name}" for name in names if not _NAME.fullmatch(name)]
    return next(iter(other), "")


def _without_comments(text: str) -> str:
    """The text with a space for each comment, which may hold others."""
    kept, depth = [], 0
    for part in re.split(r"(\(\*|\*\))", text):
        depth += {"(*": 1, "*)": -1}.get(part, 0)
        if depth == 0:
            kept.append(" " if part == "*)" else part)
    return "".join(kept)
