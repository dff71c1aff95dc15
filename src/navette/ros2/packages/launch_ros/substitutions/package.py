"""Substitutions of package folders and executables."""

from navette.ros2.packages.launch import SomeSubstitutionsType, Substitution
from navette.ros2.packages.launch.errors import SubstitutionFailure
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.substitutions import PathJoinSubstitution
from navette.ros2.workspace import find_package


class FindPackagePrefix(Substitution):
    """Install prefix of a package (``$(find-pkg-prefix name)``)."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = Parts.of(package)

    def find(self, package_name: str) -> str:
        """Return the folder of a package."""
        return str(find_package(package_name).prefix)

    def perform(self, context: LaunchContext) -> str:
        return self.find(self.package.perform(context))

    def __truediv__(self, part: object) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, part])


FindPackage = FindPackagePrefix


class FindPackageShare(FindPackagePrefix):
    """Share folder of a package (``$(find-pkg-share name)``)."""

    def find(self, package_name: str) -> str:
        return str(find_package(package_name).share)


class ExecutableInPackage(Substitution):
    """Path of an executable (``$(exec-in-pkg executable package)``)."""

    def __init__(
        self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType
    ) -> None:
        self.executable = Parts.of(executable)
        self.package = Parts.of(package)

    def perform(self, context: LaunchContext) -> str:
        package = self.package.perform(context)
        name = self.executable.perform(context)
        path = find_package(package).executable(name).path
        if path is None:
            raise SubstitutionFailure(
                f"executable {name!r} of package {package!r} is a Python function, "
                "not a file"
            )
        return str(path)
