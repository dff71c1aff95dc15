"""Parameters of the zones."""

from dataclasses import dataclass

from navette.navigation.shared_params import FrameParams
from navette.params import param


@dataclass(frozen=True, kw_only=True)
class ZonesParams(FrameParams):
    """Masks of the zones; ``base`` and ``multiplier`` as in CostmapFilterInfo."""

    keepout_file: str = param(
        "",
        "mask of the keep-out zones, a YAML file of map_server: occupied cells are "
        "zones; empty: a mask of another node",
    )
    speed_file: str = param(
        "",
        "mask of the speed zones; the darker a cell, the slower; empty: a mask of "
        "another node",
    )
    speed_in_percent: bool = param(
        True, "whether limits are percent of the robot's speed; false: m/s"
    )
    speed_base: float = param(100.0, "limit where the mask is 0 (white)")
    speed_multiplier: float = param(
        -1.0, "limit = speed_base + speed_multiplier · value of the mask, 0 … 100"
    )
    lethal_value: int = param(
        99, "value of a keep-out mask from which a cell is a zone", at_least=1,
        at_most=100,
    )  # fmt: skip
