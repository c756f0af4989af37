"""Robots of Stable-Baselines3 and sb3-contrib act as they do there. Needs the extra `sb3`."""

from __future__ import annotations

import re
from pathlib import Path

import cloudpickle
import numpy as np
import pytest
from gymnasium import spaces

from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.opening import Opening
from rigid.policies.sb3_spaces import from_space
from rigid.tasks.protocol import AgentSpec
from tests.policies.spaces import Walk, replayed
from tests.toys import ToyReach

pytestmark = pytest.mark.sb3

LINE = spaces.Box(-1, 1, (1,), np.float32)
SEEN = np.random.default_rng(0).standard_normal((6, 4, 2)).astype(np.float32)
"""Six steps of four worlds."""
SMALL = {"device": "cpu", "seed": 0}


def task(*choices):
    """The toy task, with reals or discrete actions."""
    found = ToyReach()
    found.robot = AgentSpec(2, sum(choices) or 1, choices=choices)
    return found


def trained(name, space=LINE, *, env=None, **options):
    """An untrained model of the algorithm `name`."""
    import sb3_contrib
    import stable_baselines3

    algorithm = getattr(stable_baselines3, name, None) or getattr(sb3_contrib, name)
    if name in {"PPO", "MaskablePPO", "RecurrentPPO"}:
        options = {"n_steps": 16, "batch_size": 16, **options}
    elif name not in {"A2C", "TRPO", "ARS"}:
        options = {"buffer_size": 100, **options}
    policy = "MlpLstmPolicy" if name == "RecurrentPPO" else "MlpPolicy"
    return algorithm(policy, env or Walk(space), **SMALL, **options)


def load(spec="sb3:arm.zip", task_=None, **options):
    opening = Opening(trust=True, **options)
    return load_policy(spec, task=task_ or task(), agent="robot", opening=opening)


REAL = {
    "PPO": {},
    "A2C": {},
    "SAC": {},
    "TD3": {},
    "DDPG": {},
    "TQC": {},
    "CrossQ": {},
    "TRPO": {},
    "ARS": {},
    "RecurrentPPO": {"policy_kwargs": {"lstm_hidden_size": 4, "n_lstm_layers": 2}},
}


@pytest.mark.parametrize(
    ("name", "options"),
    [*REAL.items(), ("PPO", {"use_sde": True}), ("SAC", {"use_sde": True})],
)
def test_a_robot_acts_as_in_its_library(here, name, options):
    model = trained(name, **options)
    model.save(here / "arm.zip")
    policy = cloudpickle.loads(cloudpickle.dumps(load()))
    mine, theirs, start = policy.initial_state(4), None, np.ones(4, bool)
    for seen in SEEN:
        action, mine = policy.act(seen, mine, None)
        wanted, theirs = model.predict(seen, theirs, start, deterministic=True)
        start = np.zeros(4, bool)
        np.testing.assert_allclose(action, wanted, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "space", "choices"),
    [
        ("DQN", spaces.Discrete(3), (3,)),
        ("QRDQN", spaces.Discrete(3), (3,)),
        ("MaskablePPO", spaces.Discrete(3), (3,)),
        ("A2C", spaces.MultiDiscrete([3, 2]), (3, 2)),
        ("PPO", spaces.MultiBinary(2), (2, 2)),
    ],
)
def test_a_chosen_number_becomes_scores(here, name, space, choices):
    model = trained(name, space)
    model.save(here / "arm.zip")
    policy = load(task_=task(*choices))
    action, _ = policy.act(SEEN[0], policy.initial_state(4), None)
    wanted = model.predict(SEEN[0], deterministic=True)[0].reshape(4, -1)
    parts = np.split(action, np.cumsum(choices)[:-1], axis=1)
    np.testing.assert_array_equal(np.stack([p.argmax(axis=1) for p in parts], axis=1), wanted)


def test_actions_of_another_box_are_mapped_to_the_tasks(here):
    model = trained("SAC", spaces.Box(-4, 2, (1,), np.float32))
    model.save(here / "arm.zip")
    policy = load()
    action, _ = policy.act(SEEN[0], policy.initial_state(4), None)
    wanted = model.predict(SEEN[0], deterministic=True)[0]
    np.testing.assert_allclose(action, (wanted + 1) / 3, atol=1e-6)


@pytest.mark.parametrize("first", ["normalised", "stacked"])
def test_wrappers_do_what_they_did_in_training_in_either_order(here, first):
    from stable_baselines3.common.vec_env import DummyVecEnv, VecFrameStack, VecNormalize

    worlds = DummyVecEnv([lambda: Walk(LINE)] * 2)
    if first == "normalised":
        statistics = VecNormalize(worlds)
        env = VecFrameStack(statistics, 3)
    else:
        env = statistics = VecNormalize(VecFrameStack(worlds, 3))
    model = trained("PPO", env=env)
    model.learn(32)
    model.save(here / "arm.zip")
    statistics.save(here / "statistics.pkl")
    policy = load(frames=3, vecnormalize=here / "statistics.pkl")
    state = policy.initial_state(4)
    for seen, theirs in zip(SEEN, replayed(here / "statistics.pkl", first, SEEN), strict=True):
        action, state = policy.act(seen, state, None)
        np.testing.assert_allclose(action, model.predict(theirs, deterministic=True)[0], atol=1e-6)


def test_a_forgotten_normaliser_is_named_where_it_lies_or_was_in_training(here, caplog):
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    env = VecNormalize(DummyVecEnv([lambda: Walk(LINE)]))
    model = trained("PPO", env=env)
    model.learn(16)
    model.save(here / "arm.zip")
    load()
    assert "was trained behind VecNormalize" in caplog.text
    caplog.clear()
    env.save(here / "ppo_vecnormalize_16_steps.pkl")
    load()
    assert "ppo_vecnormalize_16_steps.pkl lies beside it" in caplog.text
    caplog.clear()
    load(vecnormalize=here / "ppo_vecnormalize_16_steps.pkl")
    assert caplog.text == ""


@pytest.mark.parametrize(("name", "space"), [("SAC", LINE), ("DQN", spaces.Discrete(3))])
def test_nobody_who_learned_without_a_normaliser_is_told_of_one(here, caplog, name, space):
    model = trained(name, space, learning_starts=4)
    model.learn(8)
    model.save(here / "arm.zip")
    load(task_=task(3) if name == "DQN" else None)
    assert caplog.text == ""


def test_choices_count_from_zero_wherever_the_space_starts():
    found = from_space(np.array([0, 2]), spaces.Discrete(3, start=5))
    np.testing.assert_array_equal(found, [0, 2])


def test_the_hash_follows_file_statistics_and_frames(here):
    from stable_baselines3.common.vec_env import DummyVecEnv, VecFrameStack, VecNormalize

    env = VecFrameStack(VecNormalize(DummyVecEnv([lambda: Walk(LINE)])), 2)
    trained("PPO", env=env).save(here / "arm.zip")
    env.venv.save(here / "statistics.pkl")
    hashes = [policy_hash(load(frames=2)), policy_hash(load(frames=2))]
    assert hashes[0] == hashes[1]
    assert policy_hash(load(frames=2, vecnormalize=here / "statistics.pkl")) != hashes[0]


def test_frames_that_were_not_said_are_named(here):
    trained("PPO", env=Walk(LINE, size=8)).save(here / "arm.zip")
    with pytest.raises(UserError, match="sees 4 × 2 numbers, not 1 × 2: say --frames 4"):
        load()
    with pytest.raises(UserError, match="sees 4 × 2 numbers, not 2 × 2: say --frames 4"):
        load(frames=2)
    with pytest.raises(UserError, match="sees 4 × 2 numbers, not 3 × 2: say --frames 4"):
        load(frames=3)


def test_what_sees_or_does_something_else_is_refused_with_both(here):
    trained("PPO", env=Walk(LINE, size=5)).save(here / "arm.zip")
    with pytest.raises(UserError, match="maps 5 observations to 1 actions, but the robot of"):
        load()
    trained("DQN", spaces.Discrete(3)).save(here / "arm.zip")
    with pytest.raises(UserError, match="answers whole numbers, as for discrete actions"):
        load()
    with pytest.raises(UserError, match=r"there are 2 discrete actions, of 3 and 2 choices"):
        load(task_=task(3, 2))


def test_observations_in_a_dict_are_refused(here):
    import stable_baselines3

    env = Walk(LINE)
    env.observation_space = spaces.Dict({"hand": LINE, "arm": LINE})
    options = {"n_steps": 16, "batch_size": 16, **SMALL}
    stable_baselines3.PPO("MultiInputPolicy", env, **options).save(here / "arm.zip")
    message = "sees a Dict of arm, hand, but the robot of 'toy-reach' sees a vector of 2 numbers"
    with pytest.raises(UserError, match=message):
        load()


def test_damaged_files_are_refused(here):
    trained("PPO").save(here / "good.zip")
    data = (here / "good.zip").read_bytes()
    for name, part in (("empty", b""), ("text", b"hello"), ("half", data[: len(data) // 2])):
        (here / f"{name}.zip").write_bytes(part)
        with pytest.raises(UserError, match=f"{name}.zip is no file of Stable-Baselines3"):
            load(f"sb3:{name}.zip")
    with pytest.raises(UserError, match=r"none\.zip does not exist: name a file that model\.save"):
        load("sb3:none.zip")
    with pytest.raises(UserError, match=r"good\.zip holds no statistics of VecNormalize"):
        load("sb3:good.zip", vecnormalize=here / "good.zip")
    with pytest.raises(UserError, match="--frames is 0, but must be at least 1"):
        load("sb3:good.zip", frames=0)


def test_a_class_that_is_not_there_is_named(here, monkeypatch):
    import sys

    trained("RecurrentPPO").save(here / "arm.zip")
    for name in [name for name in sys.modules if name.startswith("sb3_contrib")]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(UserError, match=r"its policy_class cannot be read .*\(sb3-contrib\?\)"):
        load()


DOCUMENTED = re.search(
    r"```python\n(import pickle.*?)```",
    (Path(__file__).parents[2] / "docs" / "policies.md").read_text(encoding="utf-8"),
    re.DOTALL,
)


@pytest.mark.filterwarnings("ignore")  # torch's older exporter warns of much.
@pytest.mark.parametrize("normalised", [False, True])
def test_the_documented_way_to_onnx_gives_the_same_robot(here, normalised):
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    env = VecNormalize(DummyVecEnv([lambda: Walk(LINE)]))
    trained("PPO", env=env).learn(32).save(here / "arm.zip")
    env.save(here / "vecnormalize.pkl")
    assert DOCUMENTED is not None
    text = DOCUMENTED[1]
    if normalised:
        text = text.replace("normaliser = None", "with open('vecnormalize.pkl', 'rb') as file:")
        text = text.replace("  # behind VecNormalize: ", "\n    normaliser = ")
        text = text.replace('pickle.load(open("vecnormalize.pkl", "rb"))', "pickle.load(file)")
    exec(compile(text, "docs/policies.md", "exec"), {})  # noqa: S102 - Our own page.
    policy = load("arm.onnx")
    statistics = here / "vecnormalize.pkl" if normalised else None
    original = load(vecnormalize=statistics)
    for seen in SEEN:
        mine, theirs = (p.act(seen, p.initial_state(4), None)[0] for p in (policy, original))
        np.testing.assert_allclose(mine, theirs, atol=1e-5)
