"""The symbols of the paper of the rotor pair: glossary, functions, LaTeX, and abbreviations of expressions."""

from collections import ChainMap

from lagrotor.pair.lagrangians import INERTIAS, J_OF, axis
from lagrotor.pair.notation import GLOSSARY as GLOSSARY
from lagrotor.pair.notation import J

FUNCTIONS = {"axis": axis}
LATEX = {"axis": r"\hat{r}"}
# a, b and k first, then the J that they contain.
WRITTEN_OUT = ChainMap({J: J_OF}, INERTIAS)
