"""A page in Chromium without a screen: the mark of the tests that need it, and the page's elements after its scripts have run."""

import shutil
import subprocess
from pathlib import Path

import pytest

_BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_browser = pytest.mark.skipif(
    _BROWSER is None, reason="no chromium, chromium-browser or google-chrome is installed"
)


def dom_of(html: str, folder: Path, *options: str) -> str:
    """Return a page as HTML after its scripts have run. `folder` gets the page and the browser's profile."""
    page = folder / "page.html"
    page.write_text(html, encoding="utf-8")
    command = [
        str(_BROWSER),
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={folder / 'profile'}",
    ]
    command += [*options, "--dump-dom", page.as_uri()]
    return subprocess.run(command, capture_output=True, encoding="utf-8", timeout=120, check=False).stdout
