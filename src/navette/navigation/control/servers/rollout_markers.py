"""Motions that a controller compared, as markers."""

import numpy as np

from navette.msgs.geometry_msgs.msg import Point, Vector3
from navette.msgs.std_msgs.msg import ColorRGBA, Header
from navette.msgs.visualization_msgs.msg import Marker, MarkerArray
from navette.navigation.control.records import Rollouts

_WIDTH_M = 0.015
# Of each line: as smooth to the eye, and the next command does not wait for messages
# with all of them.
_MOST_POINTS = 8
# From the cheapest motion to one that costs as much as the dearest of the better half.
_CHEAP, _DEAR = np.array((0.13, 0.55, 0.42)), np.array((0.72, 0.55, 0.45))


def rollout_markers(rollouts: Rollouts | None, header: Header) -> MarkerArray:
    """Return one line for each motion, coloured by cost; None removes the lines."""
    markers = [Marker(header=header, ns="rollouts", action=Marker.DELETEALL)]
    if rollouts is None:
        return MarkerArray(markers=markers)
    least, usual = rollouts.costs[0], float(np.median(rollouts.costs))
    steps = rollouts.positions.shape[1]
    drawn = np.linspace(0, steps - 1, min(steps, _MOST_POINTS), dtype=np.intp)
    shares = (rollouts.costs - least) / max(usual - least, 1e-9)
    # The cheapest is drawn last, above the others.
    for number in reversed(range(len(shares))):
        share = min(1.0, float(shares[number]))
        red, green, blue = ((1 - share) * _CHEAP + share * _DEAR).tolist()
        colour = ColorRGBA(r=red, g=green, b=blue, a=1.0 if number == 0 else 0.35)
        marker = Marker(header=header, ns="rollouts", id=number, type=Marker.LINE_STRIP)
        marker.scale = Vector3(x=_WIDTH_M * (2 if number == 0 else 1))
        marker.color = colour
        marker.pose.orientation.w = 1.0
        marker.points = [
            Point(x=x, y=y) for x, y in rollouts.positions[number, drawn].tolist()
        ]
        markers.append(marker)
    return MarkerArray(markers=markers)
