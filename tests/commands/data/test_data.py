"""`rigid data` and `rigid train clone`: from files to files, with a reason for everything."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from rigid.data.episodes import load_episodes, save_episodes
from rigid.data.recording import record
from tests.compute.tiny import FilmedReach
from tests.data.takes import samples, write
from tests.toys import Follower, Pointer

TOY = ("--task", "toy-reach")


@pytest.fixture
def csv_file(tmp_path):
    episodes = {f"e{i:02}": samples(speed=0.5 + 0.05 * i) for i in range(13)}
    episodes["short"] = samples(seconds=0.5, speed=2.0)
    return write(tmp_path / "people.csv", episodes)


@pytest.fixture
def recorded(tmp_path):
    found = record(FilmedReach(), Follower(), Pointer(), episodes=4, seed=0, provenance={})
    save_episodes(tmp_path / "recorded.npz", found)
    return tmp_path / "recorded.npz"


def test_import_says_of_every_episode_whether_it_is_used(rigid, toys, csv_file, tmp_path):
    del toys
    out = tmp_path / "people.npz"
    told = ("--consent", "research", "--licence", "CC-BY-4.0")
    code, text, err = rigid("data", "import", "--from", csv_file, *TOY, "--out", out, *told)
    assert (code, err) == (0, "")
    lines = text.splitlines()
    assert len(lines) == 1 + 14 + 1
    assert lines[1].split()[-1] == "good"
    assert lines[14].split()[0] == "short"
    assert "LEFT OUT: too short: 0.50 s of 1 s" in lines[14]
    assert lines[-1] == f"13 of 14 episodes: {out}"
    assert load_episodes(out, task=FilmedReach()).about.licence == "CC-BY-4.0"


def test_import_in_json_warns_of_few_episodes_and_of_nothing_agreed(rigid, toys, tmp_path):
    del toys
    path = write(tmp_path / "two.csv", {"a": samples(), "b": samples(speed=0.5)})
    out = tmp_path / "people.npz"
    code, text, err = rigid("data", "import", "--from", path, *TOY, "--out", out, "--json")
    found = json.loads(text)
    assert (code, found["used"]) == (0, 2)
    assert [episode["used"] for episode in found["episodes"]] == [True, True]
    assert "warning: 2 episodes are too few for a measurement: the referee needs 12" in err
    assert "warning: nobody will know what may be done with it: --consent, --licence" in err


def test_import_exits_with_2_only_when_no_episode_is_left(rigid, toys, tmp_path):
    del toys
    path = write(tmp_path / "bad.csv", {"a": samples(seconds=0.5)})
    code, text, err = rigid("data", "import", "--from", path, *TOY, "--out", tmp_path / "x.npz")
    assert code == 2
    assert "too short" in text
    assert "holds no episode that can be used: the reasons stand above" in err
    assert not (tmp_path / "x.npz").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--from", "nowhere.csv"], "nowhere.csv does not exist: give a CSV file, a folder"),
        (["--from", "FILE", "--rate", "50"], "--rate is 50, but"),
        (["--from", "FILE", "--rate=-1"], "--rate is -1, but must be samples a second"),
        (["--from", "FILE", "--met", "jaco"], "but with robots without a name: leave --met out"),
        (["--from", "FILE", "--map", "no.json"], "no.json does not exist: docs/canonical-data.md"),
        (["--from", "FILE", "--map", "FILE"], "is no JSON (Expecting value"),
    ],
)  # fmt: skip
def test_import_refuses_bad_input(rigid, toys, csv_file, tmp_path, options, message):
    del toys
    options = [str(csv_file) if option == "FILE" else option for option in options]
    code, _, err = rigid("data", "import", *options, *TOY, "--out", tmp_path / "x.npz")
    assert code == 2
    assert message in err


@pytest.mark.parametrize("name", ["people.npz", "people.yaml"])
def test_a_map_that_is_no_text_is_refused_in_words(rigid, toys, csv_file, recorded, name):
    del toys
    binary = recorded.rename(recorded.with_name(name))
    options = ("--map", binary, "--out", binary.with_name("x.npz"))
    code, _, err = rigid("data", "import", "--from", csv_file, *options, *TOY)
    assert code == 2
    assert (
        f"{binary} is no text, but --map takes a JSON or YAML file: docs/canonical-data.md" in err
    )
    assert "codec" not in err


def test_a_map_may_be_yaml(rigid, toys, csv_file, tmp_path):
    del toys
    (tmp_path / "map.yaml").write_text("time: {from: time, unit: s}\n")
    (tmp_path / "bad.yml").write_text("time: [\n")
    out = ("--out", tmp_path / "x.npz")
    command = ("data", "import", "--from", csv_file, *TOY, *out)
    assert rigid(*command, "--map", tmp_path / "map.yaml")[0] == 0
    code, _, err = rigid(*command, "--overwrite", "--map", tmp_path / "bad.yml")
    assert code == 2
    assert "bad.yml is no YAML (while parsing" in err


def test_import_leaves_a_file_that_is_there_unless_it_is_given_up(rigid, toys, csv_file, recorded):
    del toys
    before = recorded.read_bytes()
    command = ("data", "import", "--from", csv_file, *TOY, "--out", recorded)
    code, _, err = rigid(*command)
    assert code == 2
    assert f"{recorded} exists already, and would be lost with what people consented to: " in err
    assert recorded.read_bytes() == before
    assert rigid(*command, "--overwrite")[0] == 0
    assert load_episodes(recorded, task=None).source == "recorded"


def test_a_recording_of_policies_replaces_one_of_policies_alone(
    rigid, toy_options, csv_file, recorded, tmp_path
):
    people = tmp_path / "people.npz"
    toy = toy_options[:2]
    assert rigid("data", "import", "--from", csv_file, *toy, "--out", people)[0] == 0
    assert rigid("record", *toy_options, "--episodes", 2, "--out", recorded)[0] == 0
    for path, held in ((people, "episodes of people"), (csv_file, "something else than episodes")):
        before = path.read_bytes()
        code, _, err = rigid("record", *toy_options, "--episodes", 2, "--out", path)
        assert code == 2
        assert f"{path} holds {held}: choose another file with --out" in err
        assert path.read_bytes() == before


def test_export_of_a_table_leaves_the_tables_that_are_there(rigid, recorded, csv_file):
    command = ("data", "export", recorded, "--to", "csv", "--out", csv_file)
    before = csv_file.read_bytes()
    code, _, err = rigid(*command)
    assert code == 2
    assert f"{csv_file} exists already: choose a new file with --out" in err
    assert csv_file.read_bytes() == before


def test_import_cannot_play_again_what_nobody_knows_the_start_of(rigid, toys, csv_file, tmp_path):
    robot = ("--robot", toys / "robot", "--out", tmp_path / "x.npz")
    code, _, err = rigid("data", "import", "--from", csv_file, *TOY, *robot)
    assert code == 2
    assert "has no column 'seed', so nobody knows how its episodes began" in err


def test_show_tells_what_is_in_a_file(rigid, recorded):
    code, text, _ = rigid("data", "show", recorded)
    lines = dict(line.split(maxsplit=1) for line in text.splitlines())
    assert code == 0
    assert lines["episodes"] == "4, each of 10 steps (1 s at 10 Hz)"
    assert lines["hand"].split()[0] == f"{load_episodes(recorded, task=None).features.min():.3f}"
    found = json.loads(rigid("data", "show", recorded, "--json")[1])
    assert found["returns_known"] == 4
    assert found["sha256"] == lines["sha256"]


def test_show_of_a_recording_of_policies_names_them_and_asks_for_nobodys_consent(
    rigid, toy_options, recorded
):
    _, robot, human = (str(option) for option in toy_options[1::2])
    rigid("record", *toy_options, "--episodes", 2, "--out", recorded)
    _, text, _ = rigid("data", "show", recorded)
    lines = dict(line.split(maxsplit=1) for line in text.splitlines())
    assert lines["source"] == "synthetic: a policy played the human"
    assert (lines["robots"], lines["human"]) == (robot, human)
    assert "not told" not in text


def test_show_of_people_says_what_nobody_told(rigid, toys, csv_file, tmp_path):
    del toys
    out = tmp_path / "people.npz"
    rigid("data", "import", "--from", csv_file, *TOY, "--out", out)
    _, text, _ = rigid("data", "show", out)
    lines = dict(line.split(maxsplit=1) for line in text.splitlines())
    unknown = ("participants", "devices", "robots", "consent", "licence")
    assert [lines[name] for name in unknown] == ["not told"] * 5
    assert "human" not in lines


def test_check_exits_with_1_when_an_episode_is_bad(rigid, toys, recorded, tmp_path):
    del toys
    assert rigid("data", "check", recorded, *TOY)[0] == 0
    found = load_episodes(recorded, task=None)
    found.features[2] = found.features[1]
    found.actions[2] = found.actions[1]
    save_episodes(tmp_path / "twin.npz", found)
    code, text, _ = rigid("data", "check", tmp_path / "twin.npz", *TOY)
    assert code == 1
    assert "LEFT OUT: the same as episode '1'" in text
    assert text.endswith("3 of 4 episodes are good\n")


def test_export_runs_no_program_that_only_the_file_names(rigid, recorded, tmp_path):
    found = load_episodes(recorded, task=FilmedReach())
    task = {**found.task, "name": f"exec:touch {tmp_path / 'ran'}"}
    save_episodes(tmp_path / "evil.npz", replace(found, task=task))
    view = ("--robot", "builtin:vanilla", "--out", "toy/reach-v0")
    code, _, err = rigid("data", "export", tmp_path / "evil.npz", *view)
    assert code == 2
    assert "which would run code: if you trust whoever made the file, say so with --task" in err
    assert not (tmp_path / "ran").exists()


def test_export_and_import_of_a_table_keep_the_hash(rigid, toys, recorded, tmp_path):
    del toys
    table, back = tmp_path / "people.csv", tmp_path / "back.npz"
    assert rigid("data", "export", recorded, "--to", "csv", "--out", table)[0] == 0
    assert rigid("data", "import", "--from", table, *TOY, "--out", back)[0] == 0
    hashes = [json.loads(rigid("data", "show", f, "--json")[1])["sha256"] for f in (recorded, back)]
    assert hashes[0] == hashes[1]


def test_the_robots_view_needs_the_robot(rigid, toys, toy_options, recorded, tmp_path):
    view = ("--agent", "robot", "--out", tmp_path / "robot-v0")
    code, _, err = rigid("data", "export", recorded, *view)
    assert code == 2
    assert "name the robot that it met with --robot" in err
    code, _, err = rigid("data", "export", recorded, *view, "--robot", toys / "robot", *TOY)
    assert code == 2
    assert "do not come out again" in err  # It met the follower.

    played = tmp_path / "played.npz"
    rigid("record", *toy_options, "--episodes", 3, "--out", played)
    code, text, _ = rigid("data", "export", played, *view, "--robot", toys / "robot", *TOY)
    assert code == 0
    assert "3 episodes, the robot's view" in text
    import minari

    episode = minari.MinariDataset(tmp_path / "robot-v0" / "data")[0]
    assert episode.observations.shape == (11, 2)
    returns = load_episodes(played, task=None).returns
    assert episode.rewards.sum() == pytest.approx(returns[0], rel=1e-5)


@pytest.fixture
def study(toy_options, rigid, tmp_path):
    """Episodes of the toy pair, as a study with actions would give them."""
    path = tmp_path / "study.npz"
    assert rigid("record", *toy_options, "--episodes", 24, "--out", path)[0] == 0
    return path


def test_a_clone_is_stored_with_what_is_known_of_it(rigid, toys, study, tmp_path, hasty):
    del hasty
    from rigid.policies.loading import load_policy

    out = tmp_path / "human"
    few = ("--rollouts", 20, "--hidden", 8)
    options = ("--canonical", study, *TOY, "--robot", toys / "robot", *few)
    code, text, _ = rigid("train", "clone", *options, "--out", out)
    told = json.loads((out / "clone.json").read_text())
    assert code == int(bool(told["problems"]))
    assert f"human: {out}" in text
    assert told["episodes"] == {"train": 14, "validation": 5, "test": 5}
    assert np.isfinite(told["played"]["naturalness"])
    assert load_policy(str(out), task=FilmedReach(), agent="human").memory == 1
    code, _, err = rigid("train", "clone", *options, "--out", out)
    assert code == 2
    assert "already holds a policy: choose another with --out" in err


@pytest.fixture
def hasty(monkeypatch):
    """Referees of a few steps, for tests that ask nothing of their verdicts."""
    from dataclasses import replace

    from rigid.naturalness.referee import RefereeSettings

    members = RefereeSettings.members

    def few(self, length):
        return tuple(
            member._replace(recipe=replace(member.recipe, block=2, blocks=1))
            for member in members(self, length)
        )

    monkeypatch.setattr(RefereeSettings, "members", few)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--canonical", "nowhere.npz"], "nowhere.npz does not exist"),
        (["--canonical", "x", "--rollouts", "5"], "--rollouts is 5, but must be at least 20"),
        (["--canonical", "x", "--seed=-1"], "--seed is -1, but must be at least 0"),
    ],
)
def test_a_clone_refuses_bad_input_and_writes_nothing(rigid, toys, tmp_path, options, message):
    del toys
    code, _, err = rigid("train", "clone", *options, *TOY, "--out", tmp_path / "new")
    assert code == 2
    assert message in err
    assert not (tmp_path / "new").exists()
