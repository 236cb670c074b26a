"""Verdicts as Coq files: the statement and a proof that Coq's kernel checks without lagrotor and sympy."""
