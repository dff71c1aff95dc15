"""The one part of rclpy's inside that programs use."""
