"""Package of the stand-ins for ROS 2's C++ package ``lifecycle``."""

from setuptools import setup

setup(
    name="lifecycle",
    version="0.0.0",
    packages=["lifecycle"],
    entry_points={
        "console_scripts": [
            "lifecycle_listener = lifecycle.nodes:listener",
            "lifecycle_talker = lifecycle.nodes:talker",
        ]
    },
)
