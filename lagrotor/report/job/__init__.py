"""The main job `lagrotor reproduce`: `steps`, their digests (`dependencies`), `processes`, the `cache`, the report's `folder`.

`reproduce.reproduce` calls all these. To add a kind of step, yield a `JobStep` in `steps.steps`. Its product is cached where
JSON can hold it.
"""
