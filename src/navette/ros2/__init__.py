"""ROS 2's Python surface: module names, packages, launch files, workspaces."""
