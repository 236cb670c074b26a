"""The report as HTML and Markdown: complete, escaped, alone in the world, and readable without seeing."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from html.parser import HTMLParser

import pytest
import sympy as sp

from lagrotor.paper.audit import statements
from lagrotor.paper.catalogue import equation, equations
from lagrotor.paper.ledger import Statement, chain, judge
from lagrotor.paper.tables import FigureLink, Table
from lagrotor.report.content import Report
from lagrotor.report.figures import Picture
from lagrotor.report.markdown import markdown
from lagrotor.report.mathml import mathml
from lagrotor.report.page import page
from lagrotor.symbols import ANSATZ, ROTOR, M, r0

HOSTILE = '<script>alert("1 & 2")</script> | `a` *b* _c_'
VOID = {"meta", "img", "br", "link", "hr", "input"}


class Reader(HTMLParser):
    """Follows the open elements; keeps every id, link, image and text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str, attribute: str) -> Iterator[str]:
        return (attrs[attribute] or "" for name, attrs in self.seen if name == tag and attribute in attrs)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    folder = tmp_path_factory.mktemp("figures")
    svg, png = folder / "fig17_stub.svg", folder / "fig17_stub.png"
    svg.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    png.write_bytes(b"not looked at")
    judged = [judge(statement) for statement in statements("s5_2a_single_rotor")]
    corrected = Statement(
        "5.20",
        chain(sp.cos(r0), sp.Integer(1) + r0, small=r0, claimed=1),
        correction=chain(sp.cos(r0), sp.cos(r0)),
        depends_on=("5.06",),
        evidence=(HOSTILE,),
        steps=(HOSTILE,),
    )
    judged.append(replace(judge(corrected), reaches_result=True))
    picture = Picture("fig17_stub", "17", HOSTILE, HOSTILE, HOSTILE, svg, png, {HOSTILE: 1.25}, 0.5)
    return Report(tuple(judged), (picture,), (HOSTILE,), 1.5)


@pytest.fixture(scope="module")
def longer(report: Report) -> Report:
    """The same with a section past the paper."""
    beyond = replace(report.pictures[0], stem="t6_stub", key="t6", measured={})
    row = (HOSTILE, ("holds:", sp.Eq(r0, M**2)), FigureLink("t6"), FigureLink("t7"))
    table = Table("what holds", ("subject", "formula", "figure", "not drawn"), (row,), HOSTILE)
    return replace(report, pictures=(*report.pictures, beyond), past=(table,), theory=((HOSTILE, HOSTILE),))


def read(text: str) -> Reader:
    reader = Reader()
    reader.feed(text)
    reader.close()
    return reader


def test_page_is_well_formed_and_its_links_lead_somewhere(report: Report) -> None:
    reader = read(page(report))
    assert reader.open == []
    ids = [identifier for _, attrs in reader.seen if (identifier := attrs.get("id"))]
    assert len(ids) == len(set(ids))
    targets = set(reader.all("a", "href"))
    assert targets <= {f"#{identifier}" for identifier in ids}
    assert {f"#eq-{verdict.id}" for verdict in report.verdicts} <= targets


def test_page_is_escaped(report: Report) -> None:
    text = page(report)
    assert "<script" not in text
    assert read(text).text.count(HOSTILE) == 6  # change, evidence, step, figure's title, caption, measured name


def test_page_needs_no_network(report: Report) -> None:
    text = page(report)
    assert not re.search(r"https?:|//[a-z]|@import|url\(", text)
    assert not {tag for tag, _ in read(text).seen} & {"script", "link", "iframe"}


def test_pictures_have_alternatives(report: Report) -> None:
    reader = read(page(report))
    assert list(reader.all("img", "alt")) == [HOSTILE]
    assert next(reader.all("img", "src")).startswith("data:image/svg+xml;base64,")


def test_large_pictures_go_in_as_png(report: Report) -> None:
    picture = report.pictures[0]
    small = picture.svg.read_text()
    picture.svg.write_text(small + " " * 200_000)
    text = page(report)
    picture.svg.write_text(small)
    assert next(read(text).all("img", "src")).startswith("data:image/png;base64,")


@pytest.mark.parametrize("write", [page, markdown])
def test_nothing_is_left_out(write: Callable[[Report], str], report: Report) -> None:
    text = write(report)
    for identifier in equations():
        assert identifier in text
    for verdict in report.verdicts:
        assert f'id="eq-{verdict.id}"' in text
    for part in ("sympy", "Python", "numpy", "scipy", "holds if", "refuted", "judged by the same rules: holds"):
        assert part in text
    assert "Reaches the result" in text
    assert "Used by" in text
    assert "agrees through order 0 in" in text


def test_page_shows_the_source_as_printed(report: Report) -> None:
    text = read(page(report)).text
    for verdict in report.verdicts:
        assert equation(verdict.id).latex in text


def test_markdown_tables_keep_their_columns(report: Report) -> None:
    columns = 0
    for line in markdown(report).splitlines():
        if line.startswith("| "):
            found = len(re.findall(r"(?<!\\)\|", line))
            assert columns in (0, found)
            columns = found
        else:
            columns = 0


def test_markdown_reads_no_text_as_markup(report: Report) -> None:
    text = markdown(report)
    assert r"\<script\>" in text
    assert "<script" not in text.replace(r"\<script", "")
    assert text.count("$$") % 2 == 0


def test_past_the_paper_is_a_section_of_its_own(report: Report, longer: Report) -> None:
    assert 'id="past"' not in page(report)
    assert "Past the paper" not in markdown(report)
    text = page(longer)
    reader = read(text)
    assert reader.open == []
    ids = {identifier for _, attrs in reader.seen if (identifier := attrs.get("id"))}
    assert set(reader.all("a", "href")) <= {f"#{identifier}" for identifier in ids}
    assert "#figure-t6" in set(reader.all("a", "href"))
    assert "#figure-t7" not in set(reader.all("a", "href"))
    assert text.index('id="figure-17"') < text.index('id="past"') < text.index('id="figure-t6"')
    assert "<msub><mi>r</mi><mn>0</mn></msub>" in text[text.index('id="past"') :]
    assert "<script" not in text
    written = markdown(longer)
    assert written.index("## Figures") < written.index("## Past the paper") < written.index("### Figure t6")
    assert "$r_0 = M^{2}$" in written
    assert "[figure t6](#figure-t6)" in written
    assert '<a id="figure-t6"></a>' in written


def test_not_yet_judged_are_listed(report: Report) -> None:
    assert {entry.id for entry in report.waiting} == set(equations()) - {verdict.id for verdict in report.verdicts}


def test_rates_are_dotted_and_indices_low() -> None:
    dot = '<mo stretchy="false">˙</mo></mover>'
    assert f'<mover accent="true"><mi>φ</mi>{dot}' in mathml(ROTOR.v[1])
    assert f'<msub><mover accent="true"><mi>θ</mi>{dot}<mn>1</mn></msub>' in mathml(ANSATZ.v[0] + M)
    assert "¨" in mathml(ROTOR.a[0])
    assert f'<msub><mover accent="true"><mi>φ</mi>{dot}<mn>0</mn></msub>' in mathml(sp.Symbol("phi_0_dot"))
    assert "<msub><mi>r</mi><mn>0</mn></msub>" in mathml(r0, display=False)
    assert "<msub><mi>F</mi><mi>A x</mi></msub>" in mathml(sp.Symbol("F_A_x"))


def test_mathml_is_what_browsers_draw() -> None:
    theta = ROTOR.q[0]
    text = mathml(sp.Matrix([sp.sin(theta) ** 2 / M, sp.Ne(theta, 0, evaluate=False).lhs * M]))
    assert "mfenced" not in text
    assert "&amp;" not in text
    assert "<msup><mi>sin</mi><mn>2</mn></msup>" in text
    assert read(text).open == []
