"""A folder of certificates: a file of Coq for each equation, and `certificates.json`, which lists every line and its theorems."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from lagrotor.errors import InputError
from lagrotor.files import read_text, write_text
from lagrotor.paper.catalogue import Catalogue
from lagrotor.paper.certificates.certificate import CertifiedLine, certificate, file_name
from lagrotor.paper.verdicts import Verdict

CERTIFICATE_LIST = "certificates.json"


@dataclass(frozen=True)
class CertifiedEquation:
    """One equation of a folder: its verdict, its file ("" where it has none), its lines."""

    id: str
    verdict: str
    file: str
    lines: tuple[CertifiedLine, ...]


def certify(verdicts: Iterable[Verdict], paper: Catalogue, folder: Path) -> list[CertifiedEquation]:
    """Write a file for each equation that has a certificate, and the list; what an earlier run wrote there goes.

    Raises InputError where the folder cannot be written to, or holds something else.
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
    """What a folder of certificates lists. Raises InputError where it is none."""
    if not (folder / CERTIFICATE_LIST).is_file():
        raise InputError(f"{folder} has no {CERTIFICATE_LIST}: write one with lagrotor audit --certify {folder}")
    try:
        rows = [_row(each) for each in json.loads(read_text(folder / CERTIFICATE_LIST))]
    except (ValueError, TypeError, KeyError, AttributeError):
        raise InputError(
            f"{folder / CERTIFICATE_LIST} cannot be read: write it again with lagrotor audit --certify"
        ) from None
    for row in rows:
        if row.file and (row.file != file_name(row.id) or not (folder / row.file).is_file()):
            raise InputError(f"{folder / CERTIFICATE_LIST} lists {row.file!r}, which is not there: write it again")
    return rows


def _row(each: dict[str, Any]) -> CertifiedEquation:
    lines = (CertifiedLine(**{**line, "theorems": tuple(map(str, line["theorems"]))}) for line in each["lines"])
    return CertifiedEquation(str(each["id"]), str(each["verdict"]), str(each["file"]), tuple(lines))
