"""MkDocs hook: give the site the files that stand outside docs/.

Pages link to `../../examples/06_own_world.py` or `../CHANGELOG.md`, so that the links
work in a checkout and on any host of the repository. The site has pages of these files
and this hook changes the links.
"""

import ast
import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[2]
ROLE = re.compile(r":(?:attr|class|data|exc|func|meth|mod):<code>~?")
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")

# Files outside docs/ with the page that shows them.
TEXTS = {
    "CHANGELOG.md": "changelog.md",
    "CODE_OF_CONDUCT.md": "contributing/code_of_conduct.md",
    "CONTRIBUTING.md": "contributing/index.md",
    "LICENSE": "contributing/LICENSE.txt",
    "SECURITY.md": "contributing/security.md",
    "benchmarks/results.json": "benchmarks/results.json",
    "examples": "examples/index.md",
    "examples/data/drive.mcap": "examples/data/drive.mcap",
}


def examples() -> list[Path]:
    return sorted((ROOT / "examples").glob("*.py"))


def on_config(config: Any) -> Any:
    """Fill the parts of the navigation that follow the folders."""
    decisions = sorted((ROOT / "docs" / "decisions").glob("0*.md"))
    filled = {
        "Decisions": ["decisions/index.md"]
        + [f"decisions/{path.name}" for path in decisions],
        "Examples": ["examples/index.md"]
        + [f"examples/{path.stem}.md" for path in examples()],
    }
    for section in config.nav:
        for entries in section.values():
            for entry in entries if isinstance(entries, list) else []:
                if isinstance(entry, dict):
                    name = next(iter(entry))
                    entry[name] = filled.get(name, entry[name])
    return config


def on_files(files: Files, config: Any) -> Files:
    """Add the pages made from files outside docs/."""
    for source, target in TEXTS.items():
        if (ROOT / source).is_file():
            path = str(ROOT / source)
            files.append(File.generated(config, target, abs_src_path=path))
    for path in examples():
        page = f"# {path.name}\n\n```python\n{path.read_text(encoding='utf-8')}```\n"
        files.append(File.generated(config, f"examples/{path.stem}.md", content=page))
    files.append(File.generated(config, "examples/index.md", content=_contents()))
    return files


def on_page_content(html: str, **_: Any) -> str:
    """Show names of Sphinx roles (:class:`Node`) as plain code."""
    return ROLE.sub(r"<code>", html)


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Point links that leave docs/ at the pages of the site."""
    source = page.file.src_uri
    origin = {target: path for path, target in TEXTS.items()}.get(source)
    if origin is None:
        folder = posixpath.dirname(f"docs/{source}")
    else:
        folder = origin if (ROOT / origin).is_dir() else posixpath.dirname(origin)

    def change(link: "re.Match[str]") -> str:
        if "://" in link[2]:
            return link[0]
        target = posixpath.normpath(posixpath.join(folder, link[2]))
        here = posixpath.dirname(source)
        new = posixpath.relpath(_page_of(target), here or ".")
        return f"{link[1]}{new}{link[3] or ''}{link[4]}"

    return LINK.sub(change, markdown)


def _page_of(path: str) -> str:
    """Page of the site that shows a file of the repository."""
    if path in TEXTS:
        return TEXTS[path]
    if path.startswith("examples/"):
        return posixpath.splitext(path)[0] + ".md"
    if path == "docs/decisions":
        return "decisions/index.md"
    return path.removeprefix("docs/")


def _contents() -> str:
    rows = []
    for path in examples():
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        rows.append(f"| [{path.name}]({path.stem}.md) | {text.splitlines()[0]} |")
    table = "\n".join(rows)
    return (
        f"# Examples\n\nIn reading order.\n\n| file | subject |\n|---|---|\n{table}\n"
    )
