# SPDX-License-Identifier: Apache-2.0
"""How a surface answers a laser beam: glass and dark material.

Glass: a beam passes, except near the normal of the surface, where the specular
reflection returns to the sensor (Foster, Sun, Park, Kuipers: "VisAGGE: Visible angle
grid for glass environments", ICRA 2013: lidars receive glass within a few degrees of
the normal only).

Dark material: the received power is proportional to reflectivity / range², so that the
range from which an echo is still detected grows with the square root of the
reflectivity. Data sheets agree: SICK TiM571, 25 m at 90 % and 8 m at 10 %.
"""

import math
from dataclasses import dataclass

from navette.errors import InvalidValueError

_REFERENCE = 0.9  # reflectivity for which data sheets state the largest range


@dataclass(frozen=True)
class Surface:
    """Answer of a surface to laser light of 800 to 1000 nm.

    Attributes:
        reflectivity: share of light that is reflected diffusely, 0 … 1.
        specular_rad: a transparent surface returns beams up to this angle from its
            normal; None: opaque, an echo from every angle.
    """

    reflectivity: float = _REFERENCE
    specular_rad: float | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.reflectivity <= 1.0:
            raise InvalidValueError(
                f"surface: reflectivity {self.reflectivity:g}; expected 0 to 1"
            )
        angle = self.specular_rad
        if angle is not None and not 0.0 <= angle <= math.pi / 2:
            raise InvalidValueError(
                f"surface: specular angle {math.degrees(angle):g}°; expected 0 to 90°"
            )

    @property
    def reach(self) -> float:
        """Share of the largest range from which the surface returns an echo."""
        if self.specular_rad is not None:
            return 1.0
        return min(1.0, math.sqrt(self.reflectivity / _REFERENCE))


PLAIN = Surface()
GLASS = Surface(reflectivity=0.08, specular_rad=math.radians(5.0))
BLACK = Surface(reflectivity=0.02)

SURFACES = {"plain": PLAIN, "glass": GLASS, "black": BLACK}
"""Surfaces by their names in world files."""
