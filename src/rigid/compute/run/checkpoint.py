"""Checkpoints: any pytree of arrays as one safetensors file, restored into a template."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import jax
import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load, save

from rigid.errors import UserError
from rigid.files import read_bytes, write_atomically

_Tree = TypeVar("_Tree")


def save_tree(path: Path, tree: Any) -> None:
    """Writes every leaf of `tree` under its path; the old file stays until the new one is whole."""
    leaves = jax.tree_util.tree_leaves_with_path(tree)
    arrays = {jax.tree_util.keystr(place): np.asarray(leaf, order="C") for place, leaf in leaves}
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, save(arrays))


def save_arrays(path: Path, arrays: Mapping[str, np.ndarray]) -> None:
    """Writes named arrays as a compressed `.npz` without pickle; whole or not at all."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, buffer.getvalue())


def load_arrays(path: Path, *, cure: str) -> dict[str, np.ndarray]:
    """What `save_arrays` wrote.

    Raises:
        UserError: The file is missing or damaged; the message ends with the `cure`.
    """
    stored = io.BytesIO(read_bytes(path, cure=cure))
    try:
        with np.load(stored, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (ValueError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise UserError(f"{path} cannot be read ({error}): {cure}") from None


def load_tree(
    path: Path,
    template: _Tree,
    *,
    cure: str = "delete this file to train from the start of its group",
) -> _Tree:
    """Reads a tree of the same shape as `template`.

    Raises:
        UserError: The file is missing, damaged, or holds other arrays than `template`.
    """
    try:
        arrays = load(read_bytes(path, cure=cure))
    except SafetensorError as error:
        raise UserError(f"{path} is damaged ({error}): {cure}") from None
    leaves = []
    for place, leaf in jax.tree_util.tree_leaves_with_path(template):
        name = jax.tree_util.keystr(place)
        found = arrays.get(name)
        if found is None or found.shape != np.shape(leaf):
            shape = "nothing" if found is None else f"shape {found.shape}"
            wanted = np.shape(leaf)
            raise UserError(f"{path}: {name} should have shape {wanted}, found {shape}: {cure}")
        leaves.append(jax.numpy.asarray(found))
    tree: _Tree = jax.tree.unflatten(jax.tree.structure(template), leaves)
    return tree
