"""Sources of launch files in any format."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend import FORMATS, parse_launch_file
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_source import (
    LaunchDescriptionSource,
)
from navette.ros2.packages.launch.launch_description_sources.python_files import (
    get_launch_description_from_python_launch_file,
)


def get_launch_description_from_any_launch_file(
    launch_file_path: Path | str,
) -> LaunchDescription:
    """Read a ``.py``, ``.xml``, ``.launch``, ``.yaml`` or ``.yml`` file.

    Raises:
        InvalidLaunchFileError: an unknown file ending, or an invalid file.
    """
    path = Path(launch_file_path)
    if path.suffix == ".py":
        return get_launch_description_from_python_launch_file(path)
    if path.suffix in FORMATS:
        return parse_launch_file(path)
    raise InvalidLaunchFileError(
        f"{path}: unknown launch file format; expected a file ending in .py, "
        f"{', '.join(FORMATS)}"
    )


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """Source of a launch file in any format."""

    def __init__(self, launch_file_path: Any) -> None:
        super().__init__(None, launch_file_path, "launch file")

    def read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(path)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """Source of a launch file in XML or YAML."""

    def __init__(self, launch_file_path: Any, **kwargs: Any) -> None:
        super().__init__(None, launch_file_path, "XML or YAML launch file")

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path)


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Source of an XML launch file with any ending."""

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path, ".xml")


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Source of a YAML launch file with any ending."""

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path, ".yaml")
