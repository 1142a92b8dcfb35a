"""The site of the documentation: it builds, and in a browser it shows what its sources say."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.parse import unquote, urldefrag

import pytest

import decomp
from tests import browser as browsers
from tests.markdown import Said, said

ROOT = Path(__file__).parent.parent.parent
DOCS = ROOT / "docs"
SOURCES = sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))
WIDTHS = {"desktop": 1280, "phone": 400}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for package in ("mkdocs", "material", "mkdocstrings"):
        pytest.importorskip(package)
    place = tmp_path_factory.mktemp("docs") / "site"
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(place)]
    run = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return place


def page_of(source: str) -> str:
    """The page that is made of a source."""
    return source.replace("README.md", "index.md").removesuffix(".md") + ".html"


def test_all_that_is_public_is_told_of(site: Path) -> None:
    assert "decomp mesh" in (site / "commands.html").read_text()
    python = (site / "api.html").read_text()
    for name in decomp.__all__:
        assert f'id="decomp.{name}"' in python, name


@pytest.mark.parametrize("source", SOURCES)
def test_no_fence_is_left_as_text(site: Path, source: str) -> None:
    assert "```" not in (site / page_of(source)).read_text()


class Quiet(SimpleHTTPRequestHandler):
    """A server that says nothing."""

    def log_message(self, *args: object) -> None:
        """Leave out the line for each request."""


@pytest.fixture(scope="module")
def address(site: Path) -> Iterator[str]:
    """Where the site is served."""
    with ThreadingHTTPServer(("localhost", 0), partial(Quiet, directory=site)) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://localhost:{server.server_port}/"
        server.shutdown()


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    # every name but the server's is unknown: what needs the network fails
    with browsers.launched("--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost") as chromium:
        yield chromium


def opened(where: Any, address: str, width: int = WIDTHS["desktop"]) -> tuple[Any, list[str]]:
    """A page of a width in a browser or context, and what it complains of."""
    page = where.new_page()
    page.set_viewport_size({"width": width, "height": 900})
    loud = browsers.complaints(page)
    page.goto(address, wait_until="networkidle")
    return page, loud


SHOWN = """() => {
    const within = document.querySelector("article");
    const texts = (what, without = "") => [...within.querySelectorAll(what)].map(element => {
        const copy = element.cloneNode(true);
        if (without) copy.querySelectorAll(without).forEach(part => part.remove());
        return copy.textContent;
    });
    return {
        headings: texts("h1, h2, h3, h4, h5, h6", ".headerlink"),
        cells: texts("th, td"),
        items: texts("li").length,
        codes: texts("pre > code"),
        titles: texts(".filename"),
        pictures: [...within.querySelectorAll("img")].map(
            picture => [picture.alt, picture.complete && picture.naturalWidth > 0]),
    };
}"""


def assert_shows(shown: dict[str, Any], source: Said, reference: bool) -> None:
    """A page has all of its source, in its order; references have more beside it."""
    if reference:
        rest = iter(shown["headings"])
        assert all(heading in rest for heading in source.headings)
        assert shown["codes"][: len(source.codes)] == source.codes
        return
    assert shown["headings"] == source.headings
    assert [" ".join(cell.split()) for cell in shown["cells"]] == source.cells
    assert shown["items"] == source.items
    assert shown["codes"] == source.codes
    assert shown["titles"] == source.titles
    assert shown["pictures"] == [[told, True] for told in source.pictures]


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES)
def test_pages_show_their_sources(
    source: str, site: Path, address: str, chromium: Any, tmp_path: Path
) -> None:
    for name, width in WIDTHS.items():
        page, loud = opened(chromium, address + page_of(source), width)
        page.screenshot(path=tmp_path / f"{name}.png", full_page=True)
        assert "```" not in page.inner_text("body")
        assert_shows(page.evaluate(SHOWN), said(DOCS / source), reference=source == "api.md")
        # what is too wide scrolls by itself, not the whole page
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert loud == []
        page.close()


@pytest.mark.slow
def test_links_lead_somewhere(site: Path, address: str, chromium: Any) -> None:
    names, links = {}, set()
    for source in SOURCES:
        page, _ = opened(chromium, address + page_of(source))
        names[page_of(source)] = set(
            page.evaluate("[...document.querySelectorAll('[id]')].map(e => e.id)")
        )
        links |= set(page.evaluate("[...document.querySelectorAll('a[href]')].map(a => a.href)"))
        page.close()
    own = {link.removeprefix(address) for link in links if link.startswith(address)}
    assert len(own) > 3 * len(SOURCES)
    for link in sorted(own):
        target, fragment = map(unquote, urldefrag(link))
        target = target or "index.html"
        assert (site / target).is_file(), link
        assert not fragment or fragment in names[target], link


def test_the_search_finds(address: str, chromium: Any) -> None:
    page, loud = opened(chromium, address + "index.html")
    page.click("[data-md-component=search-query]")
    page.keyboard.type("calculix")
    page.wait_for_selector(".md-search-result__link[href*='solvers.html']")
    assert loud == []
    page.close()


def test_copies_of_transcripts_are_commands(address: str, chromium: Any) -> None:
    context = chromium.new_context(permissions=["clipboard-read", "clipboard-write"])
    page, loud = opened(context, address + "tutorial.html")
    first = page.locator(".language-console").first
    first.hover()
    first.locator("button").click()
    page.wait_for_selector(".md-dialog--active")
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied.strip() == "decomp info meshes/blind_hole.geo"
    assert loud == []
    context.close()


def test_pages_can_be_read_without_a_server(site: Path, chromium: Any) -> None:
    page, _ = opened(chromium, (site / "index.html").as_uri())
    page.click("article a[href='tutorial.html']")
    page.wait_for_url("**/tutorial.html")
    assert page.evaluate(SHOWN)["headings"] == said(DOCS / "tutorial.md").headings
    page.close()
