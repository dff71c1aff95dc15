"""ROS 2's Python packages other than rclpy, under their own names."""
