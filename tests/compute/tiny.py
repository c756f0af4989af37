"""The smallest measurement that goes through everything: a toy task, two policies, a preset."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import rigid
from rigid.frontier.result import Frontier, load_frontier
from rigid.naturalness.referee import RefereeSettings
from rigid.policies.native import save_policy
from rigid.presets import Preset
from tests.toys import ToyReach, ToyWorld, untrained

ROOT = Path(__file__).parents[2]

TINY = Preset(
    name="tiny",
    seeds=(0, 1),
    per_round=(2, 1),
    iterations=12,
    episodes=4,
    scoring_episodes=6,
    referee_episodes=5,
    validation_episodes=3,
    search_canonical=4,
    referee_canonical=4,
)
"""Two groups for each of two seeds, each with a checkpoint before its end."""

TIMES = ("core_seconds", "wall_seconds", "driver_seconds")


class FilmedReach(ToyReach):
    """`ToyReach` whose episodes can be shown again."""

    def make_world(self, batch, *, threads=0):
        del threads
        return _FilmedWorld(self, batch)

    def replay(self, snapshots):
        return {"frames": len(snapshots), "hand": snapshots[:, 1].tolist()}


class _FilmedWorld(ToyWorld):
    def snapshot(self):
        return np.stack([self._robot, self._hand, self._goal], axis=1)


def store_pair(directory: Path) -> None:
    """An untrained robot and human on disk."""
    task = FilmedReach()
    for agent in ("robot", "human"):
        policy = untrained(getattr(task, agent), seed=1)
        save_policy(policy, directory / agent, agent=agent, task=task.describe(), provenance={})


def measure_tiny(base: Path, out: Path, *, task=None, robot=None, **options) -> Frontier:
    """Measures the toy robot that lies below `base`, or another one."""
    settings = {"preset": TINY, "human": str(base / "pair" / "human"), **options}
    robot = robot or str(base / "pair" / "robot")
    with pytest.MonkeyPatch.context() as patch:
        hasten_referees(patch)
        return rigid.measure(task or FilmedReach(), robot, out=out, **settings)


def hasten_referees(
    patch: pytest.MonkeyPatch, module: str = "rigid.compute.preparation", **steps: int
) -> None:
    """Has the referees of a module fitted in a few steps: most of the time of a toy is theirs.

    Those of a measurement are of `preparation`, and travel with groups into other processes.
    """
    hasty = partial(RefereeSettings, **{"block": 50, "blocks": 3, **steps})
    patch.setattr(f"{module}.RefereeSettings", hasty)


def measured_once(base: Path, name: str, **options) -> Frontier:
    """The same, one time for the whole session, whichever folder of tests asks first."""
    out = base / f"measured-{name}"
    if not (out / "frontier.json").exists():
        measure_tiny(base, out, **options).report()
    return load_frontier(out)


def install_toy(base: Path) -> Path:
    """A distribution that registers the toy task; installed where its folder is on the path."""
    directory = base / "site"
    information = directory / "toy_tasks-1.0.dist-info"
    information.mkdir(parents=True, exist_ok=True)
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: toy-tasks\nVersion: 1.0\n")
    entry = "[rigid.tasks]\ntoy-reach = tests.compute.tiny:FilmedReach\n"
    (information / "entry_points.txt").write_text(entry)
    return directory


def start_rigid(site: Path, *arguments: str) -> subprocess.Popen[str]:
    """`rigid` in a process of its own, with the toy task and the preset `tiny`."""
    # The smallest of computations are cached as well: such a process compiles hundreds.
    caching = {"JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0"}
    places = [str(ROOT), str(site), os.environ.get("PYTHONPATH", "")]
    return subprocess.Popen(
        [sys.executable, "-m", "tests.compute.toy_run", *arguments],
        cwd=ROOT,
        env={**os.environ, **caching, "PYTHONPATH": os.pathsep.join(filter(None, places))},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def without_times(frontier: Frontier) -> str:
    """`frontier.json` as text, but for what may differ from run to run."""
    path = load_frontier(frontier.directory).directory / "frontier.json"
    data = json.loads(path.read_text(encoding="utf-8"))
    for name in TIMES:
        del data[name]
    return json.dumps(data, indent=1)


@contextmanager
def interrupt_at(path: Path, ready=lambda: True):
    """Sends SIGINT to this process, as Ctrl-C does, as soon as `path` exists and it is `ready`.

    A suite that a shell runs in its background inherits that SIGINT is ignored.
    """
    inherited = signal.signal(signal.SIGINT, signal.default_int_handler)
    over = threading.Event()

    def watch():
        while not over.wait(0.01):
            if path.exists() and ready():
                os.kill(os.getpid(), signal.SIGINT)
                return

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()
        signal.signal(signal.SIGINT, inherited)


class Notes:
    """A listener that remembers, and interrupts the measurement when `stop` says so."""

    def __init__(self, stop=lambda: False) -> None:
        self.work, self.done, self.lines, self._stop = None, 0, [], stop

    def begin(self, work):
        assert work.seconds > 0
        self.work, self.done = work, work.done
        self._check()

    def advance(self, env_steps):
        self.done += env_steps
        self._check()

    def say(self, text):
        self.lines.append(text)

    @property
    def complete(self):
        """Whether every step was told, once."""
        return self.done == self.work.steps

    def _check(self):
        if self._stop():
            raise KeyboardInterrupt
