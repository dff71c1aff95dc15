"""Assets, HTTP responses and the access policy."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest
from viewer_fakes import FakeDocuments

from navette.errors import ParameterError, UnknownNameError
from navette.viewer.assets import AssetFolders
from navette.viewer.frames import WireParameter
from navette.viewer.layout import build_layout
from navette.viewer.page_files import PageFile, read_page
from navette.viewer.parameters import from_wire, split_name, to_wire
from navette.viewer.web import AccessPolicy, Site

LOCAL = AccessPolicy("127.0.0.1", ("https://app.foxglove.dev",))
APP = AccessPolicy("127.0.0.1", ("file://",))
OPEN = AccessPolicy("0.0.0.0", (), ("robot.example.org",))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    served = tmp_path / "served"
    (served / "meshes").mkdir(parents=True)
    (served / "meshes" / "wheel one.stl").write_bytes(b"solid")
    (tmp_path / "secret").write_text("secret")
    (served / "link").symlink_to(tmp_path / "secret")
    return served


def test_assets_are_read_below_their_folder(folder: Path) -> None:
    assets = AssetFolders({"navette": folder})
    assert assets.read("package://navette/meshes/wheel%20one.stl") == b"solid"


@pytest.mark.parametrize(
    "uri",
    [
        "file:///etc/passwd",
        "http://navette/meshes/wheel%20one.stl",
        "package://other/meshes/wheel%20one.stl",
        "package://navette/../secret",
        "package://navette/%2e%2e/secret",
        "package://navette/meshes/../../secret",
        "package://navette//etc/passwd",
        "package://navette/..\\secret",
        "package://navette/link",
        "package://navette/meshes",
        "package://navette/",
        "package://navette/\0",
        "package://navette",
        "package://[",
        "",
        "meshes/wheel one.stl",
    ],
)
def test_other_uris_are_refused(folder: Path, uri: str) -> None:
    with pytest.raises(UnknownNameError, match=r"known: package://navette/…"):
        AssetFolders({"navette": folder}).read(uri)


@pytest.mark.parametrize(
    ("policy", "host", "origin", "passes"),
    [
        (LOCAL, "127.0.0.1:8765", None, True),
        (LOCAL, "localhost:8765", "http://localhost:8765", True),
        (LOCAL, "localhost:8765", "http://127.0.0.1:8765", False),
        (LOCAL, "[::1]:8765", None, True),
        (LOCAL, "LOCALHOST", None, True),
        (LOCAL, None, None, True),
        (LOCAL, "evil.example:8765", None, False),
        (LOCAL, "127.0.0.1.evil.example", None, False),
        (LOCAL, "192.168.1.5:8765", None, False),
        (LOCAL, "", None, False),
        (LOCAL, "127.0.0.1:8765", "https://app.foxglove.dev", True),
        (LOCAL, "127.0.0.1:8765", "http://localhost:3000", False),
        (LOCAL, "127.0.0.1:8765", "http://127.0.0.1:3000", False),
        (LOCAL, "127.0.0.1:8765", "file://", False),
        (APP, "127.0.0.1:8765", "file://", True),
        (LOCAL, "127.0.0.1:8765", "https://evil.example", False),
        (LOCAL, "127.0.0.1:8765", "https://localhost.evil.example", False),
        (LOCAL, "127.0.0.1:8765", "null", False),
        (LOCAL, "127.0.0.1:8765", "http://[", False),
        (OPEN, "192.168.1.5:8765", "http://192.168.1.5:8765", True),
        (OPEN, "robot.local:8765", None, True),
        (OPEN, "jackal:8765", None, True),
        (OPEN, "robot.example.org", "https://robot.example.org", True),
        (OPEN, "evil.example:8765", "http://evil.example:8765", False),
        (OPEN, "192.168.1.5:8765", "http://evil.example", False),
        (AccessPolicy("0.0.0.0", ("*",)), "jackal", "https://anything.example", True),
    ],
)
def test_foreign_hosts_and_origins_are_refused(
    policy: AccessPolicy, host: str | None, origin: str | None, passes: bool
) -> None:
    refusal = policy.host_refusal(host) or policy.origin_refusal(origin, host)
    assert bool(refusal) is not passes
    if refusal:
        assert "allowed_" in refusal


def test_the_page_has_all_files_below_its_folder(tmp_path: Path) -> None:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<html>")
    (tmp_path / "assets" / "a.js").write_text("1")
    (tmp_path / "notes.bak").write_text("no")
    files = read_page(tmp_path)
    assert set(files) == {"/", "/index.html", "/assets/a.js"}
    assert files["/assets/a.js"].content_type.startswith("text/javascript")
    assert gzip.decompress(files["/"].compressed) == files["/"].body


def test_a_file_is_compressed_for_clients_that_accept_it() -> None:
    long = PageFile("text/javascript", b"1" * 1000)
    site = Site({"/a.js": long}, FakeDocuments())
    plain = site.answer("GET", "/a.js")
    packed = site.answer("GET", "/a.js", "br, gzip")
    assert "Content-Encoding" not in plain.headers
    assert packed.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(packed.body) == plain.body


def test_the_site_has_three_pages_and_its_scripts() -> None:
    html = PageFile("text/html", b"<html>")
    script = PageFile("text/javascript", b"1")
    site = Site({"/": html, "/a.js": script}, FakeDocuments())
    page = site.answer("GET", "/")
    assert (page.status, page.body) == (200, b"<html>")
    assert "default-src 'none'" in page.headers["Content-Security-Policy"]
    layout = site.answer("GET", "/layout.json?x=1")
    assert json.loads(layout.body) == {"layout": 1}
    assert json.loads(site.answer("GET", "/health").body) == {"status": "ok"}
    assert site.answer("GET", "/a.js").body == b"1"
    assert site.answer("GET", "/../etc/passwd").status == 404
    assert site.answer("GET", "").status == 404
    assert site.answer("POST", "/").status == 405
    assert site.answer("HEAD", "/").body == b""


def test_the_layout_holds_its_panels_together() -> None:
    layout = build_layout("sim_world", "robot")
    json.dumps(layout, allow_nan=False)
    configured = set(layout["configById"])

    def panels(tree: object) -> set[str]:
        if isinstance(tree, str):
            return {tree}
        assert isinstance(tree, dict)
        return panels(tree["first"]) | panels(tree["second"])

    shown = panels(layout["layout"])
    for name in sorted(shown):
        for tab in layout["configById"][name].get("tabs", ()):
            shown |= panels(tab["layout"])
    assert shown == configured
    drive = layout["configById"]["3D!drive"]
    assert drive["followTf"] == "sim_world"
    assert drive["publish"]["pointTopic"] == "/goal_point"
    assert "://" not in json.dumps(layout), "the layout needs no network"


@pytest.mark.parametrize(
    ("value", "wire"),
    [
        (True, WireParameter("p", True)),
        (3, WireParameter("p", 3)),
        (3.0, WireParameter("p", 3.0, "float64")),
        ("x", WireParameter("p", "x")),
        (b"ABCD", WireParameter("p", "QUJDRA==", "byte_array")),
        ([b"A", b"B"], WireParameter("p", "QUI=", "byte_array")),
        ([1, 2], WireParameter("p", [1, 2])),
        ([], WireParameter("p", [])),
        (np.array([1.0, 2.0]), WireParameter("p", [1.0, 2.0], "float64_array")),
        ((0.5, 2.0), WireParameter("p", [0.5, 2.0], "float64_array")),
        (["a"], WireParameter("p", ["a"])),
        (float("nan"), WireParameter("p", None, "float64")),
        (None, WireParameter("p", None)),
    ],
)
def test_parameters_are_encoded(value: object, wire: WireParameter) -> None:
    assert to_wire("p", value) == wire


@pytest.mark.parametrize(
    ("wire", "current", "value"),
    [
        (WireParameter("p", 3, "float64"), None, 3.0),
        (WireParameter("p", 3), 1.5, 3.0),
        (WireParameter("p", 3.0), 1, 3),
        (WireParameter("p", 3.5), 1, 3.5),
        (WireParameter("p", 3), 1, 3),
        (WireParameter("p", True), 1, True),
        (WireParameter("p", [1, 2]), [0.5], [1.0, 2.0]),
        (WireParameter("p", [1, 2], "float64_array"), None, [1.0, 2.0]),
        (WireParameter("p", [1, 2.5]), None, [1.0, 2.5]),
        (WireParameter("p", [1, 2]), [3], [1, 2]),
        (WireParameter("p", ["a"]), ["b"], ["a"]),
        (WireParameter("p", "QUJDRA==", "byte_array"), None, [b"A", b"B", b"C", b"D"]),
    ],
)
def test_parameters_are_decoded(
    wire: WireParameter, current: object, value: object
) -> None:
    result = from_wire(wire, current)
    assert result == value
    assert type(result) is type(value)


@pytest.mark.parametrize(
    "wire",
    [
        WireParameter("p", "x", "float64"),
        WireParameter("p", ["x"], "float64_array"),
        WireParameter("p", "?", "byte_array"),
        WireParameter("p", 5, "byte_array"),
        WireParameter("p", {"a": 1}),
    ],
)
def test_parameters_that_contradict_themselves_are_refused(wire: WireParameter) -> None:
    with pytest.raises(ParameterError, match="'p'"):
        from_wire(wire, None)


def test_parameter_names_hold_node_and_parameter() -> None:
    assert split_name("/ns/planner.goal.tolerance") == ("/ns/planner", "goal.tolerance")
    assert split_name("planner.method") == ("/planner", "method")
    with pytest.raises(ParameterError, match=r"must be /node\.parameter"):
        split_name("planner")
