"""Formulas for browsers: LaTeX as MathML (`mathml_latex`), and the mathematical font that the page carries (`font`)."""
