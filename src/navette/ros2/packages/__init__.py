"""The small packages that ROS 2 programs use beside rclpy, under their own names."""
