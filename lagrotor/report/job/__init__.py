"""The job `lagrotor reproduce`: the work is divided into steps, which run in parallel and reuse cached results.

To add a kind of step, yield a `JobStep` in `steps.steps`. The step's result is cached if JSON can represent it.
"""
