"""`docs/data-format.md` lists what is on disk: every array, every entry, nothing else."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from rigid.data.about import About, EpisodeNote
from rigid.data.episodes import _Header, load_episodes, save_episodes
from tests.data.test_episodes import TASK, some_episodes

PAGE = (Path(__file__).parents[2] / "docs" / "data-format.md").read_text(encoding="utf-8")
SIZES = {"E": 3, "T": 10, "F": 2, "O": 3, "A": 1}


def table(heading):
    """Rows of the table whose header begins with `heading`, as lists of cells."""
    body = PAGE.partition(f"| {heading} |")[2].partition("\n\n")[0]
    rows = [line for line in body.splitlines()[2:] if line.startswith("|")]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]] for row in rows]


@pytest.fixture
def path(tmp_path):
    notes = tuple(EpisodeNote(name=str(i), participant="P1") for i in range(3))
    about = About(consent="c", licence="l", units={"hand": "m"}, recorded_rate=25.0, episodes=notes)
    whole = some_episodes(rewards=np.ones((3, 10)), times=np.ones((3, 10)), about=about)
    save_episodes(tmp_path / "all.npz", whole)
    return tmp_path / "all.npz"


def test_every_array_is_described_with_its_shape_and_type(path):
    with np.load(path, allow_pickle=False) as file:
        found = {name: (array.shape, array.dtype.name) for name, array in file.items()}
    described = {}
    for name, shape, kind, *_ in table("name | shape"):
        sizes = tuple(SIZES[letter] for letter in shape.split(", ")) if shape else ()
        described[name.strip("`")] = (sizes, kind)
    assert found.pop("header")[0] == described.pop("header")[0] == ()
    assert found == described


def test_every_entry_of_the_header_is_described():
    named = [row[0].strip("`") for row in table("name | type")]
    assert named == list(_Header.model_fields)
    assert [row[0].strip("`") for row in table("`about.`")] == list(About.model_fields)
    notes = [row[0].strip("`") for row in table("`about.episodes[].`")]
    assert notes == list(EpisodeNote.model_fields)


def test_the_page_reads_a_file_with_numpy_alone(path):
    code = PAGE.partition("```python\n")[2].partition("```")[0]
    code = code.replace("people.npz", str(path)).replace('"elbow"', '"hand"')
    space = {}
    exec(code, space)  # noqa: S102  # It is the page that is tested.
    np.testing.assert_array_equal(space["elbow"], some_episodes().features[..., 0])
    assert space["header"]["about"]["licence"] == "l"


def test_what_is_told_survives_and_changes_no_identity(path):
    from rigid.data.episodes import data_hash

    found = load_episodes(path, task=TASK)
    assert found.about.participants == ("P1",)
    assert found.times.dtype == np.float64
    assert data_hash(found) == data_hash(some_episodes())


def test_a_file_without_the_newer_entries_is_written_as_before(tmp_path):
    save_episodes(tmp_path / "old.npz", some_episodes())
    with np.load(tmp_path / "old.npz", allow_pickle=False) as file:
        assert "about" not in json.loads(str(file["header"]))
        assert set(file) == {"features", "observations", "actions", "seeds", "returns", "success",
                             "header"}  # fmt: skip


def test_notes_of_another_number_of_episodes_are_refused(tmp_path):
    from rigid.errors import UserError

    two = some_episodes(about=About(episodes=(EpisodeNote(), EpisodeNote())))
    with pytest.raises(UserError, match="has notes on 2 episodes, but holds 3: give each its own"):
        save_episodes(tmp_path / "new.npz", two)
