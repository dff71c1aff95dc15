"""Launch files: ROS 2's ``launch`` and ``launch_ros``, and their XML and YAML forms."""
