"""The parts of rclpy's inside that programs use."""
