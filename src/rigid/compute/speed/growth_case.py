"""One small measurement in a process of its own: its peak memory and its time.

python -m rigid.compute.speed.growth_case '{"seeds": 2}' 2
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rigid.compute.executors.executor import Local
from rigid.compute.measurement import measure_robots
from rigid.compute.memory import peak_memory
from rigid.compute.preparation import settings_for
from rigid.compute.robot_run import Order
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.compute.speed.timing import timed
from rigid.compute.subject import Subject
from rigid.frontier.comparison import Row, compare
from rigid.presets import Preset
from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
from rigid.tasks.itch_scratching.task import ItchScratching


@dataclass(frozen=True, kw_only=True)
class Case:
    """How much is measured."""

    lambdas: int = 2
    """Weights λ of a seed, a network for each."""
    worlds: int = 8
    """Episodes of each of them in one iteration."""
    seeds: int = 1
    iterations: int = 4
    robots: int = 1
    """Measured one after the other, then compared."""
    horizon: int = 100
    """Control steps of an episode."""

    @property
    def preset(self) -> Preset:
        """Its budget; scoring is small and the same in all cases."""
        return Preset(
            name="growth", seeds=tuple(range(self.seeds)), per_round=(self.lambdas,),
            iterations=self.iterations, episodes=self.worlds, scoring_episodes=8,
            referee_episodes=8, validation_episodes=4, referee_canonical=8,
        )  # fmt: skip


def run_case(case: Case, times: int) -> dict[str, float]:
    """Measures the bundled robot so many times in this process.

    What the first measurement reads or compiles takes as long in a small case as in a large one.

    Returns:
        `peak_mb`, largest resident memory of this process after the first one [MB], and `seconds`
        of the last one.
    """
    subject = _itch_scratching(case.horizon)
    seconds = timed(lambda: measure_case(case, subject))
    peak = peak_memory()
    for _ in range(times - 1):
        seconds = timed(lambda: measure_case(case, subject))
    return {"peak_mb": round(peak, 1), "seconds": round(seconds, 2)}


def _itch_scratching(horizon: int) -> Subject:
    task = ItchScratching(ItchScratchingParameters(horizon=horizon))
    # The bundled canonical episodes have 100 steps; those of another draw are played afresh.
    return Subject(task, "builtin:vanilla", canonical_draw=1)


def measure_case(case: Case, subject: Subject) -> list[Row]:
    """Measures as many robots, all of them `subject`, and compares them where there are several.

    Returns:
        Rows of the comparison; none for a single robot.
    """
    preset, lambdas = case.preset, tuple(np.geomspace(0.01, 10.0, case.lambdas).tolist())
    with TemporaryDirectory() as directory:
        orders = [
            Order(
                subject=subject, preset=preset, settings=settings_for(preset),
                out=Path(directory) / str(number), lambdas=lambdas,
            )
            for number in range(case.robots)
        ]  # fmt: skip
        # In this process, where all memory is seen.
        found = {run.directory.name: run for run in measure_robots(orders, Local())}
        if len(found) == 1:
            return []
        identities = {
            name: read_settings(RunDirectory(run.directory))["identity"]
            for name, run in found.items()
        }
        return compare(found, identities)


if __name__ == "__main__":
    result = run_case(Case(**json.loads(sys.argv[1])), int(sys.argv[2]))
    sys.stdout.write(json.dumps(result) + "\n")
