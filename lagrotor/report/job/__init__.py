"""The job `lagrotor reproduce`: `steps`, their digests (`dependencies`), `processes`, the `cache` and the report's `folder`.

To add a kind of step, yield a `JobStep` in `steps.steps`. Its product is cached if JSON can represent it.
"""
