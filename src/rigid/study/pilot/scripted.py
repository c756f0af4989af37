"""A scripted participant: does whatever the server says comes next, until all is done."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rigid.study.judging import Trial, trials_for
from rigid.study.judging.questions import HIGHEST, SIDES, Side, asked
from rigid.study.pilot.hand import play_stage
from rigid.study.pilot.page import Page
from rigid.study.plan import JudgeQuestion, StudyPlan
from rigid.study.players import Players
from rigid.study.store import Store

_State = Mapping[str, Any]
"""Where the participant stands and what comes next, or a clip."""


@dataclass
class Scripted:
    """Who they are, and how they go about it."""

    code: str
    role: str
    script: str
    """How the hand is moved: one of `rigid.study.play.scripts.SCRIPT_NAMES`."""
    page: Page
    plan: StudyPlan
    players: Players
    store: Store
    """Open for reading: scripts know where an episode starts, which people see."""
    tick: Callable[[], None]
    """Called for each thing that is done: an episode watched or played, a trial answered."""
    rng: np.random.Generator = field(default_factory=np.random.default_rng)

    async def take_part(self) -> None:
        """From the consent to the last page.

        Raises:
            UserError: The server refuses something, or nothing goes on.
        """
        await self.page.open()
        state = await self._get("state")
        while state["stage"]["kind"] not in {"done", "stopped"}:
            state = await self._stage(state["stage"])

    async def _stage(self, stage: Mapping[str, Any]) -> _State:
        """Does one stage; the state after it."""
        match stage["kind"]:
            case "consent":
                said = {"version": stage["version"], "agreed": True, "sharing": stage["sharing"]}
                return await self._post("consent", said)
            case "demographics":
                given = {
                    question["id"]: random_fact(question, self.rng)
                    for question in stage["questions"]
                }
                return await self._post("demographics", given)
            case "watch":
                return await self._watch(stage)
            case "judge":
                return await self._judge(stage)
        await play_stage(self, of=stage["of"] - stage["done"])
        return await self._get("state")

    async def _watch(self, stage: Mapping[str, Any]) -> _State:
        state: _State = {}
        for episode in stage["episodes"][stage["seen"] :]:
            await self._get(f"clip/{episode}")
            state = await self._post("watched", {"stage": stage["index"], "episode": episode})
            self.tick()
        return state

    async def _judge(self, stage: Mapping[str, Any]) -> _State:
        state: _State = {}
        who = self.store.participant(self.code)
        known = {trial.id: trial for trial in trials_for(self.plan, stage["index"], who)}
        for trial in stage["trials"]:
            for motion in ("left", "right", "reference"):
                if motion in trial:
                    await self._get(f"clip/{trial[motion]}")
            itself = reference_side(known[trial["id"]])
            responses = random_answers(stage["question"], itself, self.rng)
            state = await self._post("answer", {
                "stage": stage["index"], "trial": trial["id"], "responses": responses,
                "rt": round(float(self.rng.uniform(2, 20)), 1),
            })  # fmt: skip
            self.tick()
        return state

    async def _get(self, name: str) -> _State:
        found: _State = await self.page.get(name)
        return found

    async def _post(self, name: str, message: Mapping[str, Any]) -> _State:
        found: _State = await self.page.post(name, message)
        return found


def reference_side(trial: Trial) -> Side | None:
    """Where the reference itself stands in an attention check; None in any other trial."""
    if trial.pair is not None:
        return None
    return "left" if trial.shown_left == "second" else "right"


def random_answers(
    question: JudgeQuestion, itself: Side | None, rng: np.random.Generator
) -> dict[str, Any]:
    """Answers to a trial at random, but right ones to attention checks: scripts pay attention.

    Args:
        question: Of the questionnaire.
        itself: `reference_side` of the trial.
        rng: Draws them.
    """
    if question == "correspondence":
        return {question: itself or str(rng.choice(SIDES))}
    answers = {name: int(rng.integers(HIGHEST)) for name in asked(question)}
    best = {f"naturalness-{itself}": HIGHEST, f"goal-{itself}": HIGHEST, f"danger-{itself}": 0}
    return {name: best.get(name, answer) for name, answer in answers.items()}


def random_fact(question: Mapping[str, Any], rng: np.random.Generator) -> Any:
    """What somebody who is nobody tells of themselves; None skips a question."""
    if "options" in question:
        return str(rng.choice(question["options"]))
    ends = question.get("number") or question.get("scale")
    return int(rng.integers(ends["min"], ends["max"] + 1)) if ends else None
