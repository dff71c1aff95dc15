"""ament_index_python.search_paths."""

from navette.ros2.workspace.finding import installed_prefixes, search_roots


def get_search_paths() -> list[str]:
    """The folders that packages are looked for in: sources first, then prefixes.

    Raises:
        FileFormatError: a folder that NAVETTE_PATH names is not there.
    """
    return [str(path) for path in (*search_roots(), *installed_prefixes())]
