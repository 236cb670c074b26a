"""Simulations of any mechanical system, in the order of the steps of a run.

`programs` generates the equations of motion, by the recursion of a tree of bodies or from the mass matrix. `sweeps` makes the
entries of the mass matrix of a long Lagrangian. `function_values` puts expressions, tables and callables in place of unknown
functions. `initial_state` checks the values and brings the initial state onto the constraints. `scales` measures size and speed
of the motion and its conserved quantities; `narrow_features` finds terms that change within a small part of the motion. `flow`
integrates a smooth motion, `switches` and `phases` one with events, impacts and dry friction; `singular_positions` names a
singular position. `simulation` combines these into a `SystemRun` with its error, whose states `motion` evaluates at any time.
`sections` finds crossings of a section, and `run_plots` draws the run.

Small motion is in `state_space` (about a steady motion), `monodromy` (about a periodic one, and Lyapunov exponents) and
`root_loci` (rates as parameters change).

A new quantity of a run is a method of `SystemRun` that evaluates expressions by `programs.function_program`.
"""
