"""The report of a paper: every equation, claim and figure with its result. The package computes nothing by itself.

The data pass through these modules in this order:

- `job.steps`: a `JobStep` is one derivation, claim or figure; `job.dependencies` gives the digest of all that it is made from.
- `job.processes` runs the steps on all cores; `job.cache` keeps numbers and figures for later runs.
- `content.Report` holds all results of one run. `facts` gives its sentences, `errata` its refuted equations.
- `page` writes the report as HTML, `text_forms` as Markdown and as LaTeX, with `formulas` and `latex` for the formulas.
- `job.folder` puts the new report in the place of the last one, only when it is whole; `job.reproduce` calls all these.

To add a section, name it in `content.contents` and write it twice: in `page.sections` for HTML and in `text_forms` for the
other forms. A paper's own sections of tables and figures need no code; they are the `[[part]]` entries of its `paper.toml`.
"""
