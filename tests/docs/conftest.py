"""What the documentation takes for granted, in a folder where it is tried out."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rigid.policies.gaussian import GaussianPolicy
from rigid.policies.native import load_native, save_policy

ROOT = Path(__file__).parents[2]
BUNDLED = ROOT / "src" / "rigid" / "bundled" / "itch-scratching"
sys.path.insert(0, str(ROOT / "docs"))  # As Sphinx has it, for `extensions`.

ROBOTS = {"README.md": ["my/robot"], "docs/export.md": ["my/robot"]}
"""Robots that a page names and does not make."""
RUNS = {
    "README.md": ["theirs", *(f"{way}-{robot}" for way in "vr" for robot in (0, 1))],
    "docs/comparing.md": [
        "theirs",
        "mine",
        *(f"{way}-{robot}" for way in "vr" for robot in range(3)),
    ],
    "docs/export.md": ["vanilla"],
    "docs/policies.md": ["vanilla"],
    "docs/study.md": ["vanilla"],
    "docs/robots.md": ["vanilla-fresh", "robust-fresh", "robust-twice-fresh"],
    "examples/ci/README.md": ["last"],
}
"""Measurements, below `runs/`."""
FILES = {"docs/data-format.md": {"people.npz": BUNDLED / "vanilla" / "canonical.npz"}}
HUMANS = {
    "README.md": ["my/human"],
    "docs/comparing.md": [f"pairs/{seed}/human" for seed in range(3)],
}


@pytest.fixture(scope="session")
def small_run(tmp_path_factory):
    """A measurement of the bundled robot, of the size of `tests/docs/small.py`."""
    out = tmp_path_factory.mktemp("docs") / "run"
    words = ["frontier", "--robot", "builtin:vanilla", "--out", str(out)]
    command = [sys.executable, "-m", "tests.docs.small", *words]
    subprocess.run(command, cwd=ROOT, check=True, timeout=900)
    return out


def store_human(place, number):
    """The bundled human with a noise of its own: no human may be named twice."""
    policy, card = load_native(BUNDLED / "synthetic-human")
    parameters = policy.parameters
    noise = parameters.log_std - 0.01 * number
    human = GaussianPolicy(parameters._replace(log_std=noise), memory=policy.memory)
    save_policy(human, place, agent="human", task=card.task, provenance=card.provenance)


@pytest.fixture
def stage(request):
    """Puts there what the commands of a page name and no block of it makes."""

    def prepare(name, place):
        for robot in ROBOTS.get(name, ()):
            shutil.copytree(BUNDLED / "vanilla", place / robot)
        for number, human in enumerate(HUMANS.get(name, ())):
            store_human(place / human, number)
        for run in RUNS.get(name, ()):
            shutil.copytree(request.getfixturevalue("small_run"), place / "runs" / run)
        for file, source in FILES.get(name, {}).items():
            shutil.copy(source, place / file)
        (place / "examples").symlink_to(ROOT / "examples")

    return prepare
