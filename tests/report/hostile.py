"""A report of the rotor pair's paper in which every text that comes from outside is hostile to the form that it is written in."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import sympy as sp

from lagrotor.pair.notation import M, r0
from lagrotor.paper import FigureLink, Finding, Part, Relation, Result, Statement, Table, chain, claim_tests, decide
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.pictures import Picture
from lagrotor.report.content import Report, ResultSection

LONG = sp.Add(*sp.symbols("x_1:60"))
SVG = '<svg viewBox="0 0 40 30" xmlns="http://www.w3.org/2000/svg"><path d="M 0 0 L 40 30"/></svg>'
# The live model has tests of its own; here a heading stands for it.
MODEL = '<section id="model"><h2>The interactive model</h2></section>'


def short_report(text: str, folder: Path) -> Report:
    """Return a report with one section, a refuted equation, figure 17 and a derivation; its pictures are in `folder`/figures."""
    (folder / "figures").mkdir()
    svg, png = folder / "figures" / "fig17_stub.svg", folder / "figures" / "fig17_stub.png"
    svg.write_text(SVG)
    matplotlib.image.imsave(png, np.zeros((40, 60)))
    judged = [decide(statement) for statement in PAPER.statements("s5_2a_single_rotor")]
    corrected = Statement(
        "5.20",
        chain(sp.cos(r0), sp.Integer(1) + r0, small=r0, claimed=1),
        correction=(Relation(sp.cos(r0), sp.cos(r0), quantity="c"),),
        depends_on=("5.06",),
        evidence=(text,),
    )
    judged.append(replace(decide(corrected), reaches_result=True))
    picture = Picture("fig17_stub", "17", text, text, text, svg, png, {text: 1.25})
    derivation = ("s5_2a_single_rotor", text, "<p>inside</p>")
    made = {"versions": (("Python", "3"), ("sympy", "1")), "inputs": (("package", "0a" * 32),)}
    figures = (ResultSection("figures", "Figures", pictures=(picture,)),)
    return Report(PAPER, tuple(judged), (picture,), (text,), (), figures, (derivation,), MODEL, **made)


def long_report(report: Report, text: str) -> Report:
    """Return the same with a claim, and with figures, tables and remarks past the paper."""
    pictures = [
        replace(report.pictures[0], stem=f"{key}_stub", key=key, measured={}) for key in ("19", "t6", "b1", "m3")
    ]
    row = (text, ("holds:", sp.Eq(r0, M**2), sp.Abs(r0), sp.Eq(r0, LONG / M)), FigureLink("t6"), FigureLink("t7"))
    table = Table("what holds", ("subject", "formula", "figure", "not drawn"), (row,), text)
    finding = Finding((Part(text, False, text),), text)
    test = claim_tests.ClaimTest("C16", (10, -10), {}, text, lambda spins: {}, lambda measured: finding)
    result = Result(test, {"what_is_read": 1.5}, finding, 0.25)
    drawn = (*report.pictures, *pictures)
    return replace(report, pictures=drawn, claims=(result,), result_sections=tuple(_parts(table, drawn, text)))


def _parts(table: Table, drawn: Iterable[Picture], text: str) -> Iterator[ResultSection]:
    """The parts of the paper's report, each with a table and a remark where it has any, and its figures."""
    for part in PAPER.about.part:
        pictures = tuple(picture for picture in drawn if picture.key.rstrip("0123456789") in part.figures)
        remarks = ((text, text),) if part.remarks else ()
        yield ResultSection(part.name, part.heading, (table,) if part.tables else (), remarks, pictures)
