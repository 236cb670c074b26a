"""Speed against accuracy, and where each method fails.

- `scenes_and_methods` names the scenes and methods, and `runner` runs each method at every accuracy against one
  reference.
- `limits` predicts each threshold of a method by a formula and measures it; `throughput` measures ensembles.
- `records` reads comparisons with other tools, each with its date, machine and a digest of the code that was
  measured; `mechanism_tables` shows those of mechanisms.
"""
