"""The test of printed mathematics, for any paper.

Data pass through these types in this order. A `Paper` is a folder: a `Catalogue` of equations, claims and figures in TOML, with
scripts and a record. `grammar` reads a printed line as sympy objects. A derivation shows formulas, forms and steps (`proof`:
`Formula`, `Form`, `prove`), and states an equation by `verdict` (`equation_statements`). `statement` combines it with the print,
as a `Statement`: each of its relations (`Relation`) is judged under premises (`Premise`). `hypotheses` combines the premises into
one set. The `ledger` decides each line and returns a `Verdict`, which has a `LineVerdict` for each line; a `Theorem`, if there is
one, decides instead. An `Audit` has the verdicts of a paper. A `ClaimTest` simulates a claim that is made in words. `record`
compares verdicts and claims with those on record.

`judge` and `judge_text` need no paper. `latex` reads LaTeX. To add a paper, write its folder (`lagrotor init`); to add a
function that every printed line may call, add it to `grammar.FUNCTIONS`.
"""

from typing import TYPE_CHECKING

from lagrotor.lazy_imports import face

if TYPE_CHECKING:
    from lagrotor.mechanics.glossary import Glossary as Glossary
    from lagrotor.paper.audit import Audit as Audit
    from lagrotor.paper.claim_tests import ClaimTest as ClaimTest
    from lagrotor.paper.claim_tests import Finding as Finding
    from lagrotor.paper.claim_tests import Part as Part
    from lagrotor.paper.claim_tests import Result as Result
    from lagrotor.paper.equation_statements import Stated as Stated
    from lagrotor.paper.equation_statements import verdict as verdict
    from lagrotor.paper.judgement import Judgement as Judgement
    from lagrotor.paper.judgement import judge_text as judge_text
    from lagrotor.paper.latex.stated_system import stated as stated
    from lagrotor.paper.ledger import judge as judge
    from lagrotor.paper.papers import Paper as Paper
    from lagrotor.paper.premises import Premise as Premise
    from lagrotor.paper.premises import parameter_premise as parameter_premise
    from lagrotor.paper.proof import Formula as Formula
    from lagrotor.paper.proof import Remark as Remark
    from lagrotor.paper.proof import Step as Step
    from lagrotor.paper.proof import prove as prove
    from lagrotor.paper.tables import FigureLink as FigureLink
    from lagrotor.paper.tables import Table as Table
    from lagrotor.paper.theorems import Theorem as Theorem
    from lagrotor.paper.verdicts import LineVerdict as LineVerdict
    from lagrotor.paper.verdicts import Series as Series
    from lagrotor.paper.verdicts import Verdict as Verdict
    from lagrotor.result_display import scientific as scientific

__getattr__, __dir__, __all__ = face(__name__)
