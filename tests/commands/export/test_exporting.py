"""`rigid export`: films and figures that can be read again, and refusals before any work."""

from __future__ import annotations

import json

import av
import numpy as np
import pytest
from PIL import Image

from tests.report.sample_payload import sample_payload
from tests.report.struck import FRAMES, run_of_strikes

SMALL = ("--size", "120x90", "--fps", 20)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
    from rigid.tasks.itch_scratching.task import ItchScratching

    task = ItchScratching(ItchScratchingParameters(horizon=FRAMES - 1))
    payload = sample_payload(seeds=1, replays=0)
    return run_of_strikes(tmp_path_factory.mktemp("struck"), task, payload)


def redness(picture):
    r, g, b = np.moveaxis(picture.astype(int), -1, 0)
    return int(((r > 110) & (r > 2 * g) & (r > 2 * b)).sum())


def played_webp(path):
    """Size and length [ms]; equal pictures are stored as one."""
    with Image.open(path) as film:
        lasting = 0
        for number in range(film.n_frames):
            film.seek(number)
            film.load()
            lasting += film.info["duration"]
        return film.size, lasting


def test_an_mp4_shows_the_worst_natural_point_and_turns_red(rigid, run, tmp_path):
    out = tmp_path / "deep" / "worst.mp4"
    code, text, _ = rigid("export", run, "--video", out, *SMALL)
    assert code == 0
    assert text.startswith("s0-r1-l0 · λ 0.25 · naturalness 0.85")
    assert text.endswith(f"worst episode: return -7.0, unwanted contact, 0.6 s: {out}\n")
    with av.open(str(out)) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert len(frames) == 2 * (FRAMES - 1) + 1
    assert frames[0].shape == (90, 120, 3)
    assert redness(frames[0]) == 0
    assert redness(frames[-1]) > 10
    assert [path.name for path in out.parent.iterdir()] == ["worst.mp4"]


def test_a_webp_side_by_side_is_twice_as_wide(rigid, run, tmp_path):
    out = tmp_path / "both.webp"
    options = ("--point", "s0-r1-l2", "--episode", "median", "--side-by-side", "--speed", 0.5)
    code, text, _ = rigid("export", run, "--video", out, *SMALL, *options)
    assert code == 0
    assert text.startswith("s0-r1-l2")
    assert "median episode: return 9.0, helped" in text
    assert played_webp(out) == ((240, 90), 50 * (4 * (FRAMES - 1) + 1))


def test_any_pair_can_be_filmed_without_a_run(rigid, tmp_path, monkeypatch):
    from rigid.tasks import registry
    from rigid.tasks.itch_scratching.parameters import ItchScratchingParameters
    from rigid.tasks.itch_scratching.task import ItchScratching

    short = ItchScratching(ItchScratchingParameters(horizon=2))
    monkeypatch.setattr(registry, "make_task", lambda _: short)
    out = tmp_path / "pair.webp"
    pair = ("--robot", "builtin:vanilla", "--human", "builtin:passive", "--seed", 3)
    code, text, _ = rigid("export", *pair, "--video", out, *SMALL)
    assert code == 0
    assert text.startswith("builtin:vanilla with builtin:passive, seed 3: return ")
    assert played_webp(out) == ((120, 90), 50 * 5)


def test_keypoints_of_the_worst_in_each_band_are_drawn(rigid, run, tmp_path):
    out = tmp_path / "failures.pdf"
    code, text, _ = rigid("export", run, "--keypoints", out)
    assert code == 0
    lines = text.splitlines()
    assert [line.split(" ")[0] for line in lines] == ["s0-r1-l0", "s0-r1-l2", str(out)]
    assert out.read_bytes().startswith(b"%PDF")


REFUSED = {
    "name what to write: --video FILE, --keypoints FILE, --onnx FILE or --serve FILE": [],
    "films end in .mp4 or .webp, not in .gif": ["--video", "a.gif"],
    "figures end in .pdf, .svg or .png": ["--keypoints", "a.jpg"],
    "--size '9x9': write width x height, as 800x600": ["--video", "a.webp", "--size", "9x9"],
    "--fps is 0, but must be from 1 to 240": ["--video", "a.webp", "--fps", "0"],
    "--speed is 0.0, but must be more than 0": ["--video", "a.webp", "--speed", "0"],
    "--robot goes without a run directory": ["--video", "a.webp", "--robot", "builtin:vanilla"],
    "--seed goes without a run directory": ["--video", "a.webp", "--seed", "4"],
    "--onnx goes without a run directory": ["--onnx", "a.onnx"],
    "--trust goes without a run directory": ["--video", "a.webp", "--trust"],
    "--size is for --video FILE": ["--keypoints", "a.pdf", "--size", "90x90"],
    "--fps is for --video FILE": ["--keypoints", "a.pdf", "--fps", "9"],
    "--speed is for --video FILE": ["--keypoints", "a.pdf", "--speed", "2"],
    "--point is for --video FILE": ["--keypoints", "a.pdf", "--point", "s0-r1-l0"],
    "--side-by-side is for --video FILE": ["--keypoints", "a.pdf", "--side-by-side"],
    "--point 's9' is none of this run's": ["--video", "a.webp", "--point", "s9"],
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_cannot_be_done_with_a_run_is_refused(rigid, run, tmp_path, monkeypatch, message):
    monkeypatch.chdir(tmp_path)
    code, out, err = rigid("export", run, *REFUSED[message])
    assert (code, out) == (2, "")
    assert message in err
    assert list(tmp_path.iterdir()) == []


PAIR = ["--robot", "builtin:vanilla"]
REFUSED_WITHOUT = {
    "name a run directory, or --robot": ["--video", "a.webp"],
    "--side-by-side needs a run directory": ["--video", "a.webp", *PAIR, "--side-by-side"],
    "--point needs a run directory": ["--video", "a.webp", *PAIR, "--point", "s0-r1-l0"],
    "--keypoints needs a run directory": ["--keypoints", "a.pdf", *PAIR],
    "--seed is -1, but must be at least 0": ["--video", "a.webp", *PAIR, "--seed=-1"],
    "name a run directory, or --robot for an episode of any pair or --onnx": ["--onnx", "a.onnx"],
    "models end in .onnx": ["--onnx", "a.bin", *PAIR],
    **{
        f"{option[0].partition('=')[0]} is for --video FILE": ["--onnx", "a.onnx", *PAIR, *option]
        for option in (
            ["--seed=3"],
            ["--human=builtin:passive"],
            ["--trust"],
            ["--frames=2"],
            ["--fps=9"],
        )
    },
    "--agent is for --onnx FILE": ["--video", "a.webp", *PAIR, "--agent", "robot"],
    "human 'builtin:vanilla' is unknown for task": ["--onnx", "a.onnx", *PAIR, "--agent", "human"],
    "policy.json does not exist": ["--onnx", "a.onnx", "--robot", "nowhere"],
    "is made in memory and has no weights": [
        "--onnx",
        "a.onnx",
        "--robot",
        "builtin:tracker",
        "--task",
        "analytic/hand-tracking",
    ],
    "has no picture": ["--video", "a.webp", *PAIR, "--task", "analytic/hand-tracking"],
}


@pytest.mark.parametrize("message", REFUSED_WITHOUT)
def test_what_needs_a_run_is_refused_without_one(rigid, tmp_path, monkeypatch, message):
    monkeypatch.chdir(tmp_path)
    code, out, err = rigid("export", *REFUSED_WITHOUT[message])
    assert (code, out) == (2, "")
    assert message in err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("option", ["--video", "--keypoints"])
def test_a_place_that_cannot_be_written_is_refused_before_any_work(rigid, run, option):
    name = {"--video": "/proc/a.webp", "--keypoints": "/proc/a.pdf"}[option]
    code, _, err = rigid("export", run, option, name)
    assert code == 2
    assert f"cannot write to {name} (" in err
    assert err.endswith(f"choose another place with {option}\n")


@pytest.mark.parametrize("agent", ["robot", "human"])
def test_a_native_policy_becomes_onnx_that_acts_the_same(rigid, toys, tmp_path, agent):
    out = tmp_path / "deep" / "policy.onnx"
    task = ("--task", "toy-reach")
    code, text, err = rigid("export", "--robot", toys / agent, "--onnx", out, *task)
    assert (code, err) == (0, "")
    sizes = {"robot": 2, "human": 3}[agent]
    named = f"{toys / agent}, {agent} of toy-reach: {sizes} observations, 1 actions: {out}\n"
    assert text == named
    again = {"robot": toys / "robot", "human": toys / "human", agent: out}
    found = []
    for robot, human in ((toys / "robot", toys / "human"), (again["robot"], again["human"])):
        players = ("--robot", robot, "--human", human)
        found.append(rigid("evaluate", *task, *players, "--episodes", 3, "--json")[1])
    mine, theirs = (json.loads(text)["return"] for text in found)
    assert (mine == pytest.approx(theirs, abs=1e-4)) == (agent == "robot")  # Humans lose noise.


def test_a_policy_of_another_ones_task_needs_its_name(rigid, toys, tmp_path):
    out = tmp_path / "policy.onnx"
    code, _, err = rigid("export", "--robot", toys / "robot", "--onnx", out)
    assert code == 2
    assert "was trained for 'toy-reach', which is none of RIGID's own tasks: name it with" in err
