"""Every page of the report and of the site, opened in Chromium: `make test-pages`.

Each is seen as on a desk and as on a phone, light, dark and on paper: no error of a script, no violation that axe finds, no
sideways scroll, no formula under 10 px, no buttons that overlap, no broken link. Exit status 1 where one fails.
"""

import shutil
import sys
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.parse import unquote, urljoin, urlsplit

WIDTHS = (1300, 390)  # px: a desk, a phone
VIEWS = (("screen", "light"), ("screen", "dark"), ("print", "light"))
SMALLEST = 10  # px, of a formula's letters
SCHEMES = (
    (1300, "screen", "light"),
    (390, "screen", "dark"),
    (1300, "print", "light"),
)  # that axe sees, each scheme once
EXPORTS = ("report/whole.html", "whole.html")  # what the pages of the report have, as one file: axe looks at the pages
_MEASURE = """() => {
  const seen = (e) => e.getClientRects().length > 0, box = (e) => e.getBoundingClientRect();
  const buttons = [...document.querySelectorAll("button")].filter(seen);
  const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
  return {
    over: document.documentElement.scrollWidth - innerWidth,
    small: [...document.querySelectorAll("math")].filter(seen).filter((m) => parseFloat(getComputedStyle(m).fontSize) < SMALLEST)
      .map((m) => m.textContent.slice(0, 40)),
    overlapping: buttons.flatMap((a, i) => buttons.slice(i + 1).filter((b) => overlap(box(a), box(b))).map((b) =>
      a.textContent.trim() + " / " + b.textContent.trim())),
    links: [...document.querySelectorAll("a[href]")].map((a) => a.href),
    ids: [...document.querySelectorAll("[id]")].map((e) => e.id),
  };
}""".replace("SMALLEST", str(SMALLEST))


class Quiet(SimpleHTTPRequestHandler):
    """Serves a folder without a line for each request."""

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing."""


def faults(folder: Path, axe: str, browser: Any) -> Iterator[str]:
    """What is wrong with the pages of a folder, a line each."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    Thread(target=server.serve_forever, daemon=True).start()
    root = f"http://127.0.0.1:{server.server_port}/"
    links: dict[str, set[str]] = {}
    places: dict[str, set[str]] = {}
    for width in WIDTHS:
        for medium, scheme in VIEWS if width == WIDTHS[0] else VIEWS[:2]:
            view = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme).new_page()
            view.emulate_media(media=medium, color_scheme=scheme)
            said: list[str] = []
            view.on(
                "console", lambda message, said=said: said.append(message.text) if message.type == "error" else None
            )
            view.on("pageerror", lambda error, said=said: said.append(str(error)))
            for name in sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.html")):
                said.clear()
                view.goto(root + name)
                view.wait_for_load_state("networkidle")
                measured = view.evaluate(_MEASURE)
                links[name], places[name] = set(measured["links"]), set(measured["ids"])
                where = f"{folder.name}/{name} at {width} px, {medium}, {scheme}"
                yield from (f"{where}: script: {line}" for line in said)
                yield from (f"{where}: formula under {SMALLEST} px: {formula}" for formula in measured["small"])
                yield from (f"{where}: buttons overlap: {pair}" for pair in measured["overlapping"])
                if measured["over"] > 0 and medium == "screen":
                    yield f"{where}: wider than the window by {measured['over']} px"
                if name in EXPORTS or (width, medium, scheme) not in SCHEMES:
                    continue
                if (name, medium) == ("404.html", "print"):  # on paper the theme leaves nothing of it to be reached
                    continue
                view.evaluate(axe)
                for violation in view.evaluate("() => axe.run()")["violations"]:
                    yield f"{where}: {violation['id']}: {violation['help']}: {violation['nodes'][0]['html'][:120]}"
            view.context.close()
    server.shutdown()
    for name, targets in links.items():
        for target in sorted(urljoin(root + name, link) for link in targets):
            parts = urlsplit(target)
            file, place = unquote(parts.path).lstrip("/") or "index.html", unquote(parts.fragment)
            if target.startswith(root) and not folder.joinpath(file).exists():
                yield f"{folder.name}/{name}: leads to no file: {file}"
            elif target.startswith(root) and place and place not in places.get(file, {place}):
                yield f"{folder.name}/{name}: leads to no place: {file}#{place}"


def main(folders: list[str]) -> int:
    """Look at the pages of the folders; 0 where nothing is wrong."""
    import axe_core_python
    from playwright.sync_api import sync_playwright

    axe = next(Path(axe_core_python.__file__).parent.rglob("axe*.js")).read_text(encoding="utf-8")
    installed = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if installed is None:
        print("no chromium, chromium-browser or google-chrome is installed: install one to open the pages")
        return 2
    if missing := [folder for folder in folders if not (Path(folder) / "index.html").is_file()]:
        print(f"{missing[0]} has no index.html: make it first, `make docs`")
        return 2
    wrong = 0
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=installed, args=["--no-sandbox", "--disable-gpu"])
        for folder in folders:
            for fault in faults(Path(folder).resolve(), axe, browser):
                print(fault, flush=True)
                wrong += 1
        browser.close()
    print(f"{wrong} faults" if wrong else "no fault")
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or ["site"]))  # which holds the report
