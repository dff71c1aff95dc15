"""An action: a task with feedback and a result that can be cancelled.

Prints::

    feedback: 2 m to go
    feedback: 1 m to go
    feedback: 0 m to go
    STATUS_SUCCEEDED after 3 s
    feedback: 9 m to go
    feedback: 8 m to go
    STATUS_CANCELED after 2 s
"""

import tempfile
from pathlib import Path

import navette
from navette.msgs import get_interface, load_interfaces
from navette.msgs.action_msgs.msg import GoalStatus

DEFINITION = "int32 metres\n---\nint32 seconds\n---\nint32 left"

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "action" / "Roll.action"
    file.parent.mkdir()
    file.write_text(DEFINITION)
    load_interfaces("roll_msgs", folder)
    Roll = get_interface("roll_msgs/action/Roll")


class Roller(navette.Node):
    def __init__(self):
        super().__init__("roller")
        self.second = self.create_rate(1.0)
        allow = navette.CancelResponse.ACCEPT
        navette.ActionServer(
            self, Roll, "roll", self.roll, cancel_callback=lambda goal: allow
        )

    def roll(self, goal):
        for seconds in range(1, goal.request.metres + 1):
            self.second.sleep()
            if goal.is_cancel_requested:
                goal.canceled()
                return Roll.Result(seconds=seconds - 1)
            goal.publish_feedback(Roll.Feedback(left=goal.request.metres - seconds))
        goal.succeed()
        return Roll.Result(seconds=goal.request.metres)


def show(message):
    print(f"feedback: {message.feedback.left} m to go")


async def drive(client, metres, cancel_after_s=None):
    goal = await client.send_goal_async(Roll.Goal(metres=metres), show)
    if cancel_after_s is not None:
        driver.create_timer(cancel_after_s, goal.cancel_goal_async)
    answer = await goal.get_result_async()
    names = {v: n for n, v in vars(GoalStatus).items() if n.startswith("STATUS_")}
    print(f"{names[answer.status]} after {answer.result.seconds} s")


with navette.init(clock=navette.VirtualClock()):
    roller, driver = Roller(), navette.Node("driver")
    client = navette.ActionClient(driver, Roll, "roll")
    executor = navette.MultiThreadedExecutor()
    executor.add_node(roller)
    executor.add_node(driver)
    executor.spin_until_future_complete(executor.create_task(drive(client, 3)))
    task = executor.create_task(drive(client, 10, cancel_after_s=2.5))
    executor.spin_until_future_complete(task)
