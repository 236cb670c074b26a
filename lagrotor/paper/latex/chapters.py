"""What a chapter is about, where letters may be no numbers: it has words of such texts, several on each page."""

import re
from collections import Counter
from collections.abc import Mapping

GROUPS, MEASURES, PROOFS = "groups", "measures", "proofs"
# What a reading takes for certain elsewhere, and not in such a text.
TAKEN = {
    GROUPS: "letters are numbers, and no elements of a group, sets or maps",
    MEASURES: "what d stands before is a variable, and no measure",
    PROOFS: "letters are numbers or functions of them, and no sets, maps or matrices",
}
_OF_GROUPS = (
    r"sub-?groups?|cosets?|(?:homo|endo|iso|auto|epi|mono)?morphisms?|(?:monoid|semigroup)s?|"
    r"identity element|ideals|(?:prime|maximal|principal) ideal|"
    r"abelian|(?:normal|quotient|cyclic|symmetric|alternating|dihedral|permutation|Galois|free|finite) (?:sub)?groups?|"
    r"group (?:actions?|axioms|operation)|(?:integral|euclidean) domains?|(?:commutative|polynomial|noetherian|quotient) rings?|"
    r"field extensions?|Galois|Sylow|functors?|functorial|transpositions?|permutations?|ordinals?|"
    r"conjugacy class(?:es)?|(?:sub|bi)modules?|^-modules?|sheaf|sheaves|automat(?:a|on)|regular expressions?|cardinality|"
    r"ordinals?|transfinite|well-order\w*|axiom of choice|countable sets?|"
    r"Untergruppen?|Nebenklassen?|Homomorphism(?:us|en)|(?:homo|endo|iso|auto)?mor(?:phismes?|fismos?)|sous-groupes?|"
    r"anneaux?|subgrupos?|子群|同态|同构|陪集|置换|阿贝尔群|交换群"
)
_OF_MEASURES = (
    r"measurable (?:functions?|sets?|spaces?|maps?)|measure spaces?|measure theory|almost (?:everywhere|surely|sure)|"
    r"Radon measures?|Nikod[yý]m|absolutely continuous|Lebesgue|Borel|(?:sigma|σ)-(?:algebras?|fields?|finite)|^-algebras?|"
    r"probability (?:measures?|spaces?)|messbare?n?|mesurables?|测度|可测|可积函数|几乎处处"
)
_OF_PROOFS = (
    r"theorems?|lemmas?|corollar(?:y|ies)|propositions?|proofs?|axioms?|bijecti\w+|surjecti\w+|injecti\w+|random variables?|"
    r"i\.i\.d\.|estimators?|priors?|posteriors?|likelihood|regression|neural|reward|polic(?:y|ies)|loss function|"
    r"graphs? with|finite sets?|subsets?|vector spaces?|linear maps?|Banach|Hilbert space|Satz|Beweis|Lemmata?|théorèmes?|"
    r"démonstration|preuve|teoremas?|teorema|demostración|dimostrazione|定理|引理|证明|推论"
)
# Of a text about quantities, whose letters are numbers.
_OF_QUANTITIES = (
    r"veloc\w+|speeds?|acc?eler\w+|mass(?:es|ive|a|e)?|forces?|forza|energ\w+|moment(?:um|a|o)|torques?|press(?:ure|ion)\w*|"
    r"temperat\w+|entrop\w+|heat|calor\w*|chaleur|wärme\w*|thermo\w+|termo\w+|currents?|voltages?|wave-?\w*|ond[ae]s?|"
    r"frequenc\w+|fréquences?|oscillat\w+|pend(?:ulums?|olo|el)|particles?|electrons?|photons?|atoms?|electr\w+|elettr\w+|"
    r"magnet\w+|quantum|Hamiltonians?|Lagrangians?|gravit\w+|viscos\w+|flui\w+|spins?|gyroscop\w+|radi(?:us|i)|phys\w+|"
    r"fisic\w+|físic\w+|optic\w*|Geschwindigkeit\w*|Kraft|Kräfte|Masse|Druck|vitesse\w*|fuerza\w*|速度|质量|能量|电场|温度|"
    r"动量|力学|物理|粒子|频率|磁场|电荷|电流|运动|波函数|哈密顿|拉格朗日|压强"
)
_QUANTITIES = "quantities"
_LETTER = "[a-zß-ÿ]"  # Chinese words have no spaces between them


def _whole(subject: str, words: str) -> str:
    return rf"(?P<{subject}>(?<!{_LETTER})(?:{words})(?!{_LETTER}))"


_WORDS = re.compile(
    rf"{_whole(GROUPS, _OF_GROUPS)}|(?P<{MEASURES}>{_OF_MEASURES})|{_whole(PROOFS, _OF_PROOFS)}|"
    rf"{_whole(_QUANTITIES, _OF_QUANTITIES)}",
    re.IGNORECASE,
)
_PAGE = 1500  # characters
_LENGTH = "characters"


def count_words(text: str, counts: Counter[str]) -> None:
    """Add to the counts the length of a text, and how often it has words of each subject."""
    counts[_LENGTH] += len(text)
    counts.update(each.lastgroup for each in _WORDS.finditer(text) if each.lastgroup)


def subjects_of(chapters: Mapping[str, Counter[str]]) -> dict[str, str]:
    """What each chapter is about; what most are about, all are."""
    about = {subject: {name for name, counts in chapters.items() if _is_about(counts, subject)} for subject in TAKEN}
    if not _speaks_of_proofs(sum(chapters.values(), Counter())):
        about[PROOFS] = set()
    whole = [subject for subject, names in about.items() if 2 * len(names) > len(chapters)]
    return {name: " ".join(each for each in TAKEN if each in whole or name in about[each]) for name in chapters}


def _is_about(counts: Counter[str], subject: str) -> bool:
    """Whether words of a subject stand on each page, and three of them or one in few lines."""
    times, length = counts[subject], counts[_LENGTH]
    if subject == PROOFS and not _speaks_of_proofs(counts):
        return False
    return times * _PAGE > length and (times > 2 or times * _PAGE > 4 * length)


def _speaks_of_proofs(counts: Counter[str]) -> bool:
    """Whether a text has more words of proofs than of quantities."""
    return counts[PROOFS] > counts[_QUANTITIES]
