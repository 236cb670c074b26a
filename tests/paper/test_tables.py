"""A table as a notebook shows it: its text as text, its formulas as formulas."""

import sympy as sp

from lagrotor.paper import Table


def test_rows_stand_under_their_head_and_over_the_note() -> None:
    html = Table("t", ("p", "q"), (("1", "2"), ("3", "4")), "why")._repr_html_()
    assert [html.count(f"<{tag}") for tag in ("caption", "tr", "th", "td")] == [1, 3, 2, 4]
    assert html.index(">p<") < html.index(">1<") < html.index(">4<") < html.index(">why<")
    assert "<small>" not in Table("t", ("p",), (("1",),))._repr_html_()


def test_formulas_are_mathml() -> None:
    speed, square = sp.Symbol(r"\dot{X}"), sp.Symbol("Omega") ** 2
    html = Table("t", ("p",), ((("one below", square),), (sp.Eq(speed, square),)))._repr_html_()
    assert html.count("<math ") == html.count("</math>") == 2
    assert "one below<br><math" in html
    assert "<mover><mi>X</mi><mo>˙</mo></mover>" in html
    assert "\\dot" not in html
