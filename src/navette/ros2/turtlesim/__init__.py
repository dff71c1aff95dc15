"""turtlesim: the turtles of ROS 2's first tutorials."""
