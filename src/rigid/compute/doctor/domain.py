"""`rigid doctor`: plays, searches and judges what the verdicts on a new domain are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rigid.compute.calibration import provisional_range
from rigid.compute.doctor.steps import (
    LAMBDAS,
    data_verdict,
    given_episodes,
    players_of,
    protocol_verdict,
    search_verdicts,
)
from rigid.compute.listening import Listener
from rigid.compute.measurement import measure_robot
from rigid.compute.playing import play_with
from rigid.compute.preparation import settings_for
from rigid.compute.robot_run import Order
from rigid.compute.run.provenance import command_line, provenance
from rigid.compute.subject import Subject, load_players
from rigid.doctor.features import check_features
from rigid.doctor.reward import Play, check_reward
from rigid.doctor.verdict import TITLES, Verdict, listed, skipped
from rigid.errors import UserError
from rigid.files import check_writable, json_text, write_atomically, writing_to
from rigid.learning.adversary_settings import ALONE, AdversarySettings
from rigid.naturalness.features import choose_features, seen_through
from rigid.presets import PRESETS, Preset
from rigid.tasks.protocol import Task

DOCTOR = replace(
    PRESETS["demo"], name="doctor", episodes=12, sharing=None,
    stamp="a first look: not for publication",
)  # fmt: skip
"""Budget of the search: two seeds, one for each core of a small machine. A network for each λ, as
in the paper: one that many λ share keeps moving, and in a task whose human has little noise of its
own (hand tracking) it leaves what is natural, which is no fault of the task. Ours."""
_PPO = replace(ALONE, minibatch=300)
"""Four gradient steps an epoch on so few steps. Ours."""
_STEPS = 1200
"""Steps of each λ between two updates, at least: 12 episodes of itch scratching. Ours."""
SEARCH, RESULT = "search", "doctor.json"
_OWN = ("pair", "robot", SEARCH, RESULT, "doctor.html")
"""What a directory of an examination may hold."""
_PLAYED = 60
"""Episodes of each human, from the same starts: as many as `demo` scores an adversary on."""


@dataclass(frozen=True)
class Diagnosis:
    """What an examination found."""

    verdicts: tuple[Verdict, ...]
    """One for each step, in their order."""
    about: Mapping[str, Any]
    """Task, robot, human, features, budget."""

    @property
    def failed(self) -> tuple[Verdict, ...]:
        """Steps that fail."""
        return tuple(verdict for verdict in self.verdicts if verdict.status == "fail")

    def describe(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "schema": 1,
            **self.about,
            "passed": not self.failed,
            "verdicts": [verdict.describe() for verdict in self.verdicts],
            "provenance": provenance(command_line()),
        }


def _settings(preset: Preset) -> AdversarySettings:
    """How its adversaries are trained."""
    return replace(settings_for(preset), ppo=_PPO)


def doctor_preset(task: Task) -> Preset:
    """The budget of a task's examination; shorter episodes are more."""
    return replace(DOCTOR, episodes=max(DOCTOR.episodes, -(-_STEPS // task.horizon)))


def check_doctor_place(out: Path) -> None:
    """Refuses a directory that holds something else; makes it where it is missing.

    Raises:
        UserError: It does, or cannot be written.
    """
    with writing_to(out):
        out.mkdir(parents=True, exist_ok=True)
        check_writable(out)
        strange = sorted(entry.name for entry in out.iterdir() if entry.name not in _OWN)
    if strange:
        raise UserError(
            f"{out} holds {listed(strange)}, which no examination made: choose a new directory "
            "with --out"
        )


def examine(subject: Subject, preset: Preset, *, out: Path, listener: Listener) -> Diagnosis:
    """Takes every step and writes `doctor.json` into `out`; what was searched before goes on.

    Args:
        subject: Task, robot, human, canonical data and features.
        preset: Budget of the search.
        out: Directory of the examination.
        listener: Told of progress.

    Raises:
        UserError: Bad input; a search in `out` that is of something else.
    """
    found = {verdict.step: verdict for verdict in _steps(subject, preset, out, listener)}
    verdicts = tuple(found.get(step) or skipped(step, "a step before it fails") for step in TITLES)
    diagnosis = Diagnosis(
        verdicts,
        {
            "task": subject.task.name,
            "robot": subject.robot,
            "human": subject.human,
            "canonical": subject.canonical,
            "features": choose_features(subject.features, subject.task).label,
            "budget": preset.describe(),
        },
    )
    write_atomically(out / RESULT, json_text(diagnosis.describe(), indent=1).encode())
    return diagnosis


def _steps(subject: Subject, preset: Preset, out: Path, listener: Listener) -> list[Verdict]:
    """The verdicts that could be reached: what needs adversaries comes after all that does not."""
    protocol = protocol_verdict(subject.task)
    if protocol.status == "fail":
        return [protocol]
    features = choose_features(subject.features, subject.task)
    task = seen_through(subject.task, features)
    robot, human = load_players(subject)
    Order(
        subject=subject, preset=preset, settings=_settings(preset), out=out / SEARCH,
        lambdas=LAMBDAS,
    ).check()  # fmt: skip
    given = given_episodes(subject, features, preset)
    listener.say("playing canonical, passive and random humans")
    players = players_of(human, _PLAYED)
    played = {
        kind: play_with(task, robot, actor, np.arange(_PLAYED)) for kind, actor in players.items()
    }
    seen = {kind: episodes.features.swapaxes(0, 1) for kind, episodes in played.items()}
    varies = check_features(
        features.names,
        seen["canonical"] if given.features is None else given.features,
        {kind: values for kind, values in seen.items() if kind != "canonical"},
    )
    play = Play({kind: episodes.reward.swapaxes(0, 1) for kind, episodes in played.items()})
    found = [protocol, varies, check_reward(play)]
    if varies.evidence.get("std"):  # Nothing can be trained on what is not finite.
        found.append(data_verdict(task, robot, human, given, seen["random"], listener))
    failed = [verdict.title for verdict in found if verdict.status == "fail"]
    if failed:
        listener.say(f"no search, since what follows would have to be done again: {failed[0]}")
        return found
    searched = measure_robot(
        replace(subject, return_range=provisional_range(subject)), preset, out=out / SEARCH,
        lambdas=LAMBDAS, settings=_settings(preset), listener=listener,
    )  # fmt: skip
    success = float(np.mean(played["canonical"].summary.success))
    known = None if np.isnan(success) else success
    return [*found, *search_verdicts(searched, play, preset, known)]
