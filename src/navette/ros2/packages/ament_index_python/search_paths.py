"""ament_index_python.search_paths."""

from navette.ros2.workspace.finding import installed_prefixes, search_roots


def get_search_paths() -> list[str]:
    """Return the folders in which packages are searched: sources, then prefixes.

    Raises:
        FileFormatError: a folder of NAVETTE_PATH does not exist.
    """
    return [str(path) for path in (*search_roots(), *installed_prefixes())]
