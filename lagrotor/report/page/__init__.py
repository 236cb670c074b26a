"""The report as HTML: `html_elements` (formulas, tables, badges, derivations), `sections` made of them, `pages` made of sections.

`interactive` is the model with sliders, with formulas generated as JavaScript. Styles and scripts lie beside the modules. To
add an entry to a page, write it in `sections` from the functions of `html_elements`: these escape the text and typeset the
formulas.
"""
