"""The English words beside an equation: assumptions of its paragraph; conditions, reasons and meanings in its sentence."""

import re
from collections.abc import Collection

# Words of a paragraph by which two members may agree approximately only. □: the equation, ◦: a premise of the step.
ASSUMPTION = re.compile(
    r"\b(?:neglect|drop|ignor|omit|approximat|(?:anti)?symmetr|relabel|renam|exchang|interchang|rescal|redefin|absorb)\w*\b"
    r"|\b(?:modulo|(?<!add )(?<!adds )(?<!sum )up to|by parts|boundary terms?|order|small|limit|on.shell)\b",
    re.IGNORECASE,
)
# Words of a sentence by which two members may agree under a condition only, or belong to another case.
CONDITION = re.compile(
    r"\b(?:if|unless|until|only|provided|when|whenever|set|let|half|halves|twice|instead|opposite|other|another|special|cases?)\b"
    r"|\b(?:setting|choos|suppos|assum|impos|requir|must|demand|satisf|solv|solution|root|condition|constraint|equilibri)\w*\b"
    r"|\b(?:resonan|balanc|vanish|repuls|double)\w*\b|\bwith (?:one|two|three)\b"
    r"|\b(?:where|at|near)\b[^□]*□|^\s*for\b(?![^□]*◦)[^□]*□",
    re.IGNORECASE,
)
# Words of a sentence that name a law for which two members may agree.
REASON = re.compile(r"\b(?:by|since|because|as|for|law\w*|theorem\w*|conserv\w*|equations?|equal\w*)\b", re.IGNORECASE)
# Words of a sentence that call an equation an identity.
IDENTITY = re.compile(
    r"\b(?:identit\w*|recall|remember|for (?:all|any|every)|trigonometr\w*|(?:double|half).angles?)\b"
    r"|\b(?:using|used?|note that|known?(?: that)?)[\s,:]*□",
    re.IGNORECASE,
)
# Words of a sentence that give a letter of the equation its meaning.
MEANING = re.compile(r"\bwhere\s*□|□[\s,.]*(?:is|are) (?:the|an?)\b|\b(?:defin|call|denot|let\b)", re.IGNORECASE)
_ITSELF_ZERO = re.compile(r"□[\s.,]*(?:it|which|and)?\s*vanish\w*", re.IGNORECASE)
_FORMULA, _SENTENCE = re.compile(r"\$[^$]*\$"), re.compile(r"[^.!?□]*□[^.;:!?□]*")


def said_of(words: str, what: re.Pattern[str], premises: Collection[str] = ()) -> str:
    """Return the first words of a kind beside an equation; of `ASSUMPTION` in its paragraph, of others in its sentence.

    Parameters
    ----------
    words : str
        The paragraph, with □ where the equation stands and formulas between dollar signs.
    what : re.Pattern
        The kind of words.
    premises : Collection of str
        The formulas that are premises of the step, which a sentence may name.
    """
    words = _FORMULA.sub(lambda m: "◦" if m[0] in premises else " ", words)
    if what is not ASSUMPTION:
        sentence = _SENTENCE.search(_ITSELF_ZERO.sub("□", words))
        words = sentence[0] if sentence else ""
    match = what.search(words)
    return " ".join(match[0].replace("□", "").split()) if match else ""
