"""The reader's edition, opened in Chromium from disk without a network: `make test-reader`.

Each example of the two forms is answered, an edited print is refuted with a point, a premise that is dropped is missed.
"""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

MOST = 20_000_000  # bytes
PATIENCE = 240_000  # ms


def faults(folder: Path, page: Any) -> Iterator[str]:
    """What is wrong with the edition in a folder, a line each."""
    size = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    if size > MOST:
        yield f"it has {size} bytes"
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: said.append(request.url) if request.url.startswith("http") else None)
    page.goto((folder / "index.html").resolve().as_uri())
    page.wait_for_selector("#judge .go:not([disabled])", timeout=PATIENCE)
    for form in ("judge", "system"):
        for place in range(page.locator(f"#{form} select option").count()):
            page.select_option(f"#{form} select", str(place))
            answer = ask(page, form)
            if "refusal" in answer or "<math" not in answer:
                yield f"{form}, example {place}: {answer[:300]}"
    fields: dict[str, str] = {"equation": "sqrt(x**2) = x", "given": "x >= 0", "positive": "", "small": "", "order": ""}
    for change, expected in (
        ({}, ("holds-if", "≥")),
        ({"given": ""}, ("holds-if", "≥")),  # the branch is said, not assumed without a word
        ({"given": "x < 0"}, ("refuted",)),
        ({"equation": "sqrt(x**2) = 2*x"}, ("refuted", "Witness")),
        ({"equation": "\\sin 2x = 2\\sin x\\cos x", "given": ""}, ("holds",)),
        ({"equation": "sqrt(x**2) = x)"}, ("refusal",)),
        ({"equation": "open('x') = 1"}, ("refusal",)),
    ):
        for name, text in (fields | change).items():
            page.fill(f"#judge [name={name}]", text)
        answer = ask(page, "judge")
        if missing := [part for part in expected if part not in answer]:
            yield f"{fields | change}: {missing[0]} is not in {answer[:300]}"
    yield from (f"the page says: {line}" for line in said)


def ask(page: Any, form: str) -> str:
    """The answer of a form as it is filled in, as HTML."""
    page.click(f"#{form} .go")
    page.wait_for_selector(f"#{form} .go:not([disabled])", timeout=PATIENCE)
    return str(page.inner_html(f"#{form} .answer"))


def main(folder: Path) -> int:
    """Try the edition; 0 where nothing is wrong."""
    from playwright.sync_api import sync_playwright

    installed = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if installed is None or not (folder / "index.html").is_file():
        print(f"no Chromium is installed, or {folder} is not made: make reader")
        return 2
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=installed, args=["--no-sandbox", "--disable-gpu"])
        context = browser.new_context(offline=True)
        wrong = list(faults(folder, context.new_page()))
        browser.close()
    print("\n".join(wrong) or "no fault")
    return min(len(wrong), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "reader")))
