"""What the tests of the report share: formulas that are typed where they should be typeset."""

import re
from collections.abc import Callable
from html import unescape

import pytest

# What a formula typed on a keyboard looks like outside mathematics and code.
ASCII = re.compile(
    r"\w_\w|\*\*|\w\*\w|\d[eE][-+]?\d|\$|\\[A-Za-z]+|\^|\b(?:ell|theta|phi|psi|[oO]mega|sigma|alpha|sqrt)\b|->|>=|<=|"
    r"\b[rFfJ] x [rFf]\b|<\w+'>|(?<![\w−])-\d"
)


@pytest.fixture(scope="session")
def typed_formulas() -> Callable[[str], list[str]]:
    """The texts of a page, descriptions of pictures left out, in which a formula is typed in ASCII or in raw LaTeX."""

    def found(html: str) -> list[str]:
        bare = re.sub(r"<(style|script|math|pre|code)\b.*?</\1>", " ", html, flags=re.DOTALL)
        bare = re.sub(r"<(sub|sup)>(.*?)</\1>", r"\2", bare)
        return [text.strip() for text in map(unescape, re.findall(r">([^<>]+)<", bare)) if ASCII.search(text)]

    return found
