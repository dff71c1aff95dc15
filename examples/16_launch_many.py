"""A launch file: nodes with namespaces, remappings and parameters, in sequence.

Program and launch file also run on ROS 2. On the command line: ``navette launch
greet.launch.py word:=Servus``; ``--processes`` starts a process per node.

Prints::

    [greeter-1] Servus on /left/greeting, volume 1
    [greeter-2] Servus on /hall, volume 9
    exit code 0
"""

import io
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

from navette.ros2.launch import launch
from navette.ros2.names import install

GREETER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("greeter")
word = node.declare_parameter("word", "Hello").value
volume = node.declare_parameter("volume", 1).value
topic = node.create_publisher(String, "greeting", 10).topic_name
print(f"{word} on {topic}, volume {volume}")
"""

LAUNCH = """
from pathlib import Path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace

def generate_launch_description():
    program = str(Path(__file__).with_name("greeter.py"))
    word = {"word": LaunchConfiguration("word")}
    quiet = Node(executable=program, namespace="left", parameters=[word])
    loud = Node(executable=program, parameters=[word, {"volume": 9}],
                remappings=[("greeting", "/hall")])
    then = GroupAction([PushRosNamespace("right"), loud])
    return LaunchDescription([
        DeclareLaunchArgument("word", default_value="Hello"), quiet,
        RegisterEventHandler(OnProcessExit(target_action=quiet, on_exit=[then])),
    ])
"""

install()  # import rclpy, launch, std_msgs, … mean Navette
with tempfile.TemporaryDirectory() as folder:
    Path(folder, "greeter.py").write_text(GREETER)
    file = Path(folder, "greet.launch.py")
    file.write_text(LAUNCH)
    with redirect_stdout(io.StringIO()) as output:
        code = launch(file, {"word": "Servus"})
print(*(line for line in output.getvalue().splitlines() if "] [" not in line), sep="\n")
print("exit code", code)
