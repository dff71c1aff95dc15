"""Checks of what runs: does time pass, and are the stages alive?"""

from collections.abc import Iterator

from navette.cli.doctor.chain import and_the_robot, robot
from navette.cli.doctor.findings import Finding, Level, listed, plural
from navette.cli.doctor.snapshot import Heartbeat, Snapshot
from navette.topics import CLOCK

TIME = "Time"
STAGES = "Stages"

STALE_AFTER_S = 2.0  # four heartbeats: where control stops the robot, too


def check_time(seen: Snapshot) -> Iterator[Finding]:
    """Does somebody tick for those who live in simulated time?"""
    waiting = [name for name, simulated in seen.sim_time.items() if simulated]
    clocks = sorted({e.node_full_name for e in seen.publishers(CLOCK.name)})
    if len(clocks) > 1:
        yield Finding(
            Level.PROBLEM,
            TIME,
            CLOCK.name,
            f"is published by {listed(clocks)}: time jumps to and fro",
            "keep one: a simulator, or a bag played with --clock",
        )
    if waiting and not clocks:
        yield Finding(
            Level.PROBLEM,
            TIME,
            CLOCK.name,
            f"nobody publishes it, and {plural(len(waiting), 'node')} with"
            f" use_sim_time ({listed(waiting)}) stay at time zero",
            "start a simulator or navette bag play --clock; or navette param set"
            f" {sorted(waiting)[0]} use_sim_time false",
        )
    elif waiting and not seen.clock_ticks:
        yield Finding(
            Level.WARNING,
            TIME,
            CLOCK.name,
            f"does not tick; {listed(waiting)} with use_sim_time stand still",
            f"{listed(clocks)} is paused, or hangs",
        )
    elif seen.nodes:
        whose = f"simulated, by {listed(clocks)}" if clocks else "the system's"
        yield Finding(Level.GOOD, TIME, "clock", whose)


def check_stages(seen: Snapshot) -> Iterator[Finding]:
    """Are the stages' heartbeats fresh, and do they say that all is well?"""
    for beat in seen.heartbeats:
        yield _heartbeat(beat, seen)
    if seen.speed_mps is not None:
        data = {"speed_mps": round(seen.speed_mps, 3)}
        yield Finding(Level.NOTE, STAGES, "robot", robot(seen.speed_mps), data=data)


def _why_silent(names: set[str], who: str, seen: Snapshot) -> str:
    if not seen.clock_ticks and any(seen.sim_time.get(name) for name in names):
        return f"{who} waits for /clock, which does not tick"
    return f"{who} hangs, is stopped or cut off"


def _heartbeat(beat: Heartbeat, seen: Snapshot) -> Finding:
    names = {e.node_full_name for e in seen.publishers(beat.topic)}
    who = listed(names)
    data = {"state": beat.state, "age_s": beat.age_s}
    if beat.age_s is None or beat.age_s > STALE_AFTER_S:
        age = "silent" if beat.age_s is None else f"silent for {beat.age_s:.1f} s"
        return Finding(
            Level.PROBLEM,
            STAGES,
            beat.topic,
            f"{age}, last state {beat.state or 'unknown'}{and_the_robot(seen)}",
            f"{_why_silent(names, who, seen)}: nobody drives on old words",
            data,
        )
    level = Level.GOOD if beat.level == 0 else Level.WARNING
    text = beat.state or "no state"
    if beat.state.startswith("stale_"):
        text += f": nothing new from that side{and_the_robot(seen)}"
    return Finding(level, STAGES, beat.topic, text, data=data)
