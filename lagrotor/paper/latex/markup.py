r"""Markdown as LaTeX, line by line, so that one reader takes both."""

import re
from pathlib import Path

from lagrotor.errors import InputError
from lagrotor.files import read_text
from lagrotor.paper.latex.displays import UNCLOSED, Source, read_latex
from lagrotor.paper.latex.headings import plain_heading

_FENCE = re.compile(
    r"^(?P<fence>`{3,}|~{3,})[ \t]*(?P<info>[^\n`]*)\n(?P<body>.*?)^(?P=fence)`*[ \t]*$", re.MULTILINE | re.DOTALL
)
_FRONT = re.compile(r"\A---[ \t]*\n(.*?\n)(?:---|\.\.\.)[ \t]*\n", re.DOTALL)
_INLINE = re.compile(r"(?<![\\$A-Za-z0-9_])\$(?![\s$])((?:[^$\n\\]|\\.|\n(?!\s*\n))*?)(?<!\s)\$(?![\d$])")
_DISPLAY = re.compile(r"(?<!\\)\$\$((?:(?!\n\s*\n\s*(?:[A-Za-z]{3,}[\s,.:]|#)).)*?)(?<!\\)\$\$", re.DOTALL)
_ENVIRONMENT = re.compile(r"\\begin\{(equation|align|gather|multline|eqnarray)(\*?)\}(.*?)\\end\{\1\2\}", re.DOTALL)
_HEADING = re.compile(r"^(#{1,6})[ \t]+(.*?)[ \t#]*$", re.MULTILINE)
_EMPTY_LINE = re.compile(r"\n[ \t]*(?=\n)")  # which Markdown allows in a display
_LEVELS = ("section", "subsection", "subsubsection")
_LARGEST = 20  # MB
_CONTROLS = [chr(code) for code in range(32) if chr(code) not in "\t\n\r\f"]
_TEX = (".tex", ".ltx", ".latex")


def read_source(file: Path) -> Source:
    """Return the displayed equations of a .tex or .md file. Raises InputError for another one."""
    suffix = file.suffix.lower()
    if suffix not in (*_TEX, ".md", ".markdown"):
        raise InputError(f"{file}: give a .tex or .md file")
    if file.is_file() and (size := file.stat().st_size / 1e6) > _LARGEST:
        raise InputError(f"{file} has {size:.0f} MB, more than {_LARGEST}: give its parts")
    text = read_text(file, "latin-1")
    if text.startswith("%PDF") or 20 * sum(map(text.count, _CONTROLS)) > len(text):
        raise InputError(f"{file} is no text: give the source that it was made from")
    if suffix in _TEX:
        return read_latex(text, file, file.stem)
    front = matter[1] if (matter := _FRONT.match(text)) else ""
    titles = re.search(r"^title:[ \t]*(.+)$", front, re.M), re.search(r"^# +(.*?)[ #]*$", _FENCE.sub("", text), re.M)
    title = next((plain_heading(match[1].strip().strip("\"'")) for match in titles if match), file.stem)
    return read_latex(markdown_as_latex(text), None, title)


def markdown_as_latex(text: str) -> str:
    """Return Markdown as LaTeX on the same lines: headings as sections, displays as displays, code and comments left out."""
    pieces: list[str] = []

    def keep(latex: str, print_: str) -> str:
        pieces.append(latex + "\n" * max(print_.count("\n") - latex.count("\n"), 0))
        return f"\x00{len(pieces) - 1}\x00"

    text = re.sub(r"<!--.*?-->", lambda m: keep("", m[0]), _FRONT.sub(lambda m: keep("", m[0]), text), flags=re.DOTALL)
    text = _FENCE.sub(lambda m: keep(_displayed(m["body"]) if m["info"].strip() == "math" else "", m[0]), text)
    text = re.sub(r"(?<!`)(`+)(?!`)[^\n]*?(?<!`)\1(?!`)", lambda m: keep("", m[0]), text)
    text = _DISPLAY.sub(lambda m: keep(_displayed(m[1]), m[0]), text)
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


def _displayed(body: str) -> str:
    """Return a display; an environment within $$ has numbers only by its labels and tags."""
    body = _EMPTY_LINE.sub("\n%", body)
    inner = _ENVIRONMENT.fullmatch(body.strip("%\n\t "))
    if inner is None:
        return rf"\[{body}\]"
    return body if r"\label" in body or r"\tag" in body else rf"\begin{{{inner[1]}*}}{inner[3]}\end{{{inner[1]}*}}"
