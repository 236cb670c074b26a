"""The report as pages (a front page, one page per section of the paper and per derivation), and as one self-contained file.

Both consist of the same sections. A section links to an anchor such as `#eq-5.07`, or to a file of the report's folder. In
the pages the address of the anchor's page is put before it; in the single file the figures are embedded.
"""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape, unescape
from pathlib import Path
from posixpath import dirname, relpath

from lagrotor.paper.plain_text import readable
from lagrotor.report.content import SUBTITLE, Report, ResultSection
from lagrotor.report.formulas.font import font_face
from lagrotor.report.page.html_elements import data_address, prose, side_by_side
from lagrotor.report.page.sections import Section, derivation_figures, introduction, picture_entry, sections

_HERE = Path(__file__).parent
# Hidden until the script, which performs the search, shows it.
_SEARCH = (
    '<form id="search" role="search" hidden><label for="query">Find</label>'
    '<input id="query" type="search" autocomplete="off" placeholder="{}, a word, a number">'
    '<p id="found" role="status"></p><ul id="hits"></ul></form>'
)
# Sections that share a page; each section of the paper has its own.
_FRONT = ("model", "summary", "verdicts")
_ABOUT = ("notation", "waiting", "cite", "made")
FOLDER = "pages"
_CURRENT = ' aria-current="page"'
_PLACE = re.compile(r'\bid="([^"]+)"')
_ADDRESS = re.compile(r'\b(href|src)="([^"]+)"')
_ENTRY = re.compile(r'<(article|details)(?: class="derivation")? id="([^"]+)">(.*?)</\1>', re.DOTALL)
_SUMMARY = re.compile(r"<summary>(.*?)</summary>", re.DOTALL)
_BADGE = re.compile(r'(?:<span class="unseen">,</span> )?<span class="badge ([a-z-]+)">[^<]*</span>')
_TAG = re.compile(r"<[^>]+>")
# Programs, sources, displayed formulas, headings and lists of links, which the search neither reads nor shows.
_UNREAD = re.compile(
    r"<(script|style|pre|h4|summary)\b.*?</\1>|<math display=.*?</math>|<p><a [^>]*>The derivation</a>.*?</p>"
    r'|<ul class="overview">.*?</ul>',
    re.DOTALL,
)


@dataclass(frozen=True)
class Page:
    """One HTML file: its address, its name in the table of contents, its sections. listed: False if the contents omit it."""

    file: str
    name: str
    sections: tuple[Section, ...]
    listed: bool = True

    @property
    def body(self) -> str:
        """The HTML of all sections of the page, joined; several sections can be folded."""
        return _joined(self.sections)


def _joined(listed: tuple[Section, ...]) -> str:
    return "\n".join(section.folded if len(listed) > 1 else section.html for section in listed)


def whole_page(report: Report) -> str:
    """Return the whole report as one HTML page that contains its style, script, font, formulas and figures."""
    return _whole_page(report, sections(report))


def _whole_page(report: Report, everything: list[Section]) -> str:
    body = _joined(tuple(everything))
    for picture in report.pictures:
        body = body.replace(f'src="figures/{picture.svg.name}"', f'src="{data_address(picture)}"')
    contents = [(f"#{section.anchor}", section.heading) for section in everything]
    words = _data([row[:4] for row in _words(("", section) for section in everything)])  # the page has the texts
    return _document(report, body, contents, f"<style>\n{_style()}</style>", f"<script>\n{words}{_script()}</script>")


def html_files(report: Report) -> dict[str, str]:
    """Return a map from the address of each file to its text: those of `pages`, and the whole report as one page."""
    everything = sections(report)
    return _page_files(report, everything) | {"whole.html": _whole_page(report, everything)}


def pages(report: Report) -> dict[str, str]:
    """Return a map from the address of each file to its text: the pages, their style and script, the words to search."""
    return _page_files(report, sections(report))


def _page_files(report: Report, everything: list[Section]) -> dict[str, str]:
    all_pages = _pages(report, everything)
    places = {place: page.file for page in all_pages for place in _PLACE.findall(page.body)}
    words = _words((page.file, section) for page in all_pages for section in page.sections)
    assets = {"page.css": _style(), "page.js": _script(), "words.js": _data(words)}
    files = {f"{FOLDER}/{name}": text for name, text in assets.items()}
    return {page.file: _page(page, all_pages, places, report) for page in all_pages} | files


def _pages(report: Report, everything: list[Section]) -> list[Page]:
    """Return the pages in the order of the contents; figures and derivations are put into the sections they belong to."""
    remaining = {section.anchor: section for section in everything}
    figures = remaining.pop("figures", None)
    derivations = remaining.pop("derivations", None)
    if figures:
        remaining |= _figures(remaining, figures, report)
    if derivations:
        remaining |= _derivation_lists(remaining, report)
    front = [remaining.pop(anchor) for anchor in _FRONT if anchor in remaining]
    for entry in report.paper.about.part:
        if entry.front and entry.name in remaining:
            front.append(
                _in_short(report.result_section(entry.name), report) if entry.figures else remaining.pop(entry.name)
            )
    about = [remaining.pop(anchor) for anchor in _ABOUT if anchor in remaining]
    result = [Page("index.html", "In short", tuple(front))]
    result += [Page(f"{FOLDER}/{anchor}.html", section.heading, (section,)) for anchor, section in remaining.items()]
    name = "Notation, and how this was made" if report.paper.glossary else "How this was made"
    result.append(Page(f"{FOLDER}/about.html", name, tuple(about)))
    for stem, name, inside in report.derivations:
        introduction, heading, steps = inside.partition("<h3>")
        drawn = derivation_figures(stem, inside, report)
        alone = Section(f"derivation-{stem}", name, introduction + drawn + heading + steps)
        result.append(Page(f"{FOLDER}/{alone.anchor}.html", name, (alone,), listed=False))
    return result


def _in_short(section: ResultSection, report: Report) -> Section:
    """Return a section with the tables of another section and a link to that one, which also has the figures."""
    tables = "".join(side_by_side(table, report) for table in section.tables)
    return Section(
        f"{section.name}-in-short", section.heading, f'{tables}<p><a href="#{section.name}">More, with figures</a></p>'
    )


def _figures(remaining: Mapping[str, Section], figures: Section, report: Report) -> dict[str, Section]:
    """Return, by anchor, the sections with their figures appended; figures without a section are appended to `figures`."""
    of: dict[str, list[str]] = {}
    numbered = {str(number): entry.section for number, entry in report.paper.figures.items()}
    for picture in report.result_section("figures").pictures:
        section = numbered.get(picture.key, "")
        while section and f"section-{section}" not in remaining:
            section = section.rpartition(".")[0]
        of.setdefault(f"section-{section}" if section else "figures", []).append(picture_entry(picture, report))
    filled = {name: remaining.get(name, replace(figures, inside="")) for name in of}
    return {
        name: replace(filled[name], inside=filled[name].inside + "\n".join(entries)) for name, entries in of.items()
    }


def _derivation_lists(remaining: Mapping[str, Section], report: Report) -> dict[str, Section]:
    """Return, by anchor, the sections with links to their derivations appended; a new section has the other derivations."""
    of: dict[str, list[str]] = {}
    for stem, name, _ in report.derivations:
        owner = _owner(stem, report)
        link = f'<li><a href="#derivation-{stem}">{prose(name)}</a></li>'
        of.setdefault(owner if owner in remaining else "derivations", []).append(link)
    alone = Section("derivations", "Other derivations", "")
    lists = {name: f'<h3>Derivations</h3><ul class="derivations">{"".join(links)}</ul>' for name, links in of.items()}
    filled = {name: remaining.get(name, alone) for name in of}
    return {name: replace(filled[name], inside=filled[name].inside + html) for name, html in lists.items()}


def _owner(stem: str, report: Report) -> str:
    """Return the name of the section that shows the equations, tests or tables of a derivation; "" if none does."""
    about = report.paper.about
    for identifier, (stating, _) in report.paper.scripts.stating.items():
        if stating == stem:
            return f"section-{report.paper.equation(identifier).section}"
    if about.claims_in and stem.startswith(about.claims_in):
        return "claims"
    beginnings = [(name, entry.name) for entry in about.part for name in entry.tables + entry.remarks if name]
    return max(
        (candidate for candidate in beginnings if stem.startswith(candidate[0])),
        key=lambda candidate: len(candidate[0]),
        default=("", ""),
    )[1]


def _page(page: Page, all_pages: list[Page], places: Mapping[str, str], report: Report) -> str:
    """Return the HTML document of a page; its links and images are relative to its own address.

    places: anchor → address of the page that contains it.
    """
    folder = dirname(page.file) or "."

    def address(match: re.Match[str]) -> str:
        name, target = match.groups()
        file, mark, place = target.partition("#")
        file = file or places.get(place, page.file)
        if ":" in file or file == page.file:
            return match[0]
        return f'{name}="{relpath(file, folder)}{mark}{place}"'

    contents = [("#content" if entry is page else entry.file, entry.name) for entry in all_pages if entry.listed]
    style = f'<link rel="stylesheet" href="{FOLDER}/page.css">'
    words, up = relpath(f"{FOLDER}/words.js", folder), relpath(".", folder)
    script = f'<script src="{FOLDER}/page.js" data-words="{words}" data-up="{up}/"></script>'
    text = _document(report, page.body, contents, style, script, "" if page is all_pages[0] else page.name)
    return _ADDRESS.sub(address, text)


def _document(
    report: Report, body: str, contents: Iterable[tuple[str, str]], style: str, script: str, name: str = ""
) -> str:
    """Return a whole HTML document; `name` is "" for the front page, and the title of any other page links to it."""
    listed = "".join(
        f'<li><a href="{address}"{_CURRENT if address == "#content" else ""}>{prose(heading)}</a></li>'
        for address, heading in contents
    )
    title = f'<a href="index.html">{escape(report.title)}</a>' if name else escape(report.title)
    named = (report.paper.equations, report.paper.claims, [f"figure {n}" for n in report.paper.figures])
    search = _SEARCH.format(escape(", ".join(str(i) for ids in named for i in list(ids)[:1])))
    opening = "" if name else f"<p>{escape(SUBTITLE)}.</p>{introduction(report)}"
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta name="color-scheme" content="light dark">',
            '<link rel="icon" href="data:,">',
            f"<title>{escape(readable(name) + ': ' + report.title if name else report.title)}</title>",
            f"{style}</head>",
            '<body id="top"><a class="skip" href="#content">Skip to the content</a>',
            f"<header{' class=short' if name else ''}><h1>{title}</h1>{opening}{search}</header>",
            '<nav aria-label="Contents"><details id="contents"><summary>Contents</summary>'
            f"<ul>{listed}</ul></details></nav>",
            f'<main id="content">{body}</main>',
            '<footer><a class="to-top" href="#top">Back to top</a></footer>',
            f"{script}</body></html>\n",
        ]
    )


def _words(listed: Iterable[tuple[str, Section]]) -> list[tuple[str, str, str, str, str]]:
    """Return the rows of the search, (address, anchor, title, verdict, words), those of entries before those of sections.

    The pairs are the address of the page of a section, and the section. The verdict is "" for an entry without one.
    """
    entries, whole = [], []
    for file, section in listed:
        for _, anchor, inside in _ENTRY.findall(section.inside):
            summary = _SUMMARY.search(inside)
            heading = summary[1] if summary else anchor
            answer = _BADGE.search(heading)
            title = ("Erratum " if anchor.startswith("erratum-") else "") + _text(_BADGE.sub("", heading))
            entries.append((f"{file}#{anchor}", anchor, title, answer[1] if answer else "", _text(inside)))
        words = _text(_ENTRY.sub(" ", section.inside))
        whole.append((f"{file}#{section.anchor}", section.anchor, section.heading, "", words))
    return entries + whole


def _text(html: str) -> str:
    """Return the text of HTML without programs, sources, headings and displayed formulas."""
    html = re.sub(r"<math\b.*?</math>", lambda formula: _TAG.sub("", formula[0]), _UNREAD.sub(" ", html))
    html = re.sub(r"</?(?:sub|sup|b|span|small|code|a)\b[^>]*>", "", html.replace("</dt>", ": "))
    return " ".join(unescape(_TAG.sub(" ", html)).split())


def _data(rows: Sequence[tuple[str, ...]]) -> str:
    """Return the rows of the search as a script that any page can load, even if it is opened from a disk."""
    return f"const WORDS = {json.dumps(rows, ensure_ascii=False, separators=(',', ':'))};\n".replace("<", "\\u003c")


def _style() -> str:
    return f"{font_face()}\n{(_HERE / 'page.css').read_text(encoding='utf-8')}"


def _script() -> str:
    return (_HERE / "page.js").read_text(encoding="utf-8")
