"""Sources of launch descriptions."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.substitution import (
    Parts,
    TextSubstitution,
)


class LaunchDescriptionSource:
    """An existing description, or (in subclasses) a file that contains one.

    Args:
        launch_description: the description itself.
        location: path of a file.
        method: kind of source, for messages.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: Any = "<script>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location: Parts = Parts.of(location)
        self.method = method
        self.path: Path | None = None

    @property
    def location(self) -> str:
        """The path if it is known, else its substitutions."""
        return str(self.path) if self.path else self._location.describe()

    def read(self, path: Path) -> LaunchDescription:
        """Read a file; overridden by formats."""
        raise InvalidLaunchFileError(f"{path}: unknown format")

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description; its file is read on first use.

        Raises:
            InvalidLaunchFileError: the file cannot be read.
        """
        if self._description is None:
            path = Path(self._location.perform(context))
            self._description = self._load(path)
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description, or None if its path depends on the launch."""
        texts = [p.text for p in self._location if isinstance(p, TextSubstitution)]
        if self._description is None and len(texts) == len(self._location):
            path = "".join(texts)
            if path != "<script>":
                self._description = self._load(Path(path))
        return self._description

    def _load(self, path: Path) -> LaunchDescription:
        if not path.is_file():
            raise InvalidLaunchFileError(f"launch file {path} does not exist")
        self.path = path.resolve()
        return self.read(self.path)
