"""Keep-out and speed zones: Nav2's costmap filters."""

from navette.navigation.mapping.zones.masks import FilterMask
from navette.navigation.mapping.zones.params import ZonesParams

__all__ = ["FilterMask", "ZonesParams"]
