"""The node: messages in the map frame, markers on demand, silence at rest."""

import math

import numpy as np

from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.navigation.tracking.node import TrackingNode
from navette.runtime.testing import GraphHarness
from navette.sim import World, load_robot
from navette.sim.node import SimNode

OBSTACLES = "/tracked_obstacles"


def _graph(graph: GraphHarness, world: World) -> None:
    scene = world.scene().with_robot(load_robot("jackal").model)
    graph.add(SimNode(scene, context=graph.context))
    graph.add(TrackingNode(context=graph.context))


def test_a_walker_is_published_with_position_velocity_and_size() -> None:
    world = World().add_walls((16, 16)).add_actor([(0, 4, -2), (4, 4, 2)], 0.25)
    with GraphHarness() as graph:
        _graph(graph, world)
        found = graph.collect(OBSTACLES, "nav2_dynamic_msgs/msg/ObstacleArray")
        drawn = graph.collect(
            f"{OBSTACLES}/markers", "visualization_msgs/msg/MarkerArray"
        )
        graph.run_for(3.0)
        message: ObstacleArray = found.last
        (obstacle,) = message.obstacles
        stamp_s = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        assert message.header.frame_id == "map"
        assert math.isclose(obstacle.position.x, 4.0, abs_tol=0.05)
        assert math.isclose(obstacle.position.y, stamp_s - 2.0, abs_tol=0.05)
        assert math.isclose(obstacle.velocity.y, 1.0, abs_tol=0.05)
        assert math.isclose(obstacle.size.x, 0.5, abs_tol=0.06)
        first: ObstacleArray = found.messages[5]
        assert np.array_equal(first.obstacles[0].uuid.uuid, obstacle.uuid.uuid)
        assert len(drawn.last.markers) == 3  # delete, disc, velocity


def test_nothing_is_published_while_nothing_moves() -> None:
    with GraphHarness() as graph:
        _graph(graph, World().add_walls((16, 16)).add_box((3, 0), (1, 1)))
        found = graph.collect(OBSTACLES, "nav2_dynamic_msgs/msg/ObstacleArray")
        graph.run_for(2.0)
        assert found.count == 0
