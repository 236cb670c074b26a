"""The report as HTML and Markdown: complete, escaped, alone in the world, and readable without seeing."""

import json
import posixpath
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from html import escape
from html.parser import HTMLParser
from pathlib import Path

import pytest

from lagrotor.paper import (
    Audit,
    Remark,
)
from lagrotor.paper.rotor_pair.rotor_pair_audit import PAPER
from lagrotor.report.content import Report, ResultSection, contents
from lagrotor.report.job.folder import CONTENTS
from lagrotor.report.page.html_elements import prose
from lagrotor.report.page.pages import pages, whole_page
from lagrotor.report.page.sections import sections
from lagrotor.report.text_forms import markdown
from tests.report.hostile import long_report, short_report

HOSTILE = '<script>alert("1 & 2")</script> | `a` *b* _c_'
VOID = {"meta", "img", "br", "link", "hr", "input"}


class Reader(HTMLParser):
    """Follows the open elements; keeps every id, link, image and text, headings by their rank."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.crossed: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.crossed.append(tag)

    def handle_data(self, data: str) -> None:
        self.text += data

    def all(self, tag: str, attribute: str) -> Iterator[str]:
        return (attrs[attribute] or "" for name, attrs in self.seen if name == tag and attribute in attrs)

    @property
    def ids(self) -> list[str]:
        return [identifier for _, attrs in self.seen if (identifier := attrs.get("id"))]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Report:
    return short_report(HOSTILE, tmp_path_factory.mktemp("short"))


@pytest.fixture(scope="module")
def longer(report: Report) -> Report:
    return long_report(report, HOSTILE)


def read(text: str) -> Reader:
    reader = Reader()
    reader.feed(text)
    reader.close()
    return reader


def leads(link: str, reader: Reader) -> bool:
    """To a place of the page, or to a file that lies beside it."""
    return link in CONTENTS or (link[:1] == "#" and link[1:] in reader.ids)


def faults(text: str) -> list[str]:
    """What a reader, a screen reader or a keyboard would stumble over."""
    reader = read(text)
    found = [f"left open: {tag}" for tag in (*reader.open, *reader.crossed)]
    found += [f"id twice: {i}" for i in set(reader.ids) if reader.ids.count(i) > 1]
    found += [f"leads nowhere: {link}" for link in reader.all("a", "href") if not leads(link, reader)]
    named = [attrs for _, attrs in reader.seen if "aria-labelledby" in attrs or "for" in attrs]
    found += [f"no such name: {i}" for a in named if (i := a.get("aria-labelledby") or a.get("for")) not in reader.ids]
    ranks = [int(tag[1]) for tag, _ in reader.seen if re.fullmatch("h[1-6]", tag)]
    found += [f"h{b} after h{a}" for a, b in zip([0, *ranks], ranks, strict=False) if b > a + 1]
    found += ["not one h1"] * (ranks.count(1) != 1)
    found += ["picture without alternative"] * sum(t == "img" and not a.get("alt") for t, a in reader.seen)
    found += ["th without scope"] * sum(t == "th" and not a.get("scope") for t, a in reader.seen)
    tags = [tag for tag, _ in reader.seen]
    found += [f"not one {tag}" for tag in ("main", "header", "nav", "footer") if tags.count(tag) != 1]
    found += ["no language"] * (("html", {"lang": "en"}) not in reader.seen)
    return found


def reached(text: str) -> list[str]:
    """What the page would fetch from elsewhere."""
    addresses = [
        (attrs[name] or "")
        for _, attrs in read(text).seen
        for name in ("src", "href", "srcset", "poster", "action", "data")
        if name in attrs
    ]
    found = [address for address in addresses if not address.startswith(("#", "data:")) and address not in CONTENTS]
    alone = re.sub(r"([\"(])data:[^\")]*", r"\1data:", text)
    return found + re.findall(r"https?:|url\((?!data:)|@import|\bfetch\(|XMLHttpRequest|\bimport\b[ (]", alone)


def test_page_has_no_faults(longer: Report) -> None:
    text = whole_page(longer)
    assert faults(text) == []
    assert {f"#eq-{verdict.id}" for verdict in longer.verdicts} <= set(read(text).all("a", "href"))


@pytest.mark.parametrize(
    ("whole", "broken", "says"),
    [
        ('id="eq-5.02"', 'id="eq-5.2"', "leads nowhere: #eq-5.02"),
        ('id="eq-5.02"', 'id="eq-5.01"', "id twice: eq-5.01"),
        ("</article>", "", "left open"),
        ("<h2", "<h4", "h4 after h1"),
        ("<h1", "<h2", "not one h1"),
        ("alt=", "title=", "picture without alternative"),
        ('scope="row"', "", "th without scope"),
        ('lang="en"', "", "no language"),
        ("<main", '<main id="second"></main><main', "not one main"),
    ],
)
def test_faults_are_seen(whole: str, broken: str, says: str, longer: Report) -> None:
    text = whole_page(longer)
    assert whole in text
    assert any(fault.startswith(says) for fault in faults(text.replace(whole, broken, 1)))


def scattered(files: dict[str, str]) -> list[str]:
    """What a reader of the pages would stumble over: faults within each, links and images that lead nowhere, what is left out."""
    readers = {name: read(text) for name, text in files.items() if name.endswith(".html")}
    result = []
    for name, reader in readers.items():
        result += [f"{name}: {fault}" for fault in faults(files[name]) if not fault.startswith("leads nowhere")]
        for link in (*reader.all("a", "href"), *reader.all("link", "href"), *reader.all("script", "src")):
            target, _, place = link.partition("#")
            file = posixpath.normpath(posixpath.join(posixpath.dirname(name), target)) if target else name
            there = place in readers[file].ids if place and file in readers else file in files or file in CONTENTS
            there |= link == "data:,"  # of no icon
            result += [f"{name}: leads nowhere: {link}"] * (not there)
        for image in reader.all("img", "src"):
            up = "../" * name.count("/")
            result += [f"{name}: no such image: {image}"] * (image != f"{up}figures/fig17_stub.svg")
    return result


def test_pages_lead_to_each_other(longer: Report) -> None:
    files = pages(longer)
    assert scattered(files) == []
    assert 'href="pages/section-5.2.html#eq-5.02"' in files["index.html"]
    assert 'href="section-5.2.html#eq-5.20"' in files["pages/claims.html"]
    assert 'href="derivation-s5_2a_single_rotor.html#derivation-s5_2a_single_rotor"' in files["pages/section-5.2.html"]
    assert 'id="figure-17"' in files["pages/section-5.2.html"], "a figure of the paper stands in its section"
    assert 'src="../figures/fig17_stub.svg"' in files["pages/section-5.2.html"]
    every = "".join(files.values())
    for section in sections(longer):
        assert section.anchor in ("derivations", "figures") or f'id="{section.anchor}"' in every


def test_the_words_of_every_entry_can_be_found(longer: Report) -> None:
    rows = json.loads(pages(longer)["pages/words.js"].removeprefix("const WORDS = ").rstrip(";\n"))
    found = {anchor: (address, name, answer, text) for address, anchor, name, answer, text in rows}
    assert {f"eq-{verdict.id}" for verdict in longer.verdicts} <= found.keys()
    assert {f"figure-{picture.key}" for picture in longer.pictures} | {"claim-C16", "notation"} <= found.keys()
    address, name, answer, text = found["eq-5.20"]
    assert address == "pages/section-5.2.html#eq-5.20"
    assert (name, answer) == ("5.20 amplitude-based correction", "refuted") and HOSTILE in text
    assert found["erratum-5.20"][1] == "Erratum 5.20 amplitude-based correction"
    assert found["claim-C16"][2] == "confirmed-if"
    texts = " ".join(row[4] for row in rows)
    assert "const ORDER" not in texts and "frac" not in texts, "neither a program's text nor LaTeX is searched"
    whole = [row[1:] for row in json.loads(re.findall(r"const WORDS = (.*);", whole_page(longer))[0])]
    assert {anchor for anchor, *_ in whole} >= {f"eq-{verdict.id}" for verdict in longer.verdicts}
    assert ["eq-5.20", name, answer] in whole, "its page has the words themselves"


def test_a_verdict_is_separated_from_its_title_in_plain_text(longer: Report) -> None:
    text = read(whole_page(longer)).text.partition("const WORDS")[0]
    for verdict in longer.verdicts:
        title = read(prose(PAPER.equation(verdict.id).title)).text
        title = f"{verdict.id} {title}, {verdict.verdict.replace('-', ' ')}"
        assert text.count(title) == 2, title  # the overview of the section and the entry


def test_every_entry_can_be_folded_and_is_open_without_the_script(longer: Report) -> None:
    text = whole_page(longer)
    articles = re.findall(r"<article [^>]*>(?=<(\w+)(?: class=\"entry\" (open))?)", text)
    assert len(articles) > 10 and set(articles) == {("details", "open")}
    folded = re.findall(r'<section [^>]*><details class="entry" open><summary><h2 id="([^"]+)"', text)
    assert {"errata", "verdicts", "section-5.2", "claims"} <= set(folded) and "summary" not in folded
    assert '<section aria-labelledby="section-5.2"><h2' in pages(longer)["pages/section-5.2.html"], "alone on its page"


def test_page_is_escaped(report: Report) -> None:
    text = whole_page(report)
    assert text.count("<script") == 1, "the page's own"
    assert read(text).text.count(HOSTILE) == 5  # change, evidence, derivation, figure's title, caption
    assert read(text).text.count(HOSTILE.replace("_", " ")) == 1  # measured name


def test_page_needs_no_network(longer: Report) -> None:
    text = whole_page(longer)
    assert reached(text) == []
    for fetched in ('<img src="figures/a.png" alt="">', "<style>@import 'a.css'</style>", "<style>a{b:url(c)}</style>"):
        assert reached(text.replace("</main>", f"{fetched}</main>"))


@pytest.mark.parametrize("write", [whole_page, markdown])
def test_nothing_is_left_out(write: Callable[[Report], str], report: Report) -> None:
    text = write(report)
    for identifier in PAPER.equations:
        assert identifier in text
    for verdict in report.verdicts:
        assert f'id="eq-{verdict.id}"' in text
    for part in ("sympy", "Python", "holds if", "refuted", "by the same procedure, is: holds", "0a", "version = {"):
        assert part in text
    assert "Effect on results" in text
    assert "Used by" in text
    assert "agree through order 0 in" in text


@pytest.mark.parametrize("write", [whole_page, markdown])
def test_what_belongs_together_is_linked(write: Callable[[Report], str], longer: Report) -> None:
    text = write(longer)
    assert {"5.19", "5.20"} == set(PAPER.claims["C16"].equations)
    assert "5.20" in PAPER.figures[19].equations
    entry = text[text.index('id="eq-5.20"') : text.index('id="claim-C16"')]
    claim = text[text.index('id="claim-C16"') : text.index('id="findings"')]
    figure = text[text.index('id="figure-19"') :]
    assert "#claim-C16" in entry and "#figure-19" in entry
    assert "#eq-5.20" in claim and "#eq-5.19" not in claim, "5.19 is not in this report"
    assert "#eq-5.20" in figure


def test_markdown_reads_no_text_as_markup(longer: Report) -> None:
    text = markdown(longer)
    assert r"\<script\>" in text
    assert "<script" not in text.replace(r"\<script", "")
    assert text.count("$$") % 2 == 0


def test_markdown_links_lead_somewhere(longer: Report) -> None:
    text = markdown(longer)
    places = set(re.findall(r'<a id="([^"]+)"></a>', text))
    assert {name for name, _ in contents(longer)} <= places
    drawn = {f"figure-{picture.key}" for picture in longer.pictures}
    judged = {f"eq-{verdict.id}" for verdict in longer.verdicts} | drawn | {"figure-t7"}
    for link in re.findall(r"\]\(#([^)]+)\)", text):
        assert link in places or link == "figure-t7", link
    assert judged - {"figure-t7"} <= places
    beside = {file.partition("#")[0] for file in re.findall(r"(?<!!)\[[^\]]*\]\(([^#)][^)]*)\)", text)}
    assert {"errata.md", "verdicts.json", "claims.json", "measured.json"} <= beside <= CONTENTS | pages(longer).keys()


SEARCHED = """
const entries = ENTRIES.map(([id, name, text]) => ({ id, name, text: `${name} ${text}` }));
const found = (query) => search(query, entries).found.map((entry) => entry.id).join(" ");
const pieces = marked("A long text about the orbit of a Precession with spin 5.1.", ["orbit", "precession", "5.1"], 30, true);
console.log(JSON.stringify([QUERIES.map(found), search("trajectorise", entries).changed, pieces]));
"""
ENTRIES = [
    ("erratum-5.1", "Erratum 5.1", "bar"),
    ("5.10", "5.10", "the bar's length"),
    ("5.1", "5.1", "bar, trajectories"),
    ("c08", "C08", "Energy by 5.10, in 15.1 s"),
    ("figure-1", "Figure 1 pair", "border"),
    ("figure-19", "Figure 19 Trajectories", ""),
    ("figure-t6", "Figure t6", "drift"),
]
QUERIES = {
    "5.1": "5.1 erratum-5.1 5.10 c08",
    "eq. 5.10": "5.10 c08",
    "C8": "c08",
    "claim 8": "c08",
    "fig 19": "figure-19",
    "Figure 1": "figure-1 figure-19",
    "fig. t6": "figure-t6",
    "bar length": "5.10",
    "5.10 energy": "c08",
    "trajectories": "figure-19 5.1",
    "trajectorise": "figure-19 5.1",
    "trajectries": "figure-19 5.1",
    "trajectoris": "figure-19 5.1",
    "tragectories": "figure-19 5.1",
    "tragectores": "",
    "enery energy": "c08",
    "order": "figure-1",
    "dirft": "figure-t6",
    "bra": "",
    "none": "",
    "  ": "",
}


def test_search() -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    script = Path(whole_page.__code__.co_filename).with_name("page.js").read_text(encoding="utf-8")
    asked = SEARCHED.replace("ENTRIES", json.dumps(ENTRIES)).replace("QUERIES", json.dumps(list(QUERIES)))
    done = subprocess.run([node, "-e", script + asked], capture_output=True, text=True, check=True)
    found, changed, pieces = json.loads(done.stdout)
    assert dict(zip(QUERIES, found, strict=True)) == QUERIES
    assert changed == [["trajectorise", ["trajectories"]]]
    assert pieces == ["… the ", "orbit", " of a ", "Precession", " with …"]


def test_no_formula_of_the_page_is_typed_in_ascii(audit: Audit, typed_formulas: Callable[[str], list[str]]) -> None:
    """Equations with all that is said of them, claims, premises, letters, titles; what comes from runs is in `test_reproduce`."""
    stems = PAPER.stating_scripts
    found = [r for stem in stems for r in PAPER.scripts.executed("derivations", stem).values_of(Remark)]
    remarks = ResultSection("findings", "Findings", remarks=tuple((r.title, r.text) for r in found))
    assert typed_formulas(whole_page(Report(PAPER, tuple(audit), (), (), (), (remarks,)))) == []


@pytest.mark.parametrize(
    "text",
    ["r_0 = 0.2", "a**2", "1e-9 m", "about $x$", r"the \phi of it", "Omega_0", "ell = R", "-11 N", "x^2", "k >= 1"],
)
def test_a_formula_typed_in_ascii_is_found(text: str, typed_formulas: Callable[[str], list[str]]) -> None:
    assert typed_formulas(f"<p>{escape(text)}</p>") == [text]
    assert typed_formulas(f"<p>so</p><code>{escape(text)}</code><math>{escape(text)}</math>") == []
