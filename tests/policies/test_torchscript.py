"""Robots in TorchScript. Needs the extra `sb3`."""

from __future__ import annotations

import cloudpickle
import numpy as np
import pytest

from rigid.errors import UserError
from rigid.policies.loading import load_policy, policy_hash
from rigid.policies.opening import Opening
from tests.toys import ToyReach

pytestmark = [
    pytest.mark.sb3,
    pytest.mark.filterwarnings("ignore:`torch.jit:DeprecationWarning"),
]

SEEN = np.random.default_rng(0).uniform(0, 0.2, (4, 3, 2)).astype(np.float32)


@pytest.fixture(scope="module")
def robots(tmp_path_factory):
    """A folder of scripted modules."""
    import torch

    from tests.policies import scripted

    folder = tmp_path_factory.mktemp("scripted")
    for name in ("Follower", "Adding", "Hiding", "Three"):
        torch.jit.script(getattr(scripted, name)()).save(folder / f"{name}.pt")
    (folder / "text.pt").write_bytes(b"hello")
    (folder / "half.pt").write_bytes((folder / "Follower.pt").read_bytes()[:500])
    return folder


@pytest.fixture
def load(robots):
    def load(name):
        spec = f"torchscript:{robots / name}.pt"
        return load_policy(spec, task=ToyReach(), agent="robot", opening=Opening(trust=True))

    return load


def test_a_scripted_robot_acts_the_same_in_another_process(load):
    policy = load("Follower")
    sent = cloudpickle.loads(cloudpickle.dumps(policy))
    action, _ = sent.act(SEEN[0], sent.initial_state(3), None)
    np.testing.assert_allclose(action, SEEN[0, :, 1:] - SEEN[0, :, :1], atol=1e-6)
    assert policy_hash(sent) == policy_hash(policy)


def test_a_robot_with_initial_state_remembers(load):
    policy = load("Adding")
    state = policy.initial_state(3)
    for number, seen in enumerate(SEEN):
        action, state = policy.act(seen, state, None)
        np.testing.assert_allclose(action[:, 0], SEEN[: number + 1, :, 0].sum(axis=0), atol=1e-6)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Hiding", "answers the same observations in two ways: export its mean action"),
        ("Three", r"torch cannot run .*\(4x2 and 3x1\)\) \(shown 2 numbers, as the robot sees\)"),
        ("text", r"text\.pt is no TorchScript file, or a truncated one"),
        ("half", r"half\.pt is no TorchScript file, or a truncated one"),
        ("none", r"none\.pt does not exist: name a TorchScript file"),
    ],
)
def test_what_is_no_robot_is_refused(load, name, message):
    with pytest.raises(UserError, match=message):
        load(name)
