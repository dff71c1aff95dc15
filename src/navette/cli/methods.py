"""Options that choose the methods of the stages; several verbs have them."""

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from navette.cli.options import Option
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.navigation.stack import RunOptions

PANEL = "Bring your own"
_PLACE = "NAME|FILE.py:CLASS"


@dataclass(frozen=True, kw_only=True)
class MethodOptions:
    """Methods by name, or the user's own by place."""

    planner: Annotated[
        str | None,
        Option(
            metavar=_PLACE,
            help="Planner: a_star, dijkstra, breadth_first, one of an installed"
            " package, or your own class or function.",
            panel=PANEL,
        ),
    ] = None
    controller: Annotated[
        str | None,
        Option(
            metavar=_PLACE,
            help="Controller: pure_pursuit, cross_track_pid, mppi, or your own.",
            panel=PANEL,
        ),
    ] = None

    costmap: Annotated[
        str | None,
        Option(
            metavar=_PLACE,
            help="Costmap: scan, or your own.",
            panel=PANEL,
        ),
    ] = None
    mapping: Annotated[
        str | None,
        Option(
            metavar=_PLACE,
            help="Mapping: overwrite, max, log_odds, or your own.",
            panel=PANEL,
        ),
    ] = None

    localization: Annotated[
        str | None,
        Option(
            metavar="truth|odometry|slam|amcl[+SENSOR]",
            help="Where the robot's pose comes from: the simulator's true pose, noisy"
            " odometry alone, or that corrected by SLAM, or by AMCL on a known map"
            " (--map). Odometry is that of the wheels, with slam and amcl fused with"
            " the IMU; odometry+imu and slam+wheels change that. Default: truth; of"
            " demo: slam.",
        ),
    ] = None

    replace: Annotated[
        list[str] | None,
        Option(
            metavar="NODE=FILE.py[:CLASS]",
            help="Your own rclpy node instead of a node of the stack (planner, control,"
            " costmap, map_memory, tracking, localizer, behaviors), in the same"
            " simulated time. Repeat for several.",
            panel=PANEL,
        ),
    ] = None

    param: Annotated[
        list[str] | None,
        Option(
            "-p",
            "--param",
            metavar="NODE.NAME=VALUE",
            help="Set a parameter of a node, of your method too. Repeat for several.",
            panel=PANEL,
        ),
    ] = None

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Node → parameter → value of ``-p``.

        Raises:
            InvalidValueError: not of the form NODE.NAME=VALUE.
        """
        from navette.runtime.parameter_files import parse_value

        found: dict[str, dict[str, Any]] = {}
        for text in self.param or ():
            name, equals, value = text.partition("=")
            node, dot, parameter = name.lstrip("/").partition(".")
            if not (equals and dot and node and parameter):
                raise InvalidValueError(
                    f"-p {text!r}: expected NODE.NAME=VALUE, as "
                    "control.cruise_speed_mps=1"
                )
            found.setdefault(node, {})[parameter] = parse_value(value)
        return found

    @property
    def replacements(self) -> dict[str, str]:
        """Node → the user's class of nodes.

        Raises:
            InvalidValueError: not of the form NODE=PLACE.
            UnknownNameError: no such node, or one that cannot be replaced.
        """
        if not self.replace:
            return {}
        # Imported here: it loads the runtime.
        from navette.navigation.stack.programs import check_replaceable

        found = {}
        for text in self.replace:
            node, equals, place = text.partition("=")
            if not (node and equals and place):
                raise InvalidValueError(
                    f"--replace {text!r}: expected NODE=FILE.py or NODE=FILE.py:CLASS"
                )
            found[node.lstrip("/")] = place
        check_replaceable(found)
        return found

    @property
    def chosen(self) -> dict[str, str]:
        """What is chosen → its name."""
        given = {
            "planner": self.planner,
            "controller": self.controller,
            "costmap": self.costmap,
            "mapping": self.mapping,
            "localization": self.localization,
        }
        return {kind: name for kind, name in given.items() if name is not None}

    def with_localization(self, default: str) -> "MethodOptions":
        """Return the options with a localization if they choose none."""
        return dataclasses.replace(self, localization=self.localization or default)

    def applied_to(self, run: "RunOptions") -> "RunOptions":
        """Return the options of a run with these."""
        return dataclasses.replace(
            run,
            methods=self.chosen,
            replacements=self.replacements,
            parameters=self.parameters,
        )
