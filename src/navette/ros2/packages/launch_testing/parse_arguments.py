"""Launch arguments of ``launch_test``."""

from collections.abc import Iterable


def parse_launch_arguments(launch_arguments: Iterable[str]) -> list[tuple[str, str]]:
    """Parse ``name:=value`` words; the last value of a name counts.

    Raises:
        RuntimeError: a malformed word.
    """
    found: dict[str, str] = {}
    for word in launch_arguments:
        name, _, value = word.partition(":=")
        if not name or not value:
            raise RuntimeError(
                f"malformed launch argument {word!r}: expected <name>:=<value>"
            )
        found[name] = value
    return list(found.items())
