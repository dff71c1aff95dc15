"""Sources: where a launch description comes from."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.substitution import (
    Parts,
    TextSubstitution,
    describe_parts,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchDescriptionSource:
    """A description that is there already, or (in subclasses) a file with one.

    Args:
        launch_description: the description itself.
        location: path of a file.
        method: how it is had, for messages.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: Any = "<script>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location: Parts = normalize_to_list_of_substitutions(location)
        self.method = method
        self.path: Path | None = None

    @property
    def location(self) -> str:
        """The path if it is known, else how it is made."""
        return str(self.path) if self.path else describe_parts(self._location)

    def read(self, path: Path) -> LaunchDescription:
        """Read a file; formats override this."""
        raise InvalidLaunchFileError(f"{path}: no format to read it")

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """The description; its file is read the first time.

        Raises:
            InvalidLaunchFileError: it cannot be read; names file and reason.
        """
        if self._description is None:
            path = Path(perform_substitutions(context, self._location))
            self._description = self._load(path)
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """The description, unless its path is only known in a launch."""
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
