"""The tutorials run as they are printed; the reference matches the code."""

import contextlib
import io
import re
import runpy
from pathlib import Path

import pytest

DOCS = Path(__file__).parent.parent / "docs"
BLOCK = re.compile(r"```(python|text)\n(.*?)```", re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", sorted(DOCS.glob("tutorials/*.md")), ids=lambda page: page.stem
)
def test_a_tutorial_prints_what_it_says(page: Path) -> None:
    names: dict[str, object] = {"__name__": "__tutorial__"}
    printed = ""
    for language, block in BLOCK.findall(page.read_text(encoding="utf-8")):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(block, str(page), "exec"), names)
            printed = output.getvalue()
        else:
            assert printed == block


def test_the_node_reference_is_up_to_date() -> None:
    generator = runpy.run_path(str(DOCS / "generate.py"))
    page = (DOCS / "reference" / "nodes.md").read_text(encoding="utf-8")
    assert page == generator["nodes_page"](), "run: python docs/generate.py"
