/** Topics of the stack that the page itself reads or writes. */

export const GOAL_POINT = "/goal_point";
export const GOAL_POSE = "/goal_pose";
export const CANCEL_GOAL = "/cancel_goal";
export const PAUSE = "/pause_navigation";
export const INITIAL_POSE = "/initialpose";
export const STOP = "/emergency_stop";
export const RELEASE = "/emergency_stop/release";
export const PLANNER_STATUS = "/planner/status";
export const CONTROL_STATUS = "/control/status";
export const COMMANDER = "/commander";
export const CONTACTS = "/contacts";
/** In the order in which the first that exists is used: estimates, as a robot has them, before the truth. */
export const ODOMETRY = ["/odom/filtered", "/odometry/filtered", "/odom", "/ground_truth"];
/** The arbiter's topic for operators, or that of a robot without an arbiter. */
export const DRIVE = ["/cmd_vel_teleop", "/cmd_vel"];
/** Plays a recording: its subscriptions and publications are no robot's. */
export const PLAYER = "/rosbag2_player";
export const OUTLINE = "/control.footprint_m";
