"""Drives as bags of gnss_driver/msg/Gps, and their distance by odom_integrator."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from navette.bags import open_bag
from navette.bags.bag import BagMessage, BagTopic
from navette.bags.play import PlayOptions, PlayState
from navette.bags.play.node import PlayerNode
from navette.bags.writing import open_writer
from navette.msgs import definition_text, serialize, type_hash
from navette.msgs.gnss_driver.msg import Gps
from navette.navigation.localization.distance.node import OdomIntegratorNode
from navette.runtime import Context, Executor, Parameter, VirtualClock, ns_to_stamp

TOPIC = "/gnss_driver/odometry"
START_NS = 1_317_000_000_000_000_000
UTM_M = np.array([456_000.0, 5_428_000.0, 115.0])
_KIND = "gnss_driver/msg/Gps"
_TOPIC = BagTopic(TOPIC, _KIND, definition_text(_KIND), type_hash(_KIND))


def length(positions: np.ndarray) -> float:
    """Return the path length of positions (N, 3) in metres."""
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())


def write_drive(path: Path, times_s: np.ndarray, positions: np.ndarray) -> None:
    """Write a bag in the format of its suffix; velocities are central differences.

    Args:
        times_s: (N,) since the start.
        positions: (N, 3) east, north, up relative to the start, m.
    """
    velocities = np.gradient(positions, times_s, axis=0)
    writer = open_writer(path)
    for time_s, place, velocity in zip(
        times_s, (positions + UTM_M).tolist(), velocities.tolist(), strict=True
    ):
        stamp_ns = START_NS + round(time_s * 1e9)
        message = Gps()
        message.header.stamp = ns_to_stamp(stamp_ns)
        message.header.frame_id = "utm"
        position = message.localization.position
        position.x, position.y, position.z = place
        linear = message.localization.linear_velocity
        linear.x, linear.y, linear.z = velocity
        writer.write(BagMessage(_TOPIC, stamp_ns, serialize(message)))
    writer.close()


def played_distance(
    bag: Path,
    *,
    odom_type: str = "pos",
    rate: float = 1.0,
    passes: int = 1,
    seeks: Sequence[tuple[float, float]] = (),
) -> float:
    """Return /odom_integrator/distance after playing a bag beside the node.

    Args:
        passes: how often the bag is played, by looping.
        seeks: (when, where to): places in the recording, s since its start.
    """
    context = Context(clock=VirtualClock())
    with context, open_bag(bag) as source:
        options = PlayOptions(rate=rate, loop=passes > 1)
        player = PlayerNode(source, options, context=context)
        overrides = [Parameter("odom_type", value=odom_type)]
        integrator = OdomIntegratorNode(
            context=context, parameter_overrides=overrides, enable_rosout=False
        )
        executor = Executor(context=context)
        for node in (player, integrator):
            executor.add_node(node)
        player.start()
        for when_s, where_s in seeks:
            executor.spin_until_complete(lambda at=when_s: _is_at(player, at))
            player.seek(player.player.begin_ns + round(where_s * 1e9))
        executor.spin_until_complete(lambda: _has_ended(player, passes))
        executor.spin_for(200_000_000)
        distance = integrator.distance
        player.destroy_node()
        return distance


def _is_at(player: PlayerNode, place_s: float) -> bool:
    progress = player.progress()
    return progress.position_ns - progress.begin_ns >= place_s * 1e9


def _has_ended(player: PlayerNode, passes: int) -> bool:
    if passes == 1:
        return player.player.state is PlayState.ENDED
    if player.progress().passes <= passes:  # counted as they begin
        return False
    player.pause()
    return True
