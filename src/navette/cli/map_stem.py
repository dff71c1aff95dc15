"""Names of map files that a user gives: ``office``, ``office.yaml``."""

from pathlib import Path

from navette.errors import InvalidValueError

_SUFFIXES = (".yaml", ".pgm")


def map_stem(given: Path) -> Path:
    """Return the name without its suffix.

    Raises:
        InvalidValueError: the name is empty or of a folder, beside which the files
            would be written.
    """
    if given.name in ("", "..") or given.is_dir():
        raise InvalidValueError(
            f"{str(given)!r} is a folder; name the map, as in {given / 'office'}"
        )
    return given.with_suffix("") if given.suffix in _SUFFIXES else given
