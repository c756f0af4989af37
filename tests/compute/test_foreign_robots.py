"""A robot in ONNX from end to end: measured, its hash in the settings, and held to it."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import onnx
import pytest
from onnx import helper, numpy_helper

from rigid.compute.executors.processes import Processes
from rigid.compute.run.directory import RunDirectory, read_settings
from rigid.errors import UserError
from tests.compute.tiny import Notes, measure_tiny, without_times


def store_follower(path, *, gain=2.5):
    """A robot for `ToyReach` that goes to where the hand is, as fast as `gain` says."""
    weight = numpy_helper.from_array(np.array([[-gain], [gain]], np.float32), "w")
    ports = [
        helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, ["batch", size])
        for name, size in (("observation", 2), ("action", 1))
    ]
    nodes = [helper.make_node("MatMul", ["observation", "w"], ["action"])]
    graph = helper.make_graph(nodes, "follower", ports[:1], ports[1:], [weight])
    opset = [helper.make_opsetid("", 17)]
    onnx.save(helper.make_model(graph, opset_imports=opset, ir_version=8), path)
    return str(path)


def begin(base, out, robot):
    """Measures until the first training would start."""
    with pytest.raises(KeyboardInterrupt):
        measure_tiny(base, out, robot=robot, listener=Notes(stop=lambda: True))


def stored_hash(out):
    """Of the robot that a run directory is about."""
    return read_settings(RunDirectory(out))["identity"]["robot"]


def test_the_settings_hold_the_hash_of_the_file_wherever_it_lies(base, tmp_path):
    spec = store_follower(tmp_path / "follower.onnx")
    begin(base, tmp_path / "run", spec)
    data = Path(spec).read_bytes()
    assert stored_hash(tmp_path / "run") == hashlib.sha256(data).hexdigest()
    (tmp_path / "copy.onnx").write_bytes(data)
    begin(base, tmp_path / "run", str(tmp_path / "copy.onnx"))  # The same settings: it goes on.


def test_another_file_is_another_robot(base, tmp_path):
    begin(base, tmp_path / "run", store_follower(tmp_path / "follower.onnx"))
    other = store_follower(tmp_path / "slower.onnx", gain=0.5)
    with pytest.raises(UserError, match="holds a measurement with other settings: robot is"):
        measure_tiny(base, tmp_path / "run", robot=other)


@pytest.mark.slow
def test_a_robot_in_onnx_is_measured_alike_here_and_in_other_processes(base, tmp_path):
    spec = store_follower(tmp_path / "follower.onnx")
    here = measure_tiny(base, tmp_path / "here", robot=spec)
    there = measure_tiny(base, tmp_path / "there", robot=spec, executor=Processes(2))
    assert without_times(here) == without_times(there)
