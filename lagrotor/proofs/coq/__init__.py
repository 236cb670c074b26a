"""Verdicts as files of Coq: what was decided, and a proof that Coq's kernel checks without lagrotor and sympy."""
