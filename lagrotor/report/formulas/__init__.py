"""Formulas for browsers: LaTeX as MathML (`mathml_latex`), and the embedded mathematical font (`font`)."""
