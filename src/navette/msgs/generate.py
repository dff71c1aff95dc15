"""Write the modules and type stubs of all interface packages.

    python -m navette.msgs.generate

The modules (``std_msgs/msg.py``, …) are committed: run the command after adding a file
under ``definitions/`` and commit the new modules. The type stubs (``std_msgs/msg.pyi``,
…) are not committed: the build makes them, also for ``pip install -e .``. Run the
command if mypy finds none in a checkout.
"""

import sys
from pathlib import Path

from navette.msgs.registry import DEFINITIONS, KINDS, interface_names
from navette.msgs.stubs import module_text, package_text, stub_text

ROOT = Path(__file__).parent


def generated_files() -> dict[Path, str]:
    """Return the text of every generated file by its path below this folder."""
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


def write_files() -> list[Path]:
    """Write the files whose text changed and return their paths."""
    changed = []
    for path, text in generated_files().items():
        target = ROOT / path
        if not target.is_file() or target.read_text("utf-8") != text:
            target.parent.mkdir(exist_ok=True)
            target.write_text(text, "utf-8", newline="\n")
            changed.append(path)
    return changed


if __name__ == "__main__":
    for path in write_files():
        sys.stdout.write(f"{path}\n")
