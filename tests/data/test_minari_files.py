"""Episodes survive the way through Minari and through CSV, and one agent's is not another's."""

from __future__ import annotations

import json

import minari
import numpy as np
import pytest
from gymnasium import spaces
from minari.data_collector.episode_buffer import EpisodeBuffer
from minari.dataset.minari_storage import MinariStorage

from rigid.compute.people.completing import complete
from rigid.data.about import About, EpisodeNote
from rigid.data.csv_files import beside_csv, write_csv
from rigid.data.episodes import data_hash
from rigid.data.minari_files import known_to_file, write_minari
from rigid.data.recording import record
from rigid.errors import UserError
from tests.data.takes import TASK, brought_in
from tests.toys import Follower, Pointer

ABOUT = About(
    consent="research", licence="CC-BY-4.0", units={"hand": "m"},
    episodes=tuple(EpisodeNote(name=f"trial {i}", participant=f"P{i % 2}") for i in range(4)),
)  # fmt: skip


@pytest.fixture(scope="module")
def episodes():
    from dataclasses import replace

    found = record(TASK, Follower(), Pointer(), episodes=4, seed=3, batch=4, provenance={"x": 1})
    return replace(found, about=ABOUT)


@pytest.fixture
def dataset(episodes, tmp_path):
    return write_minari(episodes, known_to_file(episodes, tmp_path), str(tmp_path / "people-v0"))


def test_what_minari_keeps_is_what_was_recorded(episodes, dataset):
    found = minari.MinariDataset(dataset / "data")
    assert (found.id, found.total_episodes, found.total_steps) == ("people-v0", 4, 40)
    episode = found[2]
    np.testing.assert_array_equal(episode.observations[:-1], episodes.observations[2])
    np.testing.assert_array_equal(episode.actions, episodes.actions[2])
    np.testing.assert_array_equal(episode.infos["features"][1:], episodes.features[2])
    assert episode.rewards.sum() == pytest.approx(episodes.returns[2])
    assert episode.truncations.tolist() == [False] * 9 + [True]
    own = found.storage.metadata["rigid"]
    assert own["about"]["licence"] == "CC-BY-4.0"
    assert "the return at the last step" in own["remarks"]["rewards"]


@pytest.mark.parametrize("way", ["minari", "csv"])
def test_a_round_trip_keeps_every_number_and_what_is_told(episodes, dataset, tmp_path, way):
    write_csv(episodes, tmp_path / "people.csv")
    spec = {"minari": f"minari:{dataset}", "csv": tmp_path / "people.csv"}[way]
    from rigid.data.importing import import_recording
    from rigid.data.sources import open_source

    opened = open_source(str(spec), TASK, {}, rate=None)
    back = import_recording(
        opened.recording, TASK, map_={}, about=opened.about, source=opened.source
    ).episodes
    assert data_hash(back) == data_hash(episodes)
    assert (back.about.consent, back.about.licence) == ("research", "CC-BY-4.0")
    assert back.about.episodes == ABOUT.episodes
    assert opened.provenance["x"] == 1


def test_a_dataset_at_another_rate_is_resampled(dataset):
    found = brought_in(f"minari:{dataset}", rate=5.0)  # 10 steps of 0.2 s: 2 s, of which 1 s.
    assert found.episodes is None  # The features of the start are unknown.
    reasons = {verdict.reason for verdict in found.verdicts}
    assert reasons == {"no number in 1 rows of 'hand', the first is row 1"}


def strangers_dataset(tmp_path, **changes):
    """What somebody else's code writes: observations and actions, and nothing of RIGID."""
    box = spaces.Box(-10, 10, (3,), np.float32)
    place = tmp_path / "stranger-v0" / "data"
    place.mkdir(parents=True)
    storage = MinariStorage.new(place, box, spaces.Box(-1, 1, (1,), np.float32))
    storage.update_metadata({"dataset_id": "stranger-v0", "minari_version": minari.__version__})
    rows = np.arange(33, dtype=np.float32).reshape(11, 3)
    storage.update_episodes([
        EpisodeBuffer(
            seed=5, observations=rows, actions=np.linspace(-1, 1, 10, dtype=np.float32)[:, None],
            rewards=np.ones(10), terminations=np.zeros(10, bool), truncations=np.zeros(10, bool),
        )
    ])  # fmt: skip
    raw = json.loads((place / "metadata.json").read_text())
    raw = {k: v for k, v in (raw | changes).items() if v is not None}
    (place / "metadata.json").write_text(json.dumps(raw))
    return place.parent


def test_features_that_the_human_observes_are_taken_from_the_next_observation(tmp_path):
    found = brought_in(f"minari:{strangers_dataset(tmp_path)}").episodes
    assert found.observations[0, 0].tolist() == [0, 1, 2]
    assert found.features[0, 0].tolist() == [4, 5]  # hand and goal, after the first step.
    assert (found.returns[0], found.seeds[0]) == (10, 5)


def test_a_map_from_a_column_that_a_dataset_lacks_is_refused_with_those_it_has(tmp_path):
    (tmp_path / "map.json").write_text('{"hand": "nothing"}')
    with pytest.raises(UserError, match=r"no column 'nothing', .*; columns: step, reward, act"):
        brought_in(f"minari:{strangers_dataset(tmp_path)}", map_=tmp_path / "map.json")


def test_a_dataset_that_would_run_its_environment_is_refused(tmp_path):
    place = strangers_dataset(tmp_path, observation_space=None, env_spec='{"id": "x-v0"}')
    with pytest.raises(UserError, match="does not say what its observations and actions are"):
        brought_in(f"minari:{place}")


def test_the_robots_view_is_not_taken_for_a_humans(episodes, tmp_path):
    view = known_to_file(episodes, tmp_path)._replace(agent="robot")
    place = write_minari(episodes, view, str(tmp_path / "robot-v0"))
    with pytest.raises(UserError, match="is the robot's view: import the human's"):
        brought_in(f"minari:{place}")


@pytest.mark.parametrize(
    ("out", "message"),
    [("people", "no id of a Minari dataset: end it in a version, as in people-v0"),
     ("people-v0", "exists already: choose a new directory with --out")],
)  # fmt: skip
def test_a_bad_place_is_refused(episodes, dataset, out, message):
    with pytest.raises(UserError, match=message):
        write_minari(episodes, known_to_file(episodes, dataset), str(dataset.parent / out))


def test_a_missing_dataset_is_refused_with_the_command_that_fetches_it(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    with pytest.raises(UserError, match="`minari download lab/none-v0` fetches a public one"):
        brought_in("minari:lab/none-v0")


def test_a_table_that_was_edited_keeps_what_lies_beside_it(episodes, tmp_path):
    write_csv(episodes, tmp_path / "people.csv")
    beside = json.loads(beside_csv(tmp_path / "people.csv").read_text())
    assert beside["about"] == {"consent": "research", "licence": "CC-BY-4.0",
                               "units": {"hand": "m"}}  # fmt: skip
    header = (tmp_path / "people.csv").read_text().splitlines()[0].split(",")
    assert header[:4] == ["episode", "step", "hand", "goal"]


def test_a_replay_fills_in_what_nobody_recorded(episodes, tmp_path):
    from dataclasses import replace

    unknown = np.full(4, np.nan, np.float32)
    poor = replace(episodes, observations=None, returns=unknown, success=unknown)
    found = complete(TASK, Follower(), poor, where=tmp_path)
    assert found.same.all()
    np.testing.assert_allclose(found.episodes.returns, episodes.returns, atol=1e-5)
    np.testing.assert_allclose(found.episodes.observations, episodes.observations, atol=1e-6)
    assert (found.episodes.success == 1).all()
    assert found.episodes.rewards.shape == (4, 10)


def test_a_replay_that_does_not_come_out_again_fills_in_nothing(episodes, tmp_path):
    from dataclasses import replace

    unknown = np.full(4, np.nan, np.float32)
    other = replace(episodes, returns=unknown, actions=-episodes.actions)
    found = complete(TASK, Follower(), other, where=tmp_path)
    assert not found.same.any()
    assert np.isnan(found.episodes.returns).all()
