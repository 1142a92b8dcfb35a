"""The pages of the documentation, executed block by block in the order in which they stand.

Blocks are told by what follows their opening fence, a language and perhaps `title="NAME"`:

- with a title, but for `py`: a file of that name;
- `console`: commands after `$ `, with what they print, in which `...` stands for anything;
- `sh`: commands; those of `decomp` are run, others (`pip install`...) must be known;
- `python`: run, all of a page in one namespace; what `print(...)  # ...` prints is in its comment;
- `py`, `bash`: not executed here, as what they need may be missing; the page says so;
- `text` without a title: nothing that could be executed.
"""

from __future__ import annotations

import io
import re
import shlex
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from markdown_it import MarkdownIt

from decomp.cli.main import main

ROOT = Path(__file__).parent.parent
FENCE = re.compile(r"(\w+)(?: title=\"([^\"]+)\")?")
LANGUAGES = ("console", "sh", "python", "py", "bash", "text")
COMPILING = re.compile(r"decomp: compiling kernels .*\n")
"""What a first command says, and no later one."""
NOT_RUN = ("pip install", "python3 -m venv", ". .venv/bin/activate")


def blocks(page: str) -> Iterator[tuple[str, str, str]]:
    """Language, title (empty for none) and text of each block."""
    for token in MarkdownIt().parse((ROOT / page).read_text(encoding="utf-8")):
        if token.type == "fence":
            fence = FENCE.fullmatch(token.info)
            known = fence is not None and (fence[2] or fence[1] in LANGUAGES)
            assert fence and known, f"{page}: a fence with {token.info!r}; see tests/pages.py"
            transcript = token.content.startswith("$ ")
            assert transcript == (fence[1] == "console"), f"{page}: `$ ` makes a `console` block"
            yield fence[1], fence[2] or "", token.content


def run(page: str, place: Path) -> int:
    """Execute a page in a directory, which is the current one; how many blocks were run."""
    names: dict[str, Any] = {"__name__": "page"}
    count = 0
    for language, name, text in blocks(page):
        if name and language != "py":
            (place / name).write_text(text)
        elif language == "console":
            _transcript(text)
        elif language == "sh":
            for line in text.splitlines():
                _command(line)
        elif language == "python":
            _python(page, text, names)
        else:
            continue
        count += 1
    return count


def _command(line: str) -> None:
    words = shlex.split(line, comments=True)
    if words[:1] == ["decomp"]:
        words = [name for word in words for name in _files(word)]
        assert main(words[1:]) == 0, line
    else:
        assert line.startswith(NOT_RUN), line


def _files(word: str) -> list[str]:
    """The names of the files that a word is a pattern of, as a shell has them; else the word."""
    return sorted(map(str, Path().glob(word))) or [word] if "*" in word else [word]


def _transcript(text: str) -> None:
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        line, _, promised = part.partition("\n")
        said = io.StringIO()
        with redirect_stdout(said), redirect_stderr(said):
            main(shlex.split(line)[1:])
        found = COMPILING.sub("", said.getvalue())
        pattern = re.escape(promised).replace(re.escape("...\n"), r"(?s:.*)")
        assert re.fullmatch(pattern.replace(r"\.\.\.", ".*"), found), found


def _python(page: str, text: str, names: dict[str, Any]) -> None:
    printed: list[str] = []
    names["print"] = lambda *what: printed.append(" ".join(map(str, what)))  # libraries print too
    exec(compile(text, page, "exec"), names)
    promised = re.findall(r"^ *print\(.*\)  +# (.*)$", text, flags=re.MULTILINE)
    assert len(promised) == len(re.findall(r"\bprint\(", text)), "a print without its comment"
    assert printed == promised
