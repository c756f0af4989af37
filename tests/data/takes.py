"""Recordings of the toy task as CSV text: a hand that goes to its goal, sampled at any rate."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from rigid.data.about import About
from rigid.data.column_map import load_map
from rigid.data.importing import Imported, import_recording
from rigid.data.sources import open_source
from tests.toys import ToyReach

TASK = ToyReach()
"""10 steps of 0.1 s; features hand and goal."""


def samples(*, hz=50.0, seconds=1.0, speed=1.0, goal=1, **columns):
    """Columns of one episode whose hand moves at `speed`, with a tremor, so that it lives."""
    time = np.arange(round(seconds * hz) + 1) / hz
    hand = speed * time + 0.001 * np.sin(50 * speed * time)
    told = {"time": time, "hand": hand, "goal": np.full(len(time), goal), **columns}
    return {
        name: np.broadcast_to(np.asarray(column), time.shape).astype(object)
        for name, column in told.items()
    }


def write(path: Path, episodes) -> Path:
    """A CSV file of episodes by name."""
    first = next(iter(episodes.values()))
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["episode", *first])
        for name, columns in episodes.items():
            for row in zip(*columns.values(), strict=True):
                writer.writerow([name, *("" if cell is None else cell for cell in row)])
    return path


def brought_in(path, *, task=TASK, map_=None, rate=None, robot=None) -> Imported:
    """What `rigid data import` makes of a source."""
    columns = load_map(map_)
    opened = open_source(str(path), task, columns, rate=rate)
    return import_recording(opened.recording, task, map_=columns, about=About(), robot=robot)
