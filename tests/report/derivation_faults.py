"""What a reader would mark on the page of a derivation."""

import re
from html import escape, unescape
from unittest.mock import patch

from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.page.html_elements import derivation_html

# The paper has two letters, φ for the node angle and ϕ for the azimuth; these pages say how they are related.
BOTH = ("s5_2a_single_rotor", "s5_2b_pair")
_HEADING = re.compile(r"<h(\d)[^>]*>((?:(?!</h).)*)</h\d>\s*(?:(?=<h(\d))|$)", re.DOTALL)
_PYTHON = re.compile(r"\{\w*:|\w=\{|\w\(\w+=|\barray\(|\bnp\.|dtype|<\w+ object|\bobject at\b|[=(,] ?None\b|\d\.\d{9}")


def derivation_faults(html: str, stem: str = "") -> list[str]:
    """Headings and colons without content, warnings, values as Python prints them, a letter in two forms, empty paragraphs."""
    found = [f"nothing below {text}" for rank, text, after in _HEADING.findall(html) if not after or after <= rank]
    words = _text(re.sub(r"<(math|code)\b.*?</\1>", " ", html, flags=re.DOTALL))
    found += [f"warning: {line}" for line in re.findall(r".*Warning.*", words)]
    found += [f"Python: {match[0]}" for match in _PYTHON.finditer(words)]
    found += [f"nothing after {end}:" for end in re.findall(r"([^<>]*):</p>\s*(?=<h\d|$)", html)]
    letters = _text(html)
    forms = [any(form in letters for form in of) for of in (("φ", r"\varphi"), ("ϕ", r"\phi"))]
    found += ["φ and ϕ"] * (all(forms) and stem not in BOTH)
    return found + ["an empty paragraph"] * len(re.findall(r"<p>\s*</p>", html))


def _text(html: str) -> str:
    return unescape(re.sub(r"<[^>]+>", "", html))


def faults_of(stem: str) -> list[str]:
    """The faults on the page of one derivation of the pair, which runs if it has not run yet. Formulas stay LaTeX."""

    def source(latex: str, display: bool = True) -> str:
        return f"<code>{escape(latex)}</code>"

    script, where = PAPER.scripts.executed("derivations", stem), "lagrotor.report.{}.mathml"
    with patch(where.format("page.html_elements"), source), patch(where.format("formulas.mathml_latex"), source):
        return derivation_faults(derivation_html(script, {}), stem)
