"""Tree files: what is read, and what is refused with file, line and element."""

from pathlib import Path

import pytest
from tree_robot import Planted, ScriptedRobot

from navette.errors import FileFormatError
from navette.navigation.missions.params import TREES
from navette.navigation.missions.tree.blackboard import TreeBlackboard
from navette.navigation.missions.tree.catalog import KINDS
from navette.navigation.missions.tree.drawing import file_text
from navette.navigation.missions.tree.tree_file import MAX_NODES, TreeFile


def read(folder: Path, text: str) -> TreeFile:
    path = folder / "tree.xml"
    path.write_text(text)
    file = TreeFile.read(path)
    file.build(ScriptedRobot(), TreeBlackboard())
    return file


def refused(folder: Path, text: str) -> str:
    with pytest.raises(FileFormatError) as caught:
        read(folder, text)
    return str(caught.value)


def whole(inside: str) -> str:
    return (
        '<root BTCPP_format="4">\n<BehaviorTree ID="Main">\n'
        f"{inside}\n</BehaviorTree>\n</root>"
    )


@pytest.mark.parametrize("path", sorted(TREES.glob("*.xml")), ids=lambda p: p.name)
def test_navettes_own_trees_are_valid(path: Path) -> None:
    assert file_text(path)


@pytest.mark.parametrize(
    ("inside", "line", "words"),
    [
        ("<Spni/>", 3, ("unknown node 'Spni'", "did you mean Spin?", "BackUp")),
        ('<Spin spin_dits="1"/>', 3, ("no port 'spin_dits'", "spin_dist")),
        ('<Spin spin_dist="far"/>', 3, ("'far'", "expected number")),
        ('<Spin spin_dist="nan"/>', 3, ("'nan'", "expected number")),
        ("<Repeat>\n<AlwaysSuccess/></Repeat>", 3, ("'num_cycles' is missing",)),
        ("<Sequence>\n</Sequence>", 3, ("0 children", "1 or more")),
        ("<Spin><Wait/></Spin>", 3, ("1 children", "expected 0")),
        ("<Inverter><Wait/>\n<Wait/></Inverter>", 3, ("2 children", "expected 1")),
        ("<RecoveryNode><Wait/></RecoveryNode>", 3, ("1 children", "expected 2")),
        ('<FollowPath path="a path"/>', 3, ("expected an entry",)),
        ('<Action ID="Sequence"/>', 3, ("not of the category Action",)),
        ("<Action/>", 3, ("'ID' is missing",)),
        ('<Sequence>\n<SubTree ID="Other"/></Sequence>', 4, ("unknown tree 'Other'",)),
        ('<SubTree ID="Main"/>', 3, ("'Main' contains itself",)),
        ('<SubTree ID="Main" _autoremap="maybe"/>', 3, ("contains itself",)),
        ("<Wait/><Wait/>", 2, ("2 nodes; expected exactly one",)),
    ],
)
def test_an_invalid_node_is_named_with_its_line(
    tmp_path: Path, inside: str, line: int, words: tuple[str, ...]
) -> None:
    text = refused(tmp_path, whole(inside))
    assert f"tree.xml:{line}:" in text
    for word in words:
        assert word in text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not XML"),
        ("<root>", "not XML"),
        ("<tree/>", "expected <root>"),
        ('<root BTCPP_format="3"/>', "expected '4'"),
        ("<root/>", "0 trees"),
        ('<root main_tree_to_execute="A"/>', "'A' does not exist"),
        ("<root><Spin/></root>", "unknown element"),
        (
            '<root><BehaviorTree ID="A"><Wait/></BehaviorTree>'
            '<BehaviorTree ID="A"><Wait/></BehaviorTree></root>',
            "exists already",
        ),
        ('<root><include path="missing.xml"/></root>', "missing.xml"),
        ('<root><include path="tree.xml"/></root>', "already being read"),
        (
            '<!DOCTYPE root [<!ENTITY a "b">]><root><BehaviorTree ID="A">'
            "<Wait/></BehaviorTree></root>",
            "refused",
        ),
    ],
)
def test_an_invalid_file_is_refused(tmp_path: Path, text: str, words: str) -> None:
    assert words in refused(tmp_path, text)


def test_nesting_and_number_of_nodes_are_limited(tmp_path: Path) -> None:
    deep = "<Inverter>" * 70 + "<Wait/>" + "</Inverter>" * 70
    assert "nested deeper" in refused(tmp_path, whole(deep))
    wide = "<Sequence>" + "<Wait/>" * MAX_NODES + "</Sequence>"
    assert f"more than {MAX_NODES} nodes" in refused(tmp_path, whole(wide))
    # Each tree contains the next one ten times: 10 to the power of 12 nodes.
    trees = "".join(
        f'<BehaviorTree ID="T{n}"><Sequence>'
        + f'<SubTree ID="T{n + 1}"/>' * 10
        + "</Sequence></BehaviorTree>"
        for n in range(12)
    )
    text = (
        f'<root main_tree_to_execute="T0">{trees}'
        '<BehaviorTree ID="T12"><Wait/></BehaviorTree></root>'
    )
    assert f"more than {MAX_NODES} nodes" in refused(tmp_path, text)


def test_both_forms_of_nodes_and_a_model_are_read(tmp_path: Path) -> None:
    read(
        tmp_path,
        '<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main">'
        '<Control ID="PipelineSequence" name="both"><Action ID="Wait"/>'
        '<Condition ID="GoalReached"/><Decorator ID="RateController" hz="2">'
        "<Spin/></Decorator></Control></BehaviorTree>"
        '<TreeNodesModel><Action ID="Mine"/></TreeNodesModel></root>',
    )
    shown = file_text(tmp_path / "tree.xml").splitlines()
    assert shown[0] == "{-} both"
    assert [line.split()[-1] for line in shown[1:]] == [
        "Wait",
        "GoalReached",
        "RateController",
        "Spin",
    ]


def test_trees_of_another_file_are_included(tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "turn.xml").write_text(
        '<root><BehaviorTree ID="Turn"><Spin/></BehaviorTree></root>'
    )
    read(
        tmp_path,
        '<root main_tree_to_execute="Main"><include path="more/turn.xml"/>'
        '<BehaviorTree ID="Main"><SubTree ID="Turn"/></BehaviorTree></root>',
    )
    assert "Spin" in file_text(tmp_path / "tree.xml")


def test_a_subtree_has_its_own_blackboard(tmp_path: Path) -> None:
    path = tmp_path / "tree.xml"
    path.write_text(
        '<root main_tree_to_execute="Main"><BehaviorTree ID="Main"><Sequence>'
        '<SubTree ID="Own" out="{shared}" word="given"/>'
        '<SubTree ID="Own" out="{second}" word="{word}"/>'
        '<SubTree ID="Open" _autoremap="true"/></Sequence></BehaviorTree>'
        '<BehaviorTree ID="Own"><Sequence><SetBlackboard value="{word}" '
        'output_key="out"/><SetBlackboard value="7" output_key="hidden"/></Sequence>'
        '</BehaviorTree><BehaviorTree ID="Open"><Sequence>'
        '<SetBlackboard value="8" output_key="open"/>'
        '<SetBlackboard value="9" output_key="_own"/>'
        '<SetBlackboard value="10" output_key="@top"/></Sequence></BehaviorTree></root>'
    )
    board = TreeBlackboard()
    board.set("word", "from outside")
    root = TreeFile.read(path).build(ScriptedRobot(), board)
    root.tick_once()
    assert board.get("shared") == "given"
    assert board.get("second") == "from outside"
    assert board.get("open") == "8"
    assert board.get("top") == "10"
    assert sorted(board) == ["open", "second", "shared", "top", "word"]


def test_a_wrong_value_of_the_blackboard_names_the_port(tmp_path: Path) -> None:
    tree = Planted(tmp_path, '<Spin spin_dist="{angle}"/>', angle="a lot")
    with pytest.raises(FileFormatError, match=r"tree.xml:3: <Spin>: port 'spin_dist'"):
        tree.tick()


def test_nav2s_nodes_are_known() -> None:
    """The nodes that the trees of Nav2 Jazzy use, and those the issue names."""
    names = """
        Sequence Fallback ReactiveSequence ReactiveFallback SequenceWithMemory Parallel
        Inverter ForceSuccess ForceFailure Repeat RetryUntilSuccessful
        KeepRunningUntilFailure SubTree SetBlackboard Timeout Delay PipelineSequence
        RecoveryNode RoundRobin RateController DistanceController SpeedController
        GoalUpdater GoalUpdatedController GoalUpdated GlobalUpdatedGoal IsPathValid
        IsStuck GoalReached TransformAvailable TimeExpired DistanceTraveled
        InitialPoseReceived WouldAControllerRecoveryHelp WouldAPlannerRecoveryHelp
        WouldASmootherRecoveryHelp AreErrorCodesPresent PlannerSelector
        ControllerSelector SmootherSelector GoalCheckerSelector ProgressCheckerSelector
        ComputePathToPose ComputePathThroughPoses FollowPath SmoothPath Spin BackUp
        DriveOnHeading Wait AssistedTeleop ClearEntireCostmap ClearCostmapAroundRobot
        ClearCostmapExceptRegion ClearCostmapAroundPose RemovePassedGoals
        ReinitializeGlobalLocalization TruncatePath TruncatePathLocal CancelControl
        CancelSpin CancelBackUp CancelWait PathExpiringTimer PathLongerOnApproach
        SingleTrigger NavigateToPose NavigateThroughPoses IsBatteryLow
    """.split()
    assert set(names) <= set(KINDS)


@pytest.mark.parametrize(
    "inside",
    [
        '<Wait _skipIf="battery &lt; 1"/>',
        '<Sequence _while="{go}"><AlwaysSuccess/></Sequence>',
        '<SubTree ID="Main" _onSuccess="done:=1"/>',
        '<Script code="x:=1"/>',
        '<Action ID="Script" code="x:=1"/>',
        '<Decorator ID="Precondition" if="x"><AlwaysSuccess/></Decorator>',
    ],
)
def test_scripts_are_refused_by_name(tmp_path: Path, inside: str) -> None:
    inner = inside.replace('ID="Main"', 'ID="Other"')
    other = '<BehaviorTree ID="Other"><AlwaysSuccess/></BehaviorTree>'
    text = whole(inner).replace("</root>", f"{other}</root>")
    text = text.replace('format="4"', 'format="4" main_tree_to_execute="Main"')
    error = refused(tmp_path, text)
    assert "tree.xml:3" in error
    assert "scripts are not supported; use IfThenElse" in error
