"""Checkpoints: what goes in comes out, and damaged ones are named with their cure."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from rigid.compute.run.checkpoint import load_tree, save_arrays, save_tree
from rigid.errors import UserError

TREE = {
    "weights": [jnp.arange(6.0).reshape(2, 3), jnp.ones(3)],
    "count": jnp.asarray(7),
    "lambda": jnp.asarray(jnp.inf),
}


def blank(tree):
    return jax.tree.map(jnp.zeros_like, tree)


def test_a_tree_comes_back_with_its_shapes_types_and_values(tmp_path):
    save_tree(tmp_path / "deep" / "tree.safetensors", TREE)
    found = load_tree(tmp_path / "deep" / "tree.safetensors", blank(TREE))
    assert jax.tree.structure(found) == jax.tree.structure(TREE)
    for mine, theirs in zip(jax.tree.leaves(TREE), jax.tree.leaves(found), strict=True):
        assert mine.shape == theirs.shape
        assert mine.dtype == theirs.dtype
        np.testing.assert_array_equal(mine, theirs)


def test_arrays_in_another_memory_order_come_back_unchanged(tmp_path):
    transposed = np.arange(6.0, dtype=np.float32).reshape(2, 3).T
    save_tree(tmp_path / "tree", [transposed])
    np.testing.assert_array_equal(load_tree(tmp_path / "tree", [transposed])[0], transposed)


def test_a_missing_checkpoint_is_named(tmp_path):
    with pytest.raises(UserError, match=r"tree does not exist: delete this file to train"):
        load_tree(tmp_path / "tree", TREE)


@pytest.mark.parametrize("length", [0, 5, 40, -1])
def test_a_truncated_checkpoint_is_named_with_its_cure(tmp_path, length):
    path = tmp_path / "tree"
    save_tree(path, TREE)
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(UserError, match=r"tree is damaged \(.*\): delete this file to train from"):
        load_tree(path, TREE)


@pytest.mark.parametrize(
    ("template", "message"),
    [
        ([jnp.zeros(3)], r"\[0\] should have shape \(3,\), found shape \(2,\)"),
        ([jnp.zeros(2), jnp.zeros(())], r"\[1\] should have shape \(\), found nothing"),
    ],
    ids=["shape", "missing"],
)
def test_a_checkpoint_of_something_else_is_named_with_its_cure(tmp_path, template, message):
    save_tree(tmp_path / "tree", [jnp.zeros(2)])
    with pytest.raises(UserError, match=f"{message}: delete this file"):
        load_tree(tmp_path / "tree", template)


def test_arrays_are_stored_without_pickle(tmp_path):
    save_arrays(tmp_path / "deep" / "episodes.npz", {"returns": np.arange(3.0)})
    with np.load(tmp_path / "deep" / "episodes.npz", allow_pickle=False) as file:
        np.testing.assert_array_equal(file["returns"], np.arange(3.0))


def test_objects_are_no_arrays(tmp_path):
    with pytest.raises(ValueError, match="Object arrays cannot be saved"):
        save_arrays(tmp_path / "episodes.npz", {"ragged": np.array([[1], [2, 3]], dtype=object)})
    assert not list(tmp_path.iterdir())
