"""A folder of certificates, and its check by Coq's kernel.

The folder has a Coq file for each equation, a preamble of lemmas and theorems, and `certificates.json`, which lists every
line with its theorems. `coqc` compiles several files at once.
"""

import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from os import cpu_count
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError, LagrotorError
from lagrotor.files import read_text, write_text
from lagrotor.paper.catalogue import Catalogue
from lagrotor.paper.verdicts import Verdict
from lagrotor.proofs.coq.certificate import PREAMBLE, CertifiedLine, certificate, file_name

CERTIFICATE_LIST = "certificates.json"


@dataclass(frozen=True)
class CertifiedEquation:
    """An equation of a folder: its verdict, the name of its file ("" if it has none), and its lines."""

    id: str
    verdict: str
    file: str
    lines: tuple[CertifiedLine, ...]


def certify(verdicts: Iterable[Verdict], paper: Catalogue, folder: Path) -> list[CertifiedEquation]:
    """Write a Coq file for each equation that has a certificate, and the list of all lines; remove files of an earlier run.

    Raises InputError if the folder cannot be written to, or contains other files.
    """
    old = read_certificates(folder) if (folder / CERTIFICATE_LIST).is_file() else []
    if not old and folder.is_dir() and any(folder.iterdir()):
        raise InputError(f"{folder} holds other files: give a new or an empty folder, or one of certificates")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: {error.strerror}: give a folder that can be written to") from None
    rows, names = [], set[str]()
    for verdict in verdicts:
        text, lines = certificate(verdict, paper.equation(verdict.id))
        name = file_name(verdict.id) if text else ""
        if name and name in names:
            raise InputError(f"two equations would be written to {name}: let their ids differ in letters or digits")
        names.add(name)
        if name:
            write_text(folder / name, text)
        rows.append(CertifiedEquation(verdict.id, verdict.verdict, name, lines))
    for row in old:
        if row.file not in names:
            (folder / row.file).unlink(missing_ok=True)
    listed = [asdict(row) | {"lines": [_listed(line) for line in row.lines]} for row in rows]
    write_text(folder / CERTIFICATE_LIST, json.dumps(listed, indent=1, ensure_ascii=False) + "\n")
    return rows


def _listed(line: CertifiedLine) -> dict[str, Any]:
    return {name: value for name, value in asdict(line).items() if name != "text"}


def read_certificates(folder: Path) -> list[CertifiedEquation]:
    """Return the list of a folder of certificates. Raises InputError if it has none."""
    if not (folder / CERTIFICATE_LIST).is_file():
        raise InputError(f"{folder} has no {CERTIFICATE_LIST}: write one with lagrotor audit --certify {folder}")
    try:
        rows = [_row(data) for data in json.loads(read_text(folder / CERTIFICATE_LIST))]
    except (ValueError, TypeError, KeyError, AttributeError):
        file = folder / CERTIFICATE_LIST
        raise InputError(f"{file} cannot be read: write it again with lagrotor audit --certify") from None
    for row in rows:
        if row.file and (row.file != file_name(row.id) or not (folder / row.file).is_file()):
            raise InputError(f"{folder / CERTIFICATE_LIST} lists {row.file!r}, which is not there: write it again")
    return rows


def _row(data: dict[str, Any]) -> CertifiedEquation:
    lines = (CertifiedLine(**{**line, "theorems": tuple(map(str, line["theorems"]))}) for line in data["lines"])
    return CertifiedEquation(str(data["id"]), str(data["verdict"]), str(data["file"]), tuple(lines))


# Time limit for a file, s.
_LONGEST = 300
# Batches of files for each core.
_BATCHES = 4
# The first words of sentences after the preamble. They exclude axioms, notations and lemmas: a lemma `sin` would replace the
# sine in all later statements.
_SENTENCES = frozenset(["Theorem", "Proof", "Qed"])
_NAME = re.compile(r"(line|correction)_\d+(_\w+)?")
# The end of a sentence; the next one can begin with bullets.
_END = re.compile(r"(?:(?<!\.)|\.\.)\.(?:\s|\Z)|[{}]")
_MARKS = " \t\r\n+-*"
_TO_INSTALL = "install Debian's packages coq and libcoq-interval (apt-get install coq libcoq-interval)"


@dataclass(frozen=True)
class Checked:
    """The result of checking one line: accepted, rejected or skipped. `why` is the reason if it was not accepted."""

    id: str
    line: CertifiedLine
    status: str
    why: str = ""


def missing_coq() -> str:
    """Return the reason why nothing can be checked; empty if Coq and its Interval library are installed."""
    if shutil.which("coqc") is None:
        return f"coqc is not on the PATH: {_TO_INSTALL}"
    with tempfile.TemporaryDirectory() as folder:
        failed = _compile(Path(folder), "needed.v", PREAMBLE)
    return f"coqc has no Interval library ({failed}): {_TO_INSTALL}" if failed else ""


def check_certificates(folder: Path, begins: Callable[[str], None] = lambda name: None) -> list[Checked]:
    """Check every certificate of a folder, in parallel; `begins` is called with the id of each equation before its check.

    Raises InputError for a folder without certificates, LagrotorError without Coq.
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
        results = {i: lines for failures_by_row in pool.map(checked, batches) for i, lines in failures_by_row.items()}
    return [result for i in range(len(rows)) for result in results[i]]


def _lines(row: CertifiedEquation, failed: Mapping[str, str]) -> Iterator[Checked]:
    for line in row.lines:
        if not line.theorems:
            yield Checked(row.id, line, "skipped", line.why_not)
        elif wrong := next((failed[name] for name in ("", *line.theorems) if name in failed), ""):
            yield Checked(row.id, line, "rejected", wrong)
        else:
            yield Checked(row.id, line, "accepted")


def _failures_of(files: Sequence[tuple[CertifiedEquation, str]]) -> list[dict[str, str]]:
    """Return {rejected theorem: reason} for each file; the key "" stands for the whole file.

    Coq takes longer to load its libraries than to check most files. All files are compiled together, each as a module, and
    one by one only if that fails.
    """
    wrong = [_malformed(row, text) for row, text in files]
    sound = [(row, text) for (row, text), reason in zip(files, wrong, strict=True) if text and not reason]
    together = PREAMBLE
    for row, text in sound:
        name = row.file.removesuffix(".v")
        together += f"\nModule {name}.\n{text.partition(PREAMBLE)[2]}\nEnd {name}.\n"
    with tempfile.TemporaryDirectory() as folder:
        accepted = len(sound) > 1 and not _compile(Path(folder), "together.v", together)
    rows = zip(files, wrong, strict=True)
    return [{"": why} if why else {} if accepted or not text else _failures(row, text) for (row, text), why in rows]


def _malformed(row: CertifiedEquation, text: str) -> str:
    """Return in words what makes the text of a file unacceptable; empty if nothing does."""
    if text and (word := foreign_word(text)):
        return f"the file holds {word}, which is no part of a certificate"
    for name in (name for line in row.lines for name in line.theorems):
        if len(re.findall(rf"^Theorem {re.escape(name)}\b", text, re.MULTILINE)) != 1:
            return f"the file does not hold one theorem {name}"
    return ""


def _failures(row: CertifiedEquation, text: str) -> dict[str, str]:
    """Return {rejected theorem: reason}, with "" for the whole file. A rejected theorem is omitted in the next attempt."""
    failed: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        while error := _compile(Path(folder), row.file, text):
            place = re.match(r"line (\d+)", error)
            head = "\n".join(text.split("\n")[: int(place[1])]) if place else ""
            begun = re.findall(r"^Theorem (\w+)", head, re.MULTILINE)
            if not begun or begun[-1] in failed:
                return {"": error}
            failed[begun[-1]] = error
            text = re.sub(rf"^Theorem {begun[-1]}\b.*?\bQed\.$", "", text, count=1, flags=re.MULTILINE | re.DOTALL)
    return failed


def _compile(folder: Path, name: str, text: str) -> str:
    """Compile a file, and return the objection of coqc as "line n: message"; empty if coqc accepts the file."""
    (folder / name).write_text(text, encoding="utf-8")
    try:
        run = subprocess.run(["coqc", "-q", name], cwd=folder, capture_output=True, text=True, timeout=_LONGEST)
    except subprocess.TimeoutExpired:
        return f"it takes more than {_LONGEST} s"
    if run.returncode == 0:
        return ""
    message = " ".join((run.stderr or run.stdout).split())
    place = r'^File "[^"]*", (line \d+), characters [\d-]+: (?:Error: )?'
    return re.sub(place, r"\1: ", message)[:300] or "coqc failed"


def foreign_word(text: str) -> str:
    """Return the first content of a file that is not a preamble, a theorem about a line, or a comment; empty if all is."""
    head, preamble, plain = _without_comments(text).partition(PREAMBLE)
    if not preamble or head.strip():
        return "another beginning than the preamble of certificates"
    if '"' in text:  # Coq reads strings in comments, too
        return "a string"
    starts = (re.match(r"\w+|.", sentence.lstrip(_MARKS)) for sentence in _END.split(plain))
    words = [start[0] for start in starts if start and start[0] not in _SENTENCES and not start[0][0].islower()]
    names = re.findall(r"\bTheorem\s+([^\s:({]+)", plain)
    words += [f"a theorem {name}" for name in names if not _NAME.fullmatch(name)]
    return next(iter(words), "")


def _without_comments(text: str) -> str:
    """Return the text with a space for each comment, also for nested ones."""
    tokens, depth = [], 0
    for token in re.split(r"(\(\*|\*\))", text):
        depth += {"(*": 1, "*)": -1}.get(token, 0)
        if depth == 0:
            tokens.append(" " if token == "*)" else token)
    return "".join(tokens)
