"""Rewrites the modules and stubs of all packages from their definitions.

    python -m navette.msgs.generate            write what changed
    python -m navette.msgs.generate --check    name what would change; exit 1 if any

Run it after a file under ``definitions/`` was added or changed, and commit the result.
"""

import sys
from pathlib import Path

from navette.msgs.registry import DEFINITIONS, KINDS, interface_names
from navette.msgs.stubs import module_text, package_text, stub_text

ROOT = Path(__file__).parent


def generated_files() -> dict[Path, str]:
    """Path below this folder and text of every generated file."""
    files = {}
    for folder in sorted(DEFINITIONS.iterdir()):
        package = folder.name
        files[Path(package, "__init__.py")] = package_text(package)
        for kind in KINDS:
            names = interface_names(package, kind)
            if names:
                files[Path(package, f"{kind}.py")] = module_text(package, kind)
                files[Path(package, f"{kind}.pyi")] = stub_text(package, kind, names)
    return files


def outdated_files() -> list[Path]:
    """Generated files whose committed text differs from what is generated now."""
    return [
        path
        for path, text in generated_files().items()
        if not (ROOT / path).is_file() or (ROOT / path).read_text("utf-8") != text
    ]


def write_files() -> list[Path]:
    """Write every file that differs; returns their paths."""
    texts = generated_files()
    changed = outdated_files()
    for path in changed:
        (ROOT / path).parent.mkdir(exist_ok=True)
        (ROOT / path).write_text(texts[path], "utf-8", newline="\n")
    return changed


def main(arguments: list[str]) -> int:
    """The command; returns its exit code."""
    is_check = arguments == ["--check"]
    if arguments and not is_check:
        sys.stderr.write("usage: python -m navette.msgs.generate [--check]\n")
        return 2
    changed = outdated_files() if is_check else write_files()
    for path in changed:
        sys.stdout.write(f"{path}\n")
    return 1 if is_check and changed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
