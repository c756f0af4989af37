"""From `discriminators/sSEED.json` to what the page is given."""

from __future__ import annotations

import json

import numpy as np
import pytest

from rigid.compute.search.discriminator_files import Discriminators, file_of
from rigid.errors import UserError
from rigid.frontier.result import Frontier
from rigid.report.discriminators import discriminators
from rigid.report.payload import Discriminators as Shown
from rigid.report.poses import decode_poses
from rigid.tasks.itch_scratching.task import ItchScratching
from tests.toys import ToyReach

IDS = ("s7-r1-l1", "s7-r1-l2")


@pytest.fixture(scope="module")
def task():
    return ItchScratching()


def frontier_in(directory):
    return Frontier(directory, {"auc_by_seed": {"7": 0.5}, "points": []})


def stored(names, *, value=0.1):
    """Two humans, two poses at each of two levels, one pose of the first human."""
    step = tuple(value for _ in names)
    accuracy = {"canonical": (1.0, 0.5), "adversaries": {IDS[0]: 0.25, IDS[1]: None}}
    scores = {"noisy": ((-1.0, -0.5), (0.0, 0.5)), "own": (0.9,)}
    judged = {"discriminator": accuracy, "referee": None, "scores": scores}
    return {
        "format": 1, "levels": (0.0, 1.0), "canonical_episodes": 40, "adversary_episodes": 20,
        "judged": dict.fromkeys(IDS, judged),
        "poses": {
            "names": tuple(names), "levels": (0.0, 1.0), "noisy": ((step, step), (step, step)),
            "own": {IDS[0]: (step,), IDS[1]: ()},
        },
    }  # fmt: skip


def put(directory, found):
    place = file_of(directory, 7)
    place.parent.mkdir(exist_ok=True)
    place.write_text(json.dumps(found))
    return frontier_in(directory)


def test_shares_and_scores_are_those_of_the_file(tmp_path, task):
    found = stored(task.feature_names)
    shown = discriminators(put(tmp_path, found), task)["7"]
    assert set(shown) == set(Shown.__annotations__)
    assert json.loads(json.dumps(shown["judged"])) == json.loads(json.dumps(found["judged"]))
    assert shown["levels"] == (0.0, 1.0)


def test_poses_are_drawn_by_the_task(tmp_path, task):
    shown = discriminators(put(tmp_path, stored(task.feature_names)), task)["7"]["poses"]
    noisy = shown["noisy"]
    arm = task.human_poses(task.feature_names, np.full((1, 22), 0.1))
    assert (noisy["frames"], noisy["bodies"]) == (4, arm["bodies"])
    poses = decode_poses(noisy["poses"], frames=4, bodies=len(arm["bodies"]))
    np.testing.assert_allclose(poses, np.repeat(arm["poses"], 4, axis=0), atol=1e-4)
    assert [shown["own"][human]["frames"] for human in IDS] == [1, 0]


@pytest.mark.parametrize("names", [("hand", "goal"), ("elbow", "wrist_x")], ids=str)
def test_features_that_tell_no_pose_have_none(tmp_path, task, names):
    assert discriminators(put(tmp_path, stored(names)), task)["7"]["poses"] is None


@pytest.mark.parametrize("other", [None, ToyReach()], ids=["a stranger's task", "no picture"])
def test_a_task_that_draws_nothing_has_no_poses(tmp_path, task, other):
    frontier = put(tmp_path, stored(task.feature_names))
    assert discriminators(frontier, other)["7"]["poses"] is None


def test_a_run_that_examined_none_gives_none(tmp_path, task):
    assert discriminators(frontier_in(tmp_path), task) is None


def test_a_measure_without_a_discriminator_is_said_to_have_none(tmp_path, task):
    frontier = put(tmp_path, {**stored(task.feature_names), "judged": None})
    assert discriminators(frontier, task)["7"]["judged"] is None


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda found: found["poses"].pop("names"), r"poses\.names: Field required"),
        (lambda found: found.update(levels=["0"]), r"levels\.0: Input should be a valid number"),
        (lambda found: found.update(format=2), r"has format version 2, but this RIGID reads up to"),
        (lambda found: found["poses"].update(names=["elbow"]), r"has poses that no arm takes \("),
    ],
    ids=["missing", "of another type", "newer", "of other features"],
)
def test_a_damaged_file_is_named(tmp_path, task, damage, message):
    found = json.loads(json.dumps(stored(task.feature_names)))
    damage(found)
    with pytest.raises(UserError, match=rf"discriminators/s7\.json.*{message}"):
        discriminators(put(tmp_path, found), task)


def test_a_truncated_file_is_named_and_deleting_it_helps(tmp_path, task):
    frontier, place = put(tmp_path, stored(task.feature_names)), file_of(tmp_path, 7)
    place.write_bytes(place.read_bytes()[:50])
    with pytest.raises(UserError, match=r"s7\.json: .*: delete it to draw the report without it"):
        discriminators(frontier, task)
    place.unlink()
    assert discriminators(frontier, task) is None


def test_the_file_holds_what_its_model_says():
    assert Discriminators.model_validate_json(json.dumps(stored(("a", "b")))).levels == (0.0, 1.0)
