"""From a plan and a directory to a service: everything that is loaded before anybody comes."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from rigid.errors import UserError
from rigid.policies.protocol import Policy
from rigid.report.build import embed_json
from rigid.study.judging import prepare_clips
from rigid.study.judging.questionnaire import judge_stages, questionnaire
from rigid.study.plan import StudyPlan
from rigid.study.registration import register_study
from rigid.study.service.context import Service
from rigid.study.service.engine import Engine
from rigid.study.service.exports import mend_exports
from rigid.study.store import Store
from rigid.tasks.protocol import Task

_STUDY = resources.files("rigid.study")
_STATIC = resources.files("rigid.report") / "static"


def open_service(
    store: Store,
    plan: StudyPlan,
    task: Task,
    robots: Mapping[str, Policy],
    *,
    data: Path,
    address: str,
    say: Callable[[str], None] = lambda _: None,
) -> Service:
    """A study, ready to be served.

    Args:
        store: Open for writing.
        plan: What the store was opened with.
        task: The plan's.
        robots: The plan's, by key.
        data: Where the store lies.
        address: How participants reach the server.
        say: Told of what takes long.

    Raises:
        UserError: Something that the plan names is missing, or has changed since somebody
            consented; nobody can play the task; the front end was not bundled.
    """
    static, texts = front_end(), texts_of(plan.language)
    engine = Engine(task, robots)
    engine.episode(next(iter(robots)), plan.seed).begin()  # Refuses tasks that nobody can play.
    for stage in judge_stages(plan):
        questionnaire(stage)  # Pairs that are missing are told before anything is stored.
    mend_exports(data)
    register_study(store, plan, task=task, robots=robots)
    clips = prepare_clips(plan, data, task=task, robots=robots, say=say)
    return Service(
        plan=plan, store=store, engine=engine, clips=clips, data=data, static=static, texts=texts,
        scene=embed_json(task.scene()).encode(), address=address,
    )  # fmt: skip


def front_end() -> dict[str, bytes]:
    """What the browser is given, by name.

    Raises:
        UserError: It was not bundled.
    """
    try:
        bundled = {name: (_STATIC / name).read_bytes() for name in ("study.js", "study.css")}
    except FileNotFoundError:
        raise UserError(
            "the front end of studies is not bundled. In a checkout, run `npm --prefix web ci && "
            "npm --prefix web run build`, or install the package again"
        ) from None
    return {**bundled, "page.html": (_STUDY / "page.html").read_bytes()}


def texts_of(language: str) -> Mapping[str, Any]:
    """The words of a language.

    Raises:
        UserError: There are none.
    """
    folder = _STUDY / "texts"
    names = (entry.name for entry in folder.iterdir())
    known = sorted(name.removesuffix(".json") for name in names if name.endswith(".json"))
    if language not in known:
        raise UserError(
            f"language {language!r} has no texts: choose one of {', '.join(known)}, or translate "
            "src/rigid/study/texts/en.json"
        )
    found: Mapping[str, Any] = json.loads((folder / f"{language}.json").read_text(encoding="utf-8"))
    return found
