"""Write type stubs of rclpy, with which editors and type checkers complete programs.

    python -m navette.ros2.names.stubs

The stubs are not in git: building the package runs this command. An editor finds them
when the folder ``typings`` is on its search path.
"""

from pathlib import Path

from navette.ros2.names.rclpy_names import rclpy_modules

FOLDER = Path(__file__).parent / "typings"


def stub_texts() -> dict[Path, str]:
    """Return the text of every stub by its path below :data:`FOLDER`."""
    modules = rclpy_modules()
    parents = {name.rpartition(".")[0] for name in modules}
    texts = {}
    for module, names in modules.items():
        path = Path(*module.split("."))
        file = path / "__init__.pyi" if module in parents else path.with_suffix(".pyi")
        texts[file] = "".join(
            f"from {place.module} import {place.attribute} as {name}\n"
            for name, place in sorted(names.items())
        )
    return texts


if __name__ == "__main__":
    for path, text in stub_texts().items():
        (FOLDER / path).parent.mkdir(parents=True, exist_ok=True)
        (FOLDER / path).write_text(text, "utf-8", newline="\n")
