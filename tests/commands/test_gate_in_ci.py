"""The example workflow stops the release of a robot that became less robust, and no other."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from rigid import cli
from tests.docs.blocks import rigid_calls

FOLDER = Path(__file__).parents[2] / "examples" / "ci"
WORKFLOW = yaml.safe_load((FOLDER / "robustness.yml").read_text(encoding="utf-8"))
JOBS = WORKFLOW["jobs"]
STEPS = [step for job in JOBS.values() for step in job["steps"]]
GATE = next(step["run"] for step in STEPS if step.get("name") == "Gate")


def filled(script):
    """A script with what the workflow's `env` sets."""
    return re.sub(r"\$([A-Z_]+)", lambda name: WORKFLOW["env"].get(name[1], name[0]), script)


def test_every_rigid_command_of_the_workflow_is_one_that_rigid_takes():
    scripts = [filled(step["run"]) for step in STEPS if "run" in step]
    calls = [call for text in scripts for line in text.splitlines() for call in rigid_calls(line)]
    assert [call[0] for call in calls] == ["frontier", "gate", "gate"]
    for call in calls:
        cli.parse(call)


def test_every_action_is_pinned_by_commit_and_every_job_is_bounded():
    assert all(re.fullmatch(r"[\w/-]+@[0-9a-f]{40}", s["uses"]) for s in STEPS if "uses" in s)
    assert all(0 < job["timeout-minutes"] <= 120 for job in JOBS.values())


def test_only_the_job_that_runs_no_code_of_the_repository_may_write():
    assert WORKFLOW["permissions"] == {}
    assert JOBS["measure"]["permissions"] == {"contents": "read"}
    assert JOBS["publish"]["permissions"] == {"contents": "write"}
    assert JOBS["publish"]["needs"] == "measure"
    assert not any("checkout" in step.get("uses", "") for step in JOBS["publish"]["steps"])


@pytest.fixture
def gate(tmp_path):
    """Runs the workflow's gate in a folder with `runs/new` and perhaps `runs/last`."""

    def run(new, last=None, **env):
        folder = tmp_path / f"job-{len(list(tmp_path.iterdir()))}"
        tools = folder / "bin"
        tools.mkdir(parents=True)
        (tools / "rigid").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m rigid "$@"\n')
        (tools / "rigid").chmod(0o755)
        for name, run_directory in (("new", new), ("last", last)):
            if run_directory is not None:
                (folder / "runs" / name).mkdir(parents=True)
                for file in ("settings.json", "frontier.json"):  # All that a baseline keeps.
                    shutil.copy(run_directory / file, folder / "runs" / name)
        # What the runner makes of `shell:`; without it there would be no pipefail.
        pipefail = WORKFLOW.get("defaults", {}).get("run", {}).get("shell") == "bash"
        done = subprocess.run(
            ["bash", "-eo", "pipefail", "-c", GATE] if pipefail else ["bash", "-e", "-c", GATE],
            cwd=folder,
            env={
                **os.environ, **WORKFLOW["env"], "NATURALNESS": "0", **env,
                "PATH": f"{tools}:{os.environ['PATH']}", "GITHUB_STEP_SUMMARY": str(folder / "s"),
            },
            capture_output=True, text=True, check=False, timeout=120,
        )  # fmt: skip
        assert (folder / "s").read_text() == done.stdout
        return done.returncode

    return run


def test_a_robot_as_good_as_the_last_passes_and_a_worse_one_does_not(gate, two_runs):
    good, worse = two_runs
    assert gate(good, good) == 0
    assert gate(worse, good) == 3
    assert gate(worse, good, MARGIN="1") == 0


def test_the_first_release_is_held_against_a_limit(gate, two_runs):
    assert gate(two_runs[0], MAX_WORST="1") == 0
    assert gate(two_runs[0], MAX_WORST="0") == 3
