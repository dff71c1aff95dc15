"""Options that choose the methods of the stages; several verbs have them."""

from dataclasses import dataclass
from typing import Annotated

from navette.cli.options import Option

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

    @property
    def chosen(self) -> dict[str, str]:
        """What is chosen → its name."""
        return {kind: name for kind, name in vars(self).items() if name is not None}
