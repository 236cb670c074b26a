"""Every page of the report and of the site, opened in Chromium: `make test-pages`.

Each is seen as on a desk and as on a phone, light, dark and on paper: no error of a script, no violation that axe finds
outside formulas (dark and on paper: of colours; dark also of what scrolls), no sideways scroll, no picture or formula that is
shown as its source, on a screen no letter of a formula (mi, mn, mtext) under 10 px, no buttons that overlap; links are read from
the files. A page is loaded twice, in light and in dark colours, and then only resized or put on paper. Where only colours are
others axe looks at a page that has an element, in one, of a kind that no page before it had. As many tabs as processors. Exit
status 1 where something is wrong.
"""

import asyncio
import os
import re
import shutil
import sys
import zlib
from collections import defaultdict
from collections.abc import Iterator
from functools import partial
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.parse import unquote, urljoin, urlsplit

import lagrotor

SMALLEST = 10  # px, of a formula's letters
DESK, PHONE = 1300, 390  # px
# What axe asks of a page at first, () for all; of dark colours and of paper only what they may change.
COLOURS = ("color-contrast", "link-in-text-block")
# Colours → the views of one load: width, medium, what axe asks of every page, and of one with a new kind of element.
Rules = tuple[str, ...] | None
LOADS: dict[str, tuple[tuple[int, str, Rules, Rules], ...]] = {
    "light": ((DESK, "screen", (), ()), (DESK, "print", None, COLOURS), (PHONE, "screen", None, None)),
    "dark": (
        (PHONE, "screen", ("scrollable-region-focusable",), ("scrollable-region-focusable", *COLOURS)),
        (DESK, "screen", None, None),
    ),
}
EXPORTS = ("report/whole.html", "whole.html")  # what the pages of the report have, as one file: axe looks at the pages
_SETTLED = (
    "() => document.fonts.ready.then(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50))))"
)
_MEASURE = """() => {
  const seen = (e) => e.getClientRects().length > 0 && e.checkVisibility({visibilityProperty: true});
  const box = (e) => e.getBoundingClientRect();
  const buttons = [...document.querySelectorAll("button")].filter(seen);
  const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
  const small = [...document.querySelectorAll("math :is(mi, mn, mtext)")]
    .filter((e) => e.textContent.trim() && parseFloat(getComputedStyle(e).fontSize) < SMALLEST && seen(e));
  return {
    over: document.documentElement.scrollWidth - innerWidth,
    small: [...new Set(small.map((e) => e.closest("math").textContent.slice(0, 60)))],
    overlapping: buttons.flatMap((a, i) => buttons.slice(i + 1).filter((b) => overlap(box(a), box(b))).map((b) =>
      a.textContent.trim() + " / " + b.textContent.trim())),
    kinds: [...new Set([...document.querySelectorAll("body *:not(math *, svg *)")].map((e) =>
      [e.parentElement, e].map((x) => x.tagName + "." + x.getAttribute("class")).join(" > ")))],
  };
}""".replace("SMALLEST", str(SMALLEST - 0.01))
# A formula is one thing: its letters have the colour of the text.
_AXE = """(rules) => axe.run({exclude: [["math"]]}, {resultTypes: ["violations"], ...(rules.length && {runOnly: rules})})
  .then((result) => result.violations.map((v) => v.id + ": " + v.help + ": " + v.nodes[0].html.slice(0, 120)))"""


class Quiet(SimpleHTTPRequestHandler):
    """Serves a folder without a line for each request."""

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing."""


class Places(HTMLParser):
    """What a page leads to, and the places on it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.targets: set[str] = set()
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Its addresses and its place, if it has any."""
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif name in ("href", "src") and value:
                self.targets.add(value)


def broken_links(folder: Path, names: list[str]) -> Iterator[str]:
    """Addresses within the folder that lead to no file or to no place, a line each."""
    root = "http://here/"
    read = {name: Places((folder / name).read_text(encoding="utf-8")) for name in names}
    for name, page in read.items():
        for target in sorted(urljoin(root + name, link) for link in page.targets):
            parts = urlsplit(target)
            file, place = unquote(parts.path).lstrip("/"), unquote(parts.fragment)
            file = f"{file}index.html" if file.endswith("/") or not file else file
            if target.startswith(root) and not folder.joinpath(file).exists():
                yield f"{folder.name}/{name}: leads to no file: {file}"
            elif target.startswith(root) and place and file in read and place not in read[file].places:
                yield f"{folder.name}/{name}: leads to no place: {file}#{place}"


def unshown_results(folder: Path, names: list[str]) -> Iterator[str]:
    """Pages on which a picture is the text of an object, or a formula its source, a line each."""
    for name in names:
        text = (folder / name).read_text(encoding="utf-8")
        for kind, signs in (("picture", r"&lt;Figure size [^<]*"), ("formula", r"(?<=<p>)\$\$[^<]{0,40}")):
            if sign := re.search(signs, text):
                yield f"{folder.name}/{name}: a {kind} is not shown: {sign[0]}"


async def faults_of_page(
    address: str, name: str, scheme: str, page: Any, axe: str, kinds: defaultdict[str, set[str]]
) -> list[str]:
    """What is wrong with one page in light or in dark colours, a line each. kinds: of elements that axe saw, by view."""
    found: list[str] = []
    where = f"{name}, {scheme}"
    page.on(
        "console", lambda message: found.append(f"{where}: script: {message.text}") if message.type == "error" else None
    )
    page.on("pageerror", lambda error: found.append(f"{where}: script: {error}"))
    for place, (width, medium, always, anew) in enumerate(LOADS[scheme]):
        await page.set_viewport_size({"width": width, "height": 900})
        await page.emulate_media(media=medium, color_scheme=scheme)
        if place == 0:
            await page.goto(address)
        await page.evaluate(_SETTLED)
        where = f"{name} at {width} px, {medium}, {scheme}"
        measured = await page.evaluate(_MEASURE)
        small = measured["small"] if medium == "screen" else []  # on paper a wide formula is as small as it must be
        found += [f"{where}: letters under {SMALLEST} px: {letter}" for letter in small]
        found += [f"{where}: buttons overlap: {pair}" for pair in measured["overlapping"]]
        if measured["over"] > 0 and medium == "screen":
            found.append(f"{where}: wider than the window by {measured['over']} px")
        rules = anew if set(measured["kinds"]) - kinds[f"{medium}, {scheme}"] else always
        if rules is not None and not name.endswith(EXPORTS):
            kinds[f"{medium}, {scheme}"] |= set(measured["kinds"])
            if place == 0:
                await page.evaluate(axe)
            found += [f"{where}: {violation}" for violation in await page.evaluate(_AXE, list(rules))]
    return found


async def open_pages(folder: Path, names: list[str], axe: str, chromium: str) -> int:
    """Open each page of a folder and print what is wrong with it; how many faults there are."""
    from playwright.async_api import async_playwright

    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    Thread(target=server.serve_forever, daemon=True).start()
    left, wrong, done = iter(names), 0, 0
    kinds: defaultdict[str, set[str]] = defaultdict(set)

    async def tab(browser: Any) -> None:
        nonlocal wrong, done
        contexts = {scheme: await browser.new_context(color_scheme=scheme) for scheme in LOADS}
        for name in left:
            for scheme, context in contexts.items():
                page = await context.new_page()
                address = f"http://127.0.0.1:{server.server_port}/{name}"
                found = await faults_of_page(address, f"{folder.name}/{name}", scheme, page, axe, kinds)
                await page.close()
                print(*found, sep="\n", end="\n" if found else "", flush=True)
                wrong += len(found)
            done += 1
            if done % 10 == 0 or done == len(names):
                print(f"{done} of {len(names)} pages", file=sys.stderr, flush=True)

    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        await asyncio.gather(*(tab(browser) for _ in range(os.cpu_count() or 1)))
        await browser.close()
    server.shutdown()
    return wrong


def without_reference(folder: Path) -> Iterator[str]:
    """Public classes' methods and properties that the built reference does not explain, a line each."""
    if not (folder / "objects.inv").is_file():
        return
    inventory = (folder / "objects.inv").read_bytes()
    explained = {
        line.split()[0] for line in zlib.decompress(inventory.split(b"\n", 4)[4]).decode().splitlines() if line
    }
    ends = {".".join(name.split(".")[-2:]) for name in explained}
    for part in sorted(path.parent.name for path in Path(lagrotor.__file__).parent.glob("*/__init__.py")):
        if part in ("drawing", "pictures"):
            continue
        module = import_module(f"lagrotor.{part}")
        for name in getattr(module, "__all__", ()):
            if isinstance(thing := getattr(module, name), type):
                own = {each for base in thing.__mro__ if base.__module__.startswith("lagrotor.") for each in vars(base)}
                documented = (
                    each for each in own if not each.startswith("_") and getattr(getattr(thing, each), "__doc__", None)
                )
                methods = (
                    each
                    for each in documented
                    if callable(getattr(thing, each)) or isinstance(getattr(thing, each), property)
                )
                yield from (f"the reference lacks {name}.{each}" for each in methods if f"{name}.{each}" not in ends)


def main(folders: list[str]) -> int:
    """Look at the pages of the folders; 0 where nothing is wrong."""
    import axe_core_python

    axe = next(Path(axe_core_python.__file__).parent.rglob("axe*.js")).read_text(encoding="utf-8")
    installed = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if installed is None:
        print("no chromium, chromium-browser or google-chrome is installed: install one to open the pages")
        return 2
    if missing := [folder for folder in folders if not (Path(folder) / "index.html").is_file()]:
        print(f"{missing[0]} has no index.html: make it first, `make docs`")
        return 2
    wrong = 0
    for folder in (Path(folder).resolve() for folder in folders):
        names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.html"))
        names = [name for name in names if not name.startswith("_static/")]  # templates of the theme, not pages
        broken = [*broken_links(folder, names), *without_reference(folder), *unshown_results(folder, names)]
        print(*broken, sep="\n", end="\n" if broken else "", flush=True)
        wrong += len(broken) + asyncio.run(open_pages(folder, names, axe, installed))
    print(f"{wrong} faults" if wrong else "no fault")
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or ["site"]))  # which holds the report
