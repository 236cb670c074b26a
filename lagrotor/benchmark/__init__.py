"""Speed against accuracy, and the limits of each method.

`scenes_and_methods` names scenes and methods; `runner` runs each method at every tolerance against one reference. `limits`
predicts each limit of a method by a formula and measures it; `throughput` measures ensembles. `records` reads comparisons with
other tools, each with its date, machine and a digest of the measured code. `mechanism_tables` shows the comparisons of
mechanisms.
"""
