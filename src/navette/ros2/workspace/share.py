"""Share directory of a source package, laid out as after an installation.

Most packages install files under the same relative path, ``launch/x`` to
``share/name/launch/x``: then the source folder is the share directory. If
``data_files`` of setup.py moves files, the share directory is a folder of links to the
package's files and to the moved files in their new places.
"""

import hashlib
import shutil
import tempfile
from pathlib import Path, PurePosixPath

from navette.files.folders import cache_folder
from navette.ros2.workspace.setup_py import SetupPy, read_setup_py


def share_directory(name: str, folder: Path) -> Path:
    """Return the share directory of the source package in ``folder``.

    Raises:
        FileFormatError: setup.py is not valid Python.
    """
    setup = read_setup_py(folder / "setup.py")
    moved = {} if setup is None else _moved(setup, name)
    return _linked(name, folder, moved) if moved else folder


def _moved(setup: SetupPy, name: str) -> dict[PurePosixPath, Path]:
    """Return the moved files by their path below the share directory."""
    found: dict[PurePosixPath, Path] = {}
    data_files = setup.arguments.get("data_files")
    for entry in getattr(data_files, "elts", ()):
        if len(getattr(entry, "elts", ())) != 2:
            continue
        target = PurePosixPath(setup.text(entry.elts[0]) or "")
        if target.parts[:2] != ("share", name):
            continue
        for text in setup.texts(entry.elts[1]):
            file = setup.folder / text
            place = PurePosixPath(*target.parts[2:], file.name)
            if file.is_file() and not (setup.folder / place).exists():
                found[place] = file
    return found


def _linked(name: str, folder: Path, moved: dict[PurePosixPath, Path]) -> Path:
    """Return a folder of links, which is created once for the same content."""
    children = sorted(c for c in folder.iterdir() if not c.name.startswith("."))
    plan = repr((str(folder), [c.name for c in children], sorted(moved.items())))
    digest = hashlib.sha256(plan.encode()).hexdigest()[:20]
    cache = cache_folder("share")
    if cache is None:
        return folder
    view = cache / digest / name
    if view.is_dir():
        return view
    # Created elsewhere and renamed, so that other processes never see a part of it.
    making = Path(tempfile.mkdtemp(dir=cache))
    (making / name).mkdir()
    for child in children:
        _link(child, making / name / child.name)
    for place, file in moved.items():
        _place(making / name, place, file)
    try:
        making.rename(view.parent)
    except OSError:  # another process was first
        shutil.rmtree(making)
    return view


def _place(view: Path, place: PurePosixPath, file: Path) -> None:
    """Link a file; replace links to folders on its path by folders of links."""
    folder = view
    for part in place.parts[:-1]:
        folder = folder / part
        if folder.is_symlink():
            real = folder.resolve()
            folder.unlink()
            folder.mkdir()
            for child in real.iterdir():
                _link(child, folder / child.name)
        folder.mkdir(exist_ok=True)
    _link(file, folder / place.name)


def _link(target: Path, place: Path) -> None:
    try:
        place.symlink_to(target.resolve(), target_is_directory=target.is_dir())
    except OSError:
        # Links require a privilege on Windows. Copies do not follow later changes.
        if target.is_dir():
            shutil.copytree(target, place)
        else:
            shutil.copy2(target, place)
