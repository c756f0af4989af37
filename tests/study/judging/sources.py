"""Pair files whose episodes are real physics of six steps."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from rigid.compute.run.checkpoint import save_arrays
from rigid.data.episodes import save_episodes
from rigid.data.pair_file import (
    FoundMember,
    Pair,
    PairFile,
    PairRule,
    RecordedMember,
    RecordingSource,
    Reference,
    RunSource,
    file_hash,
    save_pairs,
)
from rigid.data.recording import record
from rigid.policies.loading import policy_hash
from rigid.study.plan import JudgeStage, PractiseStage, Role, StudyPlan
from rigid.study.records import Participant
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.toys import untrained

STEPS = 6
TASK = ItchScratching(ItchScratchingParameters(horizon=STEPS))
ROBOT, HUMAN = untrained(TASK.robot, seed=1), untrained(TASK.human, seed=2)
STILL = 4
"""The moment of every member."""
KINDS = {"correspondence": "faithfulness", "danger": "danger", "naturalness": "naturalness"}


@cache
def states_of(push: float) -> np.ndarray:
    """An episode in which the human pushes every joint one way, (T + 1, state)."""
    world = TASK.make_world(1, threads=1)
    world.reset(np.array([0]))
    states = [world.snapshot()[0]]
    for _ in range(STEPS):
        world.step(
            np.zeros((1, TASK.robot.action_size)), np.full((1, TASK.human.action_size), push)
        )
        states.append(world.snapshot()[0])
    return np.array(states)


def pushes(pair: int) -> tuple[float, float, float]:
    """How the humans of the first and the second member and of the reference push."""
    return 0.05 * pair, -0.05 - 0.05 * pair, 1.0


def write_pairs(folder: Path, question: str = "danger", count: int = 4) -> Path:
    """Writes a pair file and the run that it needs.

    Of pair i the first member has naturalness 0.9 - i / 100 and adversarialness 0.1, the second one
    0.5 - i / 100 and 0.6 + i / 100.
    """
    run = folder / "run"
    members = []
    for number in range(count):
        first, second, reference = (states_of(push) for push in pushes(number))
        save_arrays(
            run / "adversaries" / f"p{number}" / "episodes.npz",
            {
                "snapshots": np.stack([first, second]),
                "canonical_snapshots": np.stack([reference, reference]),
            },
        )
        kept = {"point": f"p{number}", "seed": 0, "snapshot": STILL, "snapshot_by": "deviation"}
        members.append(
            (
                FoundMember(
                    **kept, shown="worst", episode=0, naturalness=0.9 - number / 100,
                    naturalness_se=None, adversarialness=0.1,
                ),
                FoundMember(
                    **kept, shown="median", episode=1, naturalness=0.5 - number / 100,
                    naturalness_se=None, adversarialness=0.6 + number / 100,
                ),
            )
        )  # fmt: skip
    pairs = [
        Pair(
            run=0, first=first, second=second,
            reference=Reference(point=f"p{number}", shown="worst", seed=1),
        )
        for number, (first, second) in enumerate(members)
    ]  # fmt: skip
    return _save(folder, KINDS[question], pairs)


def write_recorded_pair(folder: Path) -> tuple[Path, np.ndarray]:
    """A pair of which somebody recorded the second member; also what that person did (T, a)."""
    path = write_pairs(folder, "correspondence", count=1)
    found = record(TASK, ROBOT, HUMAN, episodes=2, seed=4, batch=2, provenance={})
    save_episodes(folder / "anna.npz", replace(found, source="recorded"))
    pair = PairFile.model_validate_json(path.read_text()).pairs[0]
    told = pair.second.model_dump(exclude={"origin", "point", "shown"})
    anna = RecordedMember(
        **told | {"episode": 1, "seed": int(found.seeds[1])},
        recording=0, referee_run=0, referee="p0",
    )  # fmt: skip
    recording = RecordingSource(
        path="anna.npz", sha256=file_hash(folder / "anna.npz"), source="recorded"
    )
    changed = pair.model_copy(update={"second": anna})
    return _save(folder, "faithfulness", [changed], (recording,)), found.actions[1]


def _save(
    folder: Path, kind: str, pairs: list[Pair], recordings: tuple[RecordingSource, ...] = ()
) -> Path:
    points = sorted({pair.reference.point for pair in pairs})
    hashes = {
        point: file_hash(folder / "run" / "adversaries" / point / "episodes.npz")
        for point in points
    }
    rule = PairRule(
        alike="naturalness", alike_below=0.1, different=None, different_above=0.0,
        recorded_with_found=False, same_start=True, reuse=False, snapshot="any",
    )  # fmt: skip
    file = PairFile(
        kind=kind, rule=rule, seed=0, eligible=len(pairs), task=dict(TASK.describe()),
        runs=(
            RunSource(
                path="run", robot="elsewhere", robot_sha256=policy_hash(ROBOT),
                episodes_sha256=hashes,
            ),
        ),
        recordings=recordings, pairs=tuple(pairs),
    )  # fmt: skip
    path = folder / f"{kind}.json"
    save_pairs(path, file)
    return path


def plan_of(pairs: Path, question: str = "danger", **changes) -> StudyPlan:
    """One role, rater, who practise and judge."""
    fields = {"question": question, "pairs": pairs, "show": "replay", "count": 4}
    stage = JudgeStage(**fields | changes)
    return StudyPlan(
        title="Judging", robots={"a": "elsewhere"}, demographics=False,
        roles={"rater": Role(participants=4, stages=(PractiseStage(), stage))},
    )  # fmt: skip


def rater(place: int = 0, **changes) -> Participant:
    """Somebody who has consented."""
    fields = {
        "code": f"P{place + 1:02}", "kind": "person", "role": "rater", "external_id": None,
        "status": "active", "consent_version": "1", "sharing": False, "joined": None,
        "demographics": {}, "calibration": {}, "place": place,
    }  # fmt: skip
    return Participant(**fields | changes)
