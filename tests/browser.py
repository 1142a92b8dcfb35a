"""Chromium, driven by Playwright, for the tests of pages.

They run where Playwright and a Chromium (`chromium` on the path) are installed.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@contextmanager
def launched(*flags: str) -> Iterator[Any]:
    """A browser with these flags; skips the test where there is none."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no chromium on the path")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", *flags]
        )
        yield browser
        browser.close()


def complaints(page: Any) -> list[str]:
    """A list that fills with errors on the page's console and requests that fail."""
    loud: list[str] = []
    page.on("console", lambda m: loud.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: loud.append(str(error)))
    page.on("requestfailed", lambda request: loud.append(f"{request.url}: {request.failure}"))
    return loud
