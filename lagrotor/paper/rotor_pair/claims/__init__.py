"""Tests of the paper's 24 claims.

Each claim has `measure(case)`, which simulates the pair and returns numbers, and `decide(numbers)`, which returns a finding.
Its `ClaimTest` has the paper's case and, for each part of the sentence, a foreign case for which the decision differs. The
modules are `simulator` (sections 3 and 4, C03 to C09), `shock_toppling_and_twist` (sections 2, 5, 5.1, C01, C02, C10 to C13),
`precession_and_drift` (sections 5.2 and 6, C14 to C19, C24) and `natural_rates` (section 5.3, C20 to C23). `claim_theorems` has
the theorems; the scripts `derivations/c_*.py` show the tests.
"""
