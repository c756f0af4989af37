"""The short pair of `rigid doctor`: whose it is, and how much it plays."""

from __future__ import annotations

import json
import shutil
from contextlib import nullcontext

import pytest

from rigid.errors import UserError
from rigid.policies.native import CARD_FILE
from rigid.robots import short_pair
from rigid.robots.short_pair import train_short_pair
from tests.robots.quick import Seen
from tests.toys import ToyReach


def showing(name, iterations):
    del name, iterations
    return nullcontext(Seen())


@pytest.mark.parametrize("task", [ToyReach(horizon=11), ToyReach(name="other")])
def test_a_finished_pair_of_another_task_is_refused(pair, tmp_path, task):
    shutil.copytree(pair, tmp_path / "pair")
    with pytest.raises(UserError, match=r"pair/human was trained in another task, or before .*out"):
        train_short_pair(task, tmp_path, showing=showing)


def test_a_finished_robot_of_another_task_is_refused(pair, tmp_path):
    shutil.copytree(pair, tmp_path / "pair")
    shutil.copytree(pair / "human", tmp_path / "robot")
    card = tmp_path / "robot" / CARD_FILE
    card.write_text(json.dumps({**json.loads(card.read_text()), "task": {"name": "older"}}))
    with pytest.raises(UserError, match="robot was trained in another task"):
        train_short_pair(ToyReach(), tmp_path, showing=showing)


def test_a_finished_pair_of_this_task_is_used_again(pair, tmp_path):
    shutil.copytree(pair, tmp_path / "pair")
    found = train_short_pair(ToyReach(), tmp_path, showing=showing)
    robot = tmp_path / "pair" / "robot"  # The toy task hides nothing that it could reveal.
    assert found == (str(robot), str(tmp_path / "pair" / "human"))


def test_where_episodes_are_long_fewer_are_played(tmp_path, monkeypatch):
    asked = []

    def trained(_, settings, **__):
        asked.append(settings.episodes)
        raise KeyboardInterrupt

    monkeypatch.setattr(short_pair, "train_pair", trained)
    for horizon in (100, 400):
        with pytest.raises(KeyboardInterrupt):
            train_short_pair(ToyReach(horizon=horizon), tmp_path, showing=showing)
    assert asked == [48, 12]
