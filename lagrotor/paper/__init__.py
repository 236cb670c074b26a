"""The trial of printed mathematics, for any paper.

`Paper` is a folder; `judge` needs none. A derivation uses `prove`, `verdict`, `Premise`, `Formula`, `Remark`, `Table`; the test
of a claim `ClaimTest`, `Finding`, `Part`; and `symbols.py` `Glossary`.
"""

from lagrotor.mechanics.glossary import Glossary as Glossary
from lagrotor.paper.claim_tests import ClaimTest as ClaimTest
from lagrotor.paper.claim_tests import Finding as Finding
from lagrotor.paper.claim_tests import Part as Part
from lagrotor.paper.ledger import judge as judge
from lagrotor.paper.papers import Paper as Paper
from lagrotor.paper.premises import Premise as Premise
from lagrotor.paper.proof import Formula as Formula
from lagrotor.paper.proof import Remark as Remark
from lagrotor.paper.proof import prove as prove
from lagrotor.paper.stating import verdict as verdict
from lagrotor.paper.tables import Table as Table
