"""Tests of the paper's 24 claims, by chapter: each is run, measured, and decided by its numbers alone.

A claim is `measure(case)`, which runs models of the pair and returns numbers, `decide(numbers)`, which makes a finding of
them, and a `ClaimTest` with the paper's case and one foreign case for each part of the sentence, in which that part comes out
otherwise.

`simulator`: sections 3 and 4, the paper's program (C03 to C09). `shock_toppling_and_twist`: sections 2, 5 and 5.1 (C01, C02,
C10 to C13). `precession_and_drift`: sections 5.2 and 6 (C14 to C19, C24). `natural_rates`: section 5.3 (C20 to C23).
`claim_theorems`: the parts that follow from theorems. Runs that claims share are in `rotor_pair.runs`; derivations show the
tests, in `derivations/c_*.py`.
"""
