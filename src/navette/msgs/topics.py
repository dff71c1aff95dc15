"""Topics of the stack: names, types and QoS, in the order data flows.

The nodes' inputs and outputs, the live view, ``navette doctor`` and the reference page
read them from here. The module imports nothing, so that every layer may use it.
"""

from typing import NamedTuple


class StackTopic(NamedTuple):
    """A topic; ``latched`` is transient local durability."""

    name: str
    type: str
    depth: int = 10
    latched: bool = False


# Simulator or robot
CLOCK = StackTopic("/clock", "rosgraph_msgs/msg/Clock")
LIDAR = StackTopic("/lidar", "sensor_msgs/msg/LaserScan")
IMU = StackTopic("/imu", "sensor_msgs/msg/Imu")
CAMERA = StackTopic("/camera", "sensor_msgs/msg/Image")
CAMERA_INFO = StackTopic("/camera_info", "sensor_msgs/msg/CameraInfo")
DEPTH_IMAGE = StackTopic("/depth/image", "sensor_msgs/msg/Image")
DEPTH_INFO = StackTopic("/depth/camera_info", "sensor_msgs/msg/CameraInfo")
DEPTH_POINTS = StackTopic("/depth/points", "sensor_msgs/msg/PointCloud2")
POINTS = StackTopic("/points", "sensor_msgs/msg/PointCloud2")
SONAR = StackTopic("/sonar", "sensor_msgs/msg/Range")
HAZARDS = StackTopic(
    "/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector"
)
FIX = StackTopic("/fix", "sensor_msgs/msg/NavSatFix")
JOINT_STATES = StackTopic("/joint_states", "sensor_msgs/msg/JointState")
GROUND_TRUTH = StackTopic("/ground_truth", "nav_msgs/msg/Odometry")
CONTACTS = StackTopic("/contacts", "diagnostic_msgs/msg/DiagnosticArray", 1, True)
ACTORS = StackTopic("/actors", "visualization_msgs/msg/MarkerArray", 1)
ROBOT_DESCRIPTION = StackTopic("/robot_description", "std_msgs/msg/String", 1, True)
WORLD_DESCRIPTION = StackTopic("/world_description", "std_msgs/msg/String", 1, True)

# Localization
TF = StackTopic("/tf", "tf2_msgs/msg/TFMessage")
TF_STATIC = StackTopic("/tf_static", "tf2_msgs/msg/TFMessage", 1, True)
ODOMETRY = StackTopic("/odom/filtered", "nav_msgs/msg/Odometry")
AMCL_POSE = StackTopic(
    "/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped", 1, True
)
WHEEL_ODOMETRY = StackTopic("/wheels/odometry", "nav_msgs/msg/Odometry")
LOCALIZATION_STATUS = StackTopic(
    "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", 1, True
)
PARTICLES = StackTopic("/particle_cloud", "nav2_msgs/msg/ParticleCloud", 1)
SLAM_POSE = StackTopic("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped")
SLAM_MAP = StackTopic("/slam/map", "nav_msgs/msg/OccupancyGrid", 1, True)
GNSS = StackTopic("/gnss_driver/odometry", "gnss_driver/msg/Gps", 1)
DISTANCE = StackTopic("/odom_integrator/distance", "std_msgs/msg/Float64")

# Costmap, mapping, planning, control
COSTMAP = StackTopic("/costmap", "nav_msgs/msg/OccupancyGrid")
COSTMAP_POINTS = StackTopic("/costmap/points", "sensor_msgs/msg/PointCloud2")
MAP_POINTS = StackTopic("/map/points", "sensor_msgs/msg/PointCloud2", 1, True)
STATIC_MAP = StackTopic("/static_map", "nav_msgs/msg/OccupancyGrid", 1, True)
TRAJECTORY = StackTopic("/trajectory", "nav_msgs/msg/Path", 1, True)
MAP = StackTopic("/map", "nav_msgs/msg/OccupancyGrid", 1, True)
# Several updates are kept, for late subscribers with an older whole map.
MAP_UPDATES = StackTopic("/map_updates", "map_msgs/msg/OccupancyGridUpdate", 10, True)
LOCAL_COSTMAP = StackTopic(
    "/local_costmap/costmap", "nav_msgs/msg/OccupancyGrid", 1, True
)
LOCAL_FOOTPRINT = StackTopic(
    "/local_costmap/published_footprint", "geometry_msgs/msg/PolygonStamped", 1
)
TRAJECTORIES = StackTopic("/trajectories", "visualization_msgs/msg/MarkerArray", 1)
GLOBAL_COSTMAP = StackTopic(
    "/global_costmap/costmap", "nav_msgs/msg/OccupancyGrid", 1, True
)
GLOBAL_COSTMAP_UPDATES = StackTopic(
    "/global_costmap/costmap_updates", "map_msgs/msg/OccupancyGridUpdate"
)
TRACKED_OBSTACLES = StackTopic(
    "/tracked_obstacles", "nav2_dynamic_msgs/msg/ObstacleArray", 1
)
TRACKED_MARKERS = StackTopic(
    "/tracked_obstacles/markers", "visualization_msgs/msg/MarkerArray", 1
)
PATH = StackTopic("/path", "nav_msgs/msg/Path")
PLAN = StackTopic("/plan", "nav_msgs/msg/Path")
SPEED_LIMIT = StackTopic("/speed_limit", "nav2_msgs/msg/SpeedLimit")
KEEPOUT_INFO = StackTopic(
    "/keepout_costmap_filter_info", "nav2_msgs/msg/CostmapFilterInfo", 1, True
)
KEEPOUT_MASK = StackTopic("/keepout_filter_mask", "nav_msgs/msg/OccupancyGrid", 1, True)
SPEED_INFO = StackTopic(
    "/speed_costmap_filter_info", "nav2_msgs/msg/CostmapFilterInfo", 1, True
)
SPEED_MASK = StackTopic("/speed_filter_mask", "nav_msgs/msg/OccupancyGrid", 1, True)
KEEPOUT_ZONES = StackTopic("/keepout_zones", "nav_msgs/msg/OccupancyGrid", 1, True)
COLLISION_MONITOR_STATE = StackTopic(
    "/collision_monitor_state", "nav2_msgs/msg/CollisionMonitorState", 1
)

# Commands to the wheels: sources, arbiter, locks
CMD_VEL_NAV = StackTopic("/cmd_vel_nav", "geometry_msgs/msg/Twist")
CMD_VEL_TELEOP = StackTopic("/cmd_vel_teleop", "geometry_msgs/msg/Twist")
CMD_VEL_ASSISTED = StackTopic("/cmd_vel_assisted", "geometry_msgs/msg/Twist")
CMD_VEL_REFLEX = StackTopic("/cmd_vel_reflex", "geometry_msgs/msg/Twist")
PREEMPT_TELEOP = StackTopic("/preempt_teleop", "std_msgs/msg/Empty")
CMD_VEL = StackTopic("/cmd_vel", "geometry_msgs/msg/Twist")
DRIVE = StackTopic("/drive", "ackermann_msgs/msg/AckermannDriveStamped")
EMERGENCY_STOP = StackTopic("/emergency_stop", "std_msgs/msg/Bool")
EMERGENCY_STOP_RELEASE = StackTopic("/emergency_stop/release", "std_msgs/msg/Empty")
EMERGENCY_STOP_ACTIVE = StackTopic(
    "/emergency_stop/active", "std_msgs/msg/Bool", 1, True
)
CANCEL_GOAL = StackTopic("/cancel_goal", "std_msgs/msg/Empty")
PAUSE_NAVIGATION = StackTopic("/pause_navigation", "std_msgs/msg/Bool")

# Status of a stage
_STATUS = "diagnostic_msgs/msg/DiagnosticStatus"
PLANNER_STATUS = StackTopic("/planner/status", _STATUS, 1, True)
CONTROL_STATUS = StackTopic("/control/status", _STATUS, 1, True)
COMMANDER = StackTopic("/commander", _STATUS, 1, True)
DIAGNOSTICS = StackTopic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")

# From missions to the planner
PLANNER_GOAL = StackTopic("/planner/goal_pose", "geometry_msgs/msg/PoseStamped")

# The behaviour tree that runs
BEHAVIOR_TREE = StackTopic("/behavior_tree", "std_msgs/msg/String", 1, True)
BEHAVIOR_TREE_LOG = StackTopic("/behavior_tree_log", "nav2_msgs/msg/BehaviorTreeLog")

# Published by a person
GOAL_POINT = StackTopic("/goal_point", "geometry_msgs/msg/PointStamped")
GOAL_POSE = StackTopic("/goal_pose", "geometry_msgs/msg/PoseStamped")
INITIAL_POSE = StackTopic("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")

#: Inputs without a publisher in a complete stack: of people, of further nodes, and of
#: stages that some runs do not have.
OPTIONAL = (
    GOAL_POINT,
    GOAL_POSE,
    INITIAL_POSE,
    CANCEL_GOAL,
    PAUSE_NAVIGATION,
    EMERGENCY_STOP,
    EMERGENCY_STOP_RELEASE,
    PREEMPT_TELEOP,
    CMD_VEL_TELEOP,
    CMD_VEL_ASSISTED,
    CMD_VEL_REFLEX,
    DRIVE,
    SPEED_LIMIT,
    SPEED_INFO,
    SPEED_MASK,
    KEEPOUT_INFO,
    KEEPOUT_MASK,
    KEEPOUT_ZONES,
    LOCALIZATION_STATUS,
    TRAJECTORY,
)


class ChainLink(NamedTuple):
    """A stage of the chain from sensor to wheels: its input and its output."""

    stage: str
    reads: StackTopic
    publishes: StackTopic


CHAIN = (
    ChainLink("costmap", LIDAR, COSTMAP),
    ChainLink("map_memory", COSTMAP, MAP),
    ChainLink("planner", MAP, PATH),
    ChainLink("control", PATH, CMD_VEL_NAV),
    ChainLink("arbiter", CMD_VEL_NAV, CMD_VEL),
)
