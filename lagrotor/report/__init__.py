"""The report of a paper: every equation, claim and figure with its result. The package only arranges results of other packages.

The modules in the order in which `lagrotor reproduce` uses them:

- `job.steps` lists the steps (`JobStep`): each runs one derivation, tests one claim or draws one figure.
- `job.dependencies` computes the digest of all inputs of a step.
- `job.processes` runs the steps on all cores; `job.cache` stores numbers and figures for later runs.
- `content.Report` holds all results of one run. `facts` writes its sentences, `errata` its refuted equations.
- `page` writes the report as HTML, `text_forms` as Markdown and LaTeX, with `formulas` and `latex` for the formulas.
- `job.folder` replaces the last report once the new one is complete; `job.reproduce` calls all these modules.

To add a section, name it in `content.contents` and write it in `page.sections` for HTML and in `text_forms` for the other forms.
A paper's own sections of tables and figures need no code; they are the `[[part]]` entries of its `paper.toml`.
"""
