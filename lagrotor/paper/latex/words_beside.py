"""What the words beside a displayed equation say of it: a condition, another case, an equation to be solved, an identity."""

import re
from collections.abc import Collection

# What the text says where two sides agree only under a condition.
CONDITIONS = re.compile(
    r"\b(?:modulo|(?<!add )(?<!adds )(?<!sum )up to|(?:anti)?symmetr\w*|neglect\w*|drop\w*|ignor\w*|omit\w*|order|approximat\w*"
    r"|by parts|boundary terms?|relabel\w*|renam\w*|exchang\w*|interchang\w*|rescal\w*|redefin\w*|absorb\w*|on.shell"
    r"|constraint)\b|\bvanish\w*\b(?!\s+(?:at|for|when|if)\b(?!\s+(?:infinity|the|large|both|each)))",
    re.IGNORECASE,
)
# Where the sentence of an equation begins a case of its own, for which what stands before need not hold, unless it is with a
# premise itself; □: the equation, ◦: a premise.
OPENING = re.compile(
    r"(?:^|[.;:]|\b(?:and|but|while|whereas|then)\b)\s*(?:for|if|with|when|at|on|in|near|along|after|under|as)\b[^.;:□◦]*[.;:,]?\s*□",
    re.IGNORECASE,
)
CASES = re.compile(
    r"\b(?:now|half|halves|(?<!differentiating )twice|double\w*|instead|opposite|other|another|special|cases?)\b",
    re.IGNORECASE,
)
# What it says of an equation that states a quantity again, with others put in.
AGAIN = re.compile(
    r"(?:\b(?:substitut\w*|insert\w*|eliminat\w*|in terms of|(?:can|may) be (?:re)?written)\b"
    r"|(?:[◦□]|^\s*(?=[a-z]))[^.;:]*\b(?:becomes?|turns? into|hence|thus|therefore|so that)\b)[^.;:□◦]*□",
    re.IGNORECASE,
)
# The end of the sentence of another display, and the beginning of one, which end with the equation or begin behind it.
_BEFORE, _BEHIND = re.compile(r"^\s*[a-z][^.;!?□]*[.;!?]"), re.compile(r"([.;:!?□]\s*)[A-Z][^.;:!?□]*$")
_FORMULA = re.compile(r"\$[^$]*\$")
# What it says of a letter that is negative.
NEGATIVE = re.compile(
    r"\$([^$<=>]+)(?:<|\\leq?\b)\s*0\s*\$|\$([^$]+)\$\s+(?:is|are|be|was)\s+negative|"
    r"\bnegative\s+(?:\w+\s+)?\$([^$]+)\$(?![\s-]*(?:direction|axis))",
    re.IGNORECASE,
)
# Of the equation itself, and no condition of it.
_OWN_ZERO = re.compile(r"□[\s.,]*(?:it|which|and)?\s*vanish\w*", re.IGNORECASE)
TO_BE_SOLVED = re.compile(
    r"\b(?:if|when\w*|where|unless|until|only|satisf\w*|sol[uv]\w*|roots?|condition\w*|equations?|require\w*|must|equilibri\w*)\b",
    re.IGNORECASE,
)
# What it says of an equation that holds for all values of its letters; □: where the equation stands.
IDENTITY = re.compile(
    r"\b(?:identit\w*|theorems?|formula\w*|recall|remember|for (?:all|any|every)|trigonometr\w*|(?:double|half).angles?)\b"
    r"|\b(?:using|used?|since|because|note that|known?(?: that)?)[\s,:]*□",
    re.IGNORECASE,
)
# What it says where a letter has a meaning of its own.
_GIVES = re.compile(r"\bwhere\s*□|□[\s,.]*(?:is|are) (?:the|an?)\b|\b(?:defin|call|denot|let\b)", re.IGNORECASE)


def said_of(words: str, what: re.Pattern[str], premises: Collection[str] = ()) -> str:
    """What the sentence of an equation says, the first words of a kind; of conditions its paragraph since the last display.

    words: with □ where the equation stands, and formulas between dollar signs; premises: those formulas that are premises, ◦.
    """
    words = _BEHIND.sub(r"\1", _FORMULA.sub(lambda m: "◦" if m[0] in premises else " ", words))
    found = what.search(_OWN_ZERO.sub("□", words) if what is CONDITIONS else _BEFORE.sub("", words))
    return found[0] if found else ""


def gives_a_meaning(words: str) -> bool:
    """Whether the words say what a letter of the equation is."""
    return bool(_GIVES.search(_FORMULA.sub(" ", words)))
