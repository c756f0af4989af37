"""Poses as text and back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rigid.report import decode_poses, encode_poses

shapes = st.tuples(st.integers(1, 5), st.integers(1, 4))


@given(shapes.flatmap(lambda shape: arrays(float, (*shape, 7), elements=st.floats(-3, 3))))
def test_poses_survive_to_their_resolution(poses):
    poses[..., 3] += 4.0  # No quaternion of length 0.
    frames, bodies, _ = poses.shape
    back = decode_poses(encode_poses(poses), frames=frames, bodies=bodies)
    unit = poses[..., 3:] / np.linalg.norm(poses[..., 3:], axis=-1, keepdims=True)
    np.testing.assert_allclose(back[..., :3], poses[..., :3], rtol=0, atol=0.51e-4)
    np.testing.assert_allclose(back[..., 3:], unit, rtol=0, atol=0.51 / 32767)


def test_bytes_are_little_endian_positions_then_quaternion():
    text = encode_poses(np.array([[[0.0001, -0.0001, 3.2767, -1.0, 0, 0, 0]]]))
    assert text == "AQD///9/AYAAAAAAAAA="


@pytest.mark.parametrize(
    ("value", "message"),
    [(np.nan, "is not finite"), (3.3, r"reach 3\.30 m, but only ±3\.2767 m")],
)
def test_pose_that_does_not_fit_is_refused(value, message):
    poses = np.tile([value, 0, 0, 1.0, 0, 0, 0], (2, 3, 1))
    with pytest.raises(ValueError, match=message):
        encode_poses(poses)


def test_quaternion_of_length_zero_is_refused():
    with pytest.raises(ValueError, match="quaternion of length 0"):
        encode_poses(np.zeros((1, 1, 7)))


@pytest.mark.parametrize(("text", "message"), [("no!", "not base64"), ("AAAA", "3 bytes, not 1")])
def test_text_that_holds_other_poses_is_refused(text, message):
    with pytest.raises(ValueError, match=message):
        decode_poses(text, frames=1, bodies=1)
