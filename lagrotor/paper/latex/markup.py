r"""Markdown, MyST and notebooks as LaTeX, line by line, so that one reader takes them all."""

import json
import re
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.latex.displays import UNCLOSED, Source, read_latex
from lagrotor.paper.latex.headings import plain_heading

_FENCE = re.compile(
    r"^(?P<fence>`{3,}|~{3,}|:{3,}(?=\{math\}))[ \t]*(?P<info>[^\n`]*)\n(?P<body>.*?)^(?P=fence)`*[ \t]*$",
    re.MULTILINE | re.DOTALL,
)
_FRONT = re.compile(r"\A---[ \t]*\n(.*?\n)(?:---|\.\.\.)[ \t]*\n", re.DOTALL)
# Directives of MyST that hold text, as a note or a theorem does.
_TEXT = re.compile(
    r"\{(?:note|admonition|tip|hint|important|warning|caution|dropdown|margin|prf:\w+|exercise|solution)[\w-]*\}"
)
_INLINE = re.compile(r"(?<![\\$A-Za-z0-9_])\$(?![\s$])((?:[^$\n\\]|\\.|\n(?!\s*\n))*?)(?<!\s)\$(?![\d$])")
_DISPLAY = re.compile(
    r"(?<!\\)\$\$((?:(?!\n\s*\n\s*(?:[A-Za-z]{3,}[\s,.:]|#)).)*?)(?<!\\)\$\$[ \t]*(\n?[ \t]*\((?P<label>[\w:.\-]+)\))?",
    re.DOTALL,
)
_ENVIRONMENT = re.compile(r"\\begin\{(equation|align|gather|multline|eqnarray)(\*?)\}(.*?)\\end\{\1\2\}", re.DOTALL)
_HEADING = re.compile(r"^(#{1,6})[ \t]+(.*?)[ \t#]*$", re.MULTILINE)
_EMPTY_LINE = re.compile(r"\n[ \t]*(?=\n)")  # which Markdown allows in a display
_LEVELS = ("section", "subsection", "subsubsection")
_LARGEST = 20  # MB
_CONTROLS = [chr(code) for code in range(32) if chr(code) not in "\t\n\r\f"]
_TEX = (".tex", ".ltx", ".latex")
SUFFIXES = (*_TEX, ".md", ".myst", ".markdown", ".ipynb")


def read_source(file: Path) -> Source:
    """Return the displayed equations of a .tex, .md or .ipynb file. Raises InputError for another one."""
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{file}: give a .tex, .md or .ipynb file")
    if file.is_file() and (size := file.stat().st_size / 1e6) > _LARGEST:
        raise InputError(f"{file} has {size:.0f} MB, more than {_LARGEST}: give its parts")
    text = read_text(file, "latin-1")
    if text.startswith("%PDF") or 20 * sum(map(text.count, _CONTROLS)) > len(text):
        raise InputError(f"{file} is no text: give the source that it was made from")
    if suffix in _TEX:
        return read_latex(text, file, file.stem)
    text = _cells(text, file) if suffix == ".ipynb" else text
    front = matter[1] if (matter := _FRONT.match(text)) else ""
    titles = re.search(r"^title:[ \t]*(.+)$", front, re.M), re.search(r"^# +(.*?)[ #]*$", _FENCE.sub("", text), re.M)
    title = next((plain_heading(_unquoted(match[1])) for match in titles if match), file.stem)
    source = read_latex(markdown_as_latex(text), None, title)
    source.authors = _authors(front)
    return source


def _authors(front: str) -> tuple[str, ...]:
    """Return the names in the front matter: `author: A. Bee`, `authors: [A. Bee, C. Dee]`, or a list of names or of `name: …`."""
    found = re.search(r"^authors?:[ \t]*(.*(?:\n(?:[ \t]+|-).*)*)", front, re.MULTILINE)
    first, _, rows = found[1].partition("\n") if found else ("", "", "")
    item = re.match(r"[ \t]*(?=-)", rows)
    begins = rf"^{item[0]}(?:-[ \t]+(?:name:[ \t]*)?|[ \t]{{2}}name:[ \t]*)([^:\n]+)$" if item else ""
    names = re.findall(begins, rows, re.MULTILINE) if item else first.strip("[]").split(",")
    return tuple(filter(None, (plain_heading(_unquoted(name)) for name in names)))


def _unquoted(text: str) -> str:
    return text.strip().strip("\"'")


def _cells(text: str, file: Path) -> str:
    """Return the Markdown of a notebook. Raises InputError where it is none."""
    try:
        notebook = json.loads(text)
        cells = notebook["cells"] if "cells" in notebook else notebook["worksheets"][0]["cells"]
        sources = ["".join(cell.get("source") or "") for cell in cells if cell.get("cell_type") == "markdown"]
    except (ValueError, KeyError, TypeError, IndexError, AttributeError):
        raise InputError(f"{file}: it is no notebook: give one that Jupyter can open") from None
    return "\n\n".join(sources).encode("utf-8", "replace").decode()  # half a letter is ?


def markdown_as_latex(text: str) -> str:
    """Return Markdown as LaTeX on the same lines: headings as sections, displays as displays, code and comments left out."""
    pieces: list[str] = []

    def keep(latex: str, print_: str) -> str:
        pieces.append(latex + "\n" * max(print_.count("\n") - latex.count("\n"), 0))
        return f"\x00{len(pieces) - 1}\x00"

    text = re.sub(r"<!--.*?-->", lambda m: keep("", m[0]), _FRONT.sub(lambda m: keep("", m[0]), text), flags=re.DOTALL)
    while (opened := _FENCE.sub(lambda m: f"\n{m['body']}" if _TEXT.match(m["info"]) else m[0], text)) != text:
        text = opened
    text = _FENCE.sub(lambda m: keep(_fenced(m["info"].strip(), m["body"]), m[0]), text)
    text = re.sub(r"(?<!`)(`+)(?!`)[^\n]*?(?<!`)\1(?!`)", lambda m: keep("", m[0]), text)
    text = _DISPLAY.sub(lambda m: keep(_displayed(m[1], m["label"] or ""), m[0]), text)
    text = re.sub(r"(?<!\\)\$\$", lambda m: keep(rf"\{UNCLOSED} ", m[0]), text)
    text = re.sub(r"\\\\\[(.*?)\\\\\]", lambda m: keep(rf"\[{m[1]}\]", m[0]), text, flags=re.DOTALL)
    text = _ENVIRONMENT.sub(lambda m: keep(_EMPTY_LINE.sub("\n%", m[0]), m[0]), text)
    text = _INLINE.sub(lambda m: keep(rf"\({m[1]}\)", m[0]), text)
    text = _HEADING.sub(lambda m: keep(_heading(m[1], m[2]), m[0]), text)
    text = re.sub(r"[\\%#&$_^{}~]", " ", text)
    while "\x00" in text:
        text = re.sub(r"\x00(\d+)\x00", lambda m: pieces[int(m[1])], text)
    return text


def _heading(hashes: str, title: str) -> str:
    level = len(hashes) - 2
    return rf"\{_LEVELS[min(level, 2)]}{{{re.sub(r'[%#&$_^~]', ' ', title)}}}" if level >= 0 else ""


def _fenced(info: str, body: str) -> str:
    """Return a fenced block of mathematics as a display, another one as nothing."""
    options = dict(re.findall(r"^:(\w+):[ \t]*(.*)$", body, re.MULTILINE))
    body = re.sub(r"^:\w+:[^\n]*$|^---$", "", body, flags=re.MULTILINE)
    return _displayed(body, options.get("label", "")) if re.match(r"\{math\}|math\b", info) else ""


def _displayed(body: str, label: str) -> str:
    """Return a display; one with a label in brackets has a number: the label, where it is one, else the next."""
    body = _EMPTY_LINE.sub("\n%", body)
    inner = _ENVIRONMENT.fullmatch(body.strip("%\n\t "))
    if inner and not label:
        return body if r"\label" in body or r"\tag" in body else rf"\begin{{{inner[1]}*}}{inner[3]}\end{{{inner[1]}*}}"
    if inner:
        body = rf"\begin{{aligned}}{inner[3]}\end{{aligned}}" if inner[1] != "equation" else inner[3]
    if re.match(r"\d", label):
        return rf"\begin{{equation*}}{body}\tag{{{label}}}\end{{equation*}}"
    return rf"\begin{{equation}}\label{{{label}}}{body}\end{{equation}}" if label else rf"\[{body}\]"
