"""The report as HTML. `html_elements` makes formulas and tables, `sections` the sections from them, `pages` the files.

`interactive` makes the model with sliders; its formulas are generated as JavaScript. Styles and scripts lie beside the modules.
To add an entry, write it in `sections` with the functions of `html_elements`, which escape text and typeset formulas.
"""
