"""Scripted players in real physics appear on the frontier's plot, and are called what they are."""

from __future__ import annotations

import io
import re

import pytest

from rigid.policies.loading import load_policy
from rigid.report.figures import inline_figure
from rigid.study.analysis.figures import people_figure
from rigid.study.analysis.placing import place
from rigid.study.analysis.players import players_of
from rigid.study.play.episode import PlayedEpisode
from rigid.study.play.scripts import script
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.study.analysis.planted import everybody, person, robot
from tests.study.toys import toy_record

SCRIPTS = ("extend", "retreat", "tremble")


@pytest.fixture(scope="module")
def task():
    return ItchScratching(ItchScratchingParameters(horizon=6))


def played(task, policy, code, name, number):
    """An episode of a script, as a pilot stores it."""
    episode, mover = PlayedEpisode(task, policy, seed=number), script(name)
    frame = episode.begin()
    while not frame.done:
        target = mover.target(frame.step, frame.hand, episode)
        frame = episode.advance(target, age=0.0, at=0.1 * frame.step)
    end = episode.finish()
    return toy_record(
        task, code, number, arrays=end.arrays, episode_return=end.episode_return,
        success=end.success, device="scripted", about_device={"pilot": True, "script": name},
    )  # fmt: skip


def test_extend_retreat_and_tremble_stand_on_the_plot_labelled_as_scripted(task):
    policy = load_policy("builtin:vanilla", task=task, agent="robot")
    records = [
        played(task, policy, f"S{place}", name, number)
        for place, name in enumerate(SCRIPTS) for number in range(2)
    ]  # fmt: skip
    measured = robot(task=task)
    placed = place(measured, players_of(records, everybody(records, {"S0", "S1", "S2"})))
    assert all(one.unplaced is None and one.player.scripted for one in placed)
    drawn = io.StringIO()
    with inline_figure(drawn, size=(6, 4)) as axis:
        people_figure(measured, placed, {})(axis)
    words = re.findall(r"<text[^>]*>([^<]*)</text>", drawn.getvalue())
    assert {*SCRIPTS, "scripted, no person"} <= {word.strip() for word in words}
    assert not any("novice" in word for word in words)


def test_a_person_of_a_device_without_claim_is_said_to_be_so():
    records = [toy_record(robot().task, "P01", n, device="touch") for n in range(2)]
    placed = place(robot(), players_of(records, {"P01": person("P01")}))
    drawn = io.StringIO()
    with inline_figure(drawn, size=(6, 4)) as axis:
        people_figure(robot(), placed, {"touch": False})(axis)
    assert "novice, touch (no claim)" in drawn.getvalue()
