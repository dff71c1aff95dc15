"""rclpy's modules, each a list of the names that Navette has of it.

The import hook gives out ``ros2/rclpy/qos.py`` as ``rclpy.qos``. An editor that has
this folder on its search path completes ``import rclpy`` as well.
"""
