"""The motions that a study shows, made once and kept beside its data."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.protocol import Policy
from rigid.study.judging.canonical_motions import CanonicalOrder, canonical_replays, shows
from rigid.study.judging.clip_names import ClipName
from rigid.study.judging.kept import KeptClips
from rigid.study.judging.motion import motion_text
from rigid.study.judging.pair_motions import PairMotions
from rigid.study.judging.questionnaire import judge_stages, questionnaire
from rigid.study.judging.trials import Trial, clips_of, preview_trials, trials_for
from rigid.study.plan import JudgeStage, StudyPlan, WatchStage
from rigid.study.records import Participant
from rigid.tasks.protocol import Task
from rigid.tasks.registry import make_task

Say = Callable[[str], None]
_STRIDE = 10
"""Motions between two words of progress: each takes up to seconds, since its forces are simulated
again."""


@dataclass(frozen=True)
class Clips:
    """Replays as JSON text (`rigid.report.payload.Replay`, without how the episode ended)."""

    plan: StudyPlan
    canonical: tuple[bytes, ...]
    """The episodes to watch, `c0`, `c1`, …: as many as the longest `watch` stage shows."""
    judged: Mapping[ClipName, bytes]

    def find(self, participant: Participant, key: str) -> bytes | None:
        """A clip by the key that this participant's page was given; None for any other key."""
        stages = enumerate(self.plan.roles[participant.role].stages)
        judged = [place for place, stage in stages if isinstance(stage, JudgeStage)]
        return self._watched(participant.role, key) or self._of(
            (trials_for(self.plan, place, participant) for place in judged), key
        )

    def preview(self, role: str, stage: int, key: str) -> bytes | None:
        """A clip by the key that `preview_trials` gave; None for any other key."""
        return self._of([preview_trials(self.plan, role, stage)], key)

    def _watched(self, role: str, key: str) -> bytes | None:
        shown = watched(self.plan, role)
        number = re.fullmatch(r"c(\d{1,4})", key)
        return self.canonical[int(number[1])] if number and int(number[1]) < shown else None

    def _of(self, stages: Iterable[tuple[Trial, ...]], key: str) -> bytes | None:
        for trial in chain.from_iterable(stages):
            for role, known in trial.keys.items():
                if known == key:
                    return self.judged[trial.clips[role]]
        return None


def watched(plan: StudyPlan, role: str) -> int:
    """How many canonical episodes people of a role watch at most."""
    stages = plan.roles[role].stages
    return max((stage.episodes for stage in stages if isinstance(stage, WatchStage)), default=0)


def prepare_clips(
    plan: StudyPlan,
    data: Path,
    *,
    task: Task | None = None,
    robots: Mapping[str, Policy] | None = None,
    say: Say = lambda _: None,
) -> Clips:
    """Makes the motions of all questionnaires and `watch` stages, or takes them from `data/clips`.

    Whoever has them all in `data/clips` needs neither runs nor recordings.

    Args:
        plan: The study's.
        data: Its folder.
        task: The plan's, if it is there already.
        robots: Likewise, by their keys.
        say: Told of progress.

    Raises:
        UserError: Episodes that a pair names are missing or have changed, or a robot is.
    """
    task = task or make_task(plan.task)
    robots = robots or {key: load_policy(spec, task=task) for key, spec in plan.robots.items()}
    kept = KeptClips(data / "clips")
    canonical = _canonical(plan, task, robots, kept, say)
    judged: dict[ClipName, bytes] = {}
    for stage in judge_stages(plan):
        judged.update(_judged(stage, task, robots, kept, say))
    return Clips(plan, canonical, judged)


def _judged(
    stage: JudgeStage, task: Task, robots: Mapping[str, Policy], kept: KeptClips, say: Say
) -> Mapping[ClipName, bytes]:
    """Every motion of a questionnaire."""
    asks = questionnaire(stage)
    by_hash = {policy_hash(robot): robot for robot in robots.values()}
    motions = PairMotions(asks, task, by_hash.get)
    names = sorted(clips_of(asks), key=str)
    made = {name: kept.get(motions.shows(name)) for name in names}
    missing = [name for name, clip in made.items() if clip is None]
    if missing:
        motions.check()
    for number, name in enumerate(missing):
        if number % _STRIDE == 0:
            say(f"{stage.pairs}: motion {number + 1} of {len(missing)}")
        shown = motions.shows(name)
        clip = kept.get(shown)  # Pairs share references.
        if clip is None:
            clip = motion_text(motions.replay(name), moment=name.moment)
            kept.put(shown, clip)
        made[name] = clip
    return {name: clip for name, clip in made.items() if clip is not None}


def _canonical(
    plan: StudyPlan, task: Task, robots: Mapping[str, Policy], kept: KeptClips, say: Say
) -> tuple[bytes, ...]:
    """What people watch: episodes of the study's robots in turn."""
    wanted = max((watched(plan, role) for role in plan.roles), default=0)
    by_robot = []
    for place, (key, spec) in enumerate(plan.robots.items()):
        count = len(range(place, wanted, len(robots)))
        order = CanonicalOrder(task, spec, robots[key], count, plan.seed)
        by_robot.append(_of_robot(order, kept, say))
    return tuple(by_robot[number % len(robots)][number // len(robots)] for number in range(wanted))


def _of_robot(order: CanonicalOrder, kept: KeptClips, say: Say) -> list[bytes]:
    if not order.episodes:
        return []
    about = [{**shows(order), "number": number} for number in range(order.episodes)]
    there = [clip for clip in map(kept.get, about) if clip is not None]
    if len(there) == order.episodes:
        return there
    say(f"robot {order.spec}: {order.episodes} canonical episodes to watch")
    clips = [motion_text(replay) for replay in canonical_replays(order)]
    for shown, clip in zip(about, clips, strict=True):
        kept.put(shown, clip)
    return clips
