/** Definitions of the types that the page publishes, for servers that do not offer their topic. */

const HEADER = `================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
`;
const VECTOR = `================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
`;
const POINT = `================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
`;
const POSE = `================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
${POINT}`;
const TWIST = `================================================================================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
${VECTOR}`;
const POSE_STAMPED = `================================================================================
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
geometry_msgs/Pose pose
`;

export const KNOWN_DEFINITIONS: Readonly<Record<string, string>> = {
  "std_msgs/msg/Empty": "",
  "std_msgs/msg/Bool": "bool data\n",
  "std_msgs/msg/String": "string data\n",
  "std_msgs/msg/Float64": "float64 data\n",
  "geometry_msgs/msg/Twist": `geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n${VECTOR}`,
  "geometry_msgs/msg/TwistStamped": `std_msgs/Header header\ngeometry_msgs/Twist twist\n${HEADER}${TWIST}`,
  "geometry_msgs/msg/PointStamped": `std_msgs/Header header\ngeometry_msgs/Point point\n${HEADER}${POINT}`,
  "geometry_msgs/msg/PoseStamped": `std_msgs/Header header\ngeometry_msgs/Pose pose\n${HEADER}${POSE}`,
  "geometry_msgs/msg/PoseWithCovarianceStamped": `std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
================================================================================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
${HEADER}${POSE}`,
  "geometry_msgs/msg/PoseArray": `std_msgs/Header header\ngeometry_msgs/Pose[] poses\n${HEADER}${POSE}`,
  "nav_msgs/msg/Path": `std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n${HEADER}${POSE_STAMPED}${POSE}`,
};
