"""Check the clock and the status of the stages."""

from collections.abc import Iterator

from navette.cli.doctor.chain import motion, robot_clause
from navette.cli.doctor.findings import Diagnosis, Rating, listed, plural
from navette.cli.doctor.snapshot import Snapshot, StageStatus
from navette.msgs.topics import CLOCK
from navette.runtime.stage.status import spelled

TIME = "Time"
STAGES = "Stages"

STALE_AFTER_S = 2.0  # four status periods; the control stage also stops the robot then


def check_time(seen: Snapshot) -> Iterator[Diagnosis]:
    """Check that /clock runs if nodes use simulated time."""
    simulated = [name for name, uses_sim_time in seen.sim_time.items() if uses_sim_time]
    clocks = sorted({e.node_full_name for e in seen.publishers(CLOCK.name)})
    if len(clocks) > 1:
        yield Diagnosis(
            Rating.PROBLEM,
            TIME,
            CLOCK.name,
            f"is published by {listed(clocks)}: time jumps back and forth",
            "keep one: a simulator, or a bag played with --clock",
        )
    if simulated and not clocks:
        yield Diagnosis(
            Rating.PROBLEM,
            TIME,
            CLOCK.name,
            f"has no publisher, and {plural(len(simulated), 'node')} with"
            f" use_sim_time ({listed(simulated)}) stay at time zero",
            "start a simulator or navette bag play --clock; or navette param set"
            f" {sorted(simulated)[0]} use_sim_time false",
        )
    elif simulated and not seen.clock_ticks:
        yield Diagnosis(
            Rating.WARNING,
            TIME,
            CLOCK.name,
            f"does not advance; {listed(simulated)} with use_sim_time are frozen",
            f"{listed(clocks)} is paused or hangs",
        )
    elif seen.nodes:
        source = f"simulated, by {listed(clocks)}" if clocks else "system time"
        yield Diagnosis(Rating.GOOD, TIME, "clock", source)


def check_stages(seen: Snapshot) -> Iterator[Diagnosis]:
    """Check that the status of every stage is fresh and good."""
    for beat in seen.heartbeats:
        yield _heartbeat(beat, seen)
    if seen.speed_mps is not None:
        data = {"speed_mps": round(seen.speed_mps, 3)}
        yield Diagnosis(Rating.NOTE, STAGES, "robot", motion(seen.speed_mps), data=data)


def _why_stale(names: set[str], seen: Snapshot) -> str:
    if not seen.clock_ticks and any(seen.sim_time.get(name) for name in names):
        return f"{listed(names)} waits for /clock, which does not advance"
    return f"{listed(names)} hangs, is stopped or disconnected"


def _heartbeat(beat: StageStatus, seen: Snapshot) -> Diagnosis:
    names = {e.node_full_name for e in seen.publishers(beat.topic)}
    data = {"state": beat.state, "age_s": beat.age_s}
    if beat.age_s is None or beat.age_s > STALE_AFTER_S:
        age = "" if beat.age_s is None else f" for {beat.age_s:.1f} s"
        return Diagnosis(
            Rating.PROBLEM,
            STAGES,
            beat.topic,
            f"no status{age}, last state {beat.state or 'unknown'}{robot_clause(seen)}",
            f"{_why_stale(names, seen)}; other stages ignore old data",
            data,
        )
    level = Rating.GOOD if beat.level == 0 else Rating.WARNING
    text = spelled(beat.state) or "no state"
    if beat.state.startswith("stale_"):
        text += f": this input is too old{robot_clause(seen)}"
    return Diagnosis(level, STAGES, beat.topic, text, data=data)
