"""Recordings, YAML and XML of others: a value or a named error, in bounded time.

Every input goes through all readers of its kind: a recording is opened, summarised,
checked, read, merged, copied to each format and played to its end.
"""

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from bag_samples import write_sample
from fuzz import bag_corpus
from fuzz.limits import rounds, within
from navette.bags import BagReader, open_bag
from navette.bags.checking import check_bag
from navette.bags.editing import copy, join
from navette.bags.opening import is_bag
from navette.bags.play import PlayOptions
from navette.bags.play.merged import MergedSource, TolerantSource
from navette.bags.play.player import Player, PlayState
from navette.bags.summary import summarise
from navette.bags.writing import open_writer
from navette.errors import NavetteError
from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch.frontend import parse_launch_text
from navette.ros2.workspace import read_manifest
from navette.runtime import read_parameter_file
from navette.sim.occupancy_map import read_map
from navette.sim.xml_tree import parse_xml

pytestmark = pytest.mark.long

MUTANTS = 40
_MOST_PLAYED = 5000


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bag_corpus, "FRACTION", 16)
        return bag_corpus.make(tmp_path_factory.mktemp("corpus"))


@pytest.mark.parametrize("name", bag_corpus.BAGS)
def test_the_corpus_of_recordings(
    corpus: dict[str, Path], name: str, tmp_path: Path
) -> None:
    with within():
        use_recording(corpus[name], tmp_path)


@pytest.mark.parametrize("name", bag_corpus.TEXTS)
def test_the_corpus_of_texts(corpus: dict[str, Path], name: str) -> None:
    with within():
        use_text(corpus[name])


SAMPLES: dict[str, dict[str, str]] = {
    "zstd.mcap": {},
    "lz4.mcap": {"compression": "lz4"},
    "none.mcap": {"compression": "none"},
    "a.bag": {},
    "bz2.bag": {"compression": "bz2"},
    "a.db3": {},
}


@pytest.mark.parametrize("name", SAMPLES)
def test_mutated_recordings(name: str, tmp_path: Path) -> None:
    data = write_sample(tmp_path / name, 12, **SAMPLES[name]).read_bytes()
    for seed in rounds():
        source = np.random.default_rng([seed, len(name)])
        for number in range(MUTANTS):
            path = tmp_path / f"mutant_{name}"
            path.write_bytes(mutated(data, source))
            with within():
                use_recording(path, tmp_path / "out", seed=number)


@pytest.mark.parametrize("name", ["params.yaml", "a.launch.yaml", "a.launch.xml"])
def test_mutated_texts(name: str, tmp_path: Path) -> None:
    data = TEXTS[name].encode()
    for seed in rounds():
        source = np.random.default_rng([seed, len(name)])
        for _ in range(5 * MUTANTS):
            path = tmp_path / name
            path.write_bytes(mutated(data, source))
            with within():
                use_text(path)


TEXTS = {
    "params.yaml": (
        "/**:\n  ros__parameters:\n    a: 1\n    b: [1.5, 2]\n    c: {d: x}\n"
    ),
    "a.launch.yaml": (
        "launch:\n- arg: {name: robot, default: burger}\n"
        "- node: {pkg: a, exec: b, param: [{name: c, value: 1}]}\n"
    ),
    "a.launch.xml": (
        '<launch><arg name="a" default="1"/>\n<group if="$(var a)">\n'
        '<node pkg="a" exec="b"><param name="c" value="1"/></node></group></launch>'
    ),
}


def mutated(data: bytes, source: np.random.Generator) -> bytes:
    """Return a copy with one to four changes."""
    found = bytearray(data)
    for _ in range(source.integers(1, 5)):
        at, start = source.integers(len(found) + 1, size=2)
        length = source.choice([1, 1, 2, 4, 8, 64])
        match source.integers(6):
            case 0:
                found[at : at + length] = source.bytes(length)
            case 1:
                found[at : at + length] = bytes([source.choice([0, 255])]) * length
            case 2:
                del found[at : at + length]
            case 3:
                found[at:at] = found[start : start + length * 8]
            case 4:
                del found[at:]
            case 5:
                power = int(source.choice([31, 32, 63, 64]))
                found[at : at + 8] = (2**power - 1).to_bytes(8, "little")
    return bytes(found)


def use_recording(path: Path, folder: Path, seed: int = 0) -> None:
    """Do everything with a recording; only NavetteError is allowed to leave it."""
    folder.mkdir(exist_ok=True)
    is_bag(path)
    attempt(lambda: check_bag(path, decode=True))
    attempt(lambda: use_reader(path, folder, seed))


def use_reader(path: Path, folder: Path, seed: int) -> None:
    with open_bag(path) as reader:
        attempt(lambda: summarise(reader))
        attempt(lambda: play(reader))
        targets = ("a.mcap", "a.db3", "a.bag")
        attempt(lambda: write_copy(reader, folder / targets[seed % len(targets)]))
    with join([path, path]) as reader:
        attempt(lambda: write_copy(reader, folder / "a.mcap"))


def write_copy(reader: BagReader, target: Path) -> None:
    writer = open_writer(target, overwrite=True)
    count = copy(reader, writer, on_damage=lambda damage: None)
    if target.suffix == ".mcap":
        report = check_bag(target)
        assert report.is_sound, report.findings
        assert report.messages == count


def play(reader: BagReader) -> None:
    """Play to the end, then seek beyond both ends."""
    source = TolerantSource(reader, on_damage=lambda damage: None)
    player = Player(MergedSource([source, source]), PlayOptions())
    assert player.end_ns < 2**31 * 10**9, "a time that /clock can hold"
    now_ns = 0
    player.start(now_ns)
    for _ in range(_MOST_PLAYED):
        player.pop_jump()
        due_ns = player.due_ns()
        if due_ns is None or player.state is PlayState.ENDED:
            break
        now_ns = max(now_ns, due_ns)
        player.take(now_ns)
    for position in (-(2**63), 2**64, reader.start_ns):
        player.seek(now_ns, position)
        player.step(now_ns)
    player.close()


def use_text(path: Path) -> None:
    """Read a text with every reader of such files."""
    data = path.read_bytes()
    with contextlib.suppress(yaml.YAMLError):
        load_yaml(data)
    for read in readers_of(path, data):
        attempt(read)


def readers_of(path: Path, data: bytes) -> Iterator[Callable[[], Any]]:
    yield lambda: read_parameter_file(path)
    yield lambda: read_map(path)
    yield lambda: parse_launch_text(data, path, ".yaml")
    yield lambda: parse_launch_text(data, path, ".xml")
    yield lambda: parse_xml(path)
    yield lambda: read_manifest(path)


def attempt(work: Callable[[], object]) -> None:
    """Run a step; a named error is an answer, any other exception a fault."""
    with contextlib.suppress(NavetteError):
        work()
