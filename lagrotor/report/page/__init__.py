"""The report as HTML: `html_elements` (formulas, tables, badges, derivations), `sections` and `pages`.

`interactive` is the model with sliders; its formulas are generated as JavaScript. Styles and scripts lie beside the modules. To
add an entry, write it in `sections` with the functions of `html_elements`, which escape text and typeset formulas.
"""
