"""Frames are bytes that a page can read without guessing."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rigid.report.poses import POSITION_UNIT
from rigid.study.play.frame import Frame, frame_bytes, read_frame

UPRIGHT = np.array([0.1, -0.2, 1.5, 1.0, 0.0, 0.0, 0.0])


def frame(**changes):
    whole = Frame(3, np.tile(UPRIGHT, (2, 4, 1)), np.array([0.25, -0.5, 1.0]), False, 9, False)
    return whole._replace(**changes)


def test_every_number_stands_where_the_page_looks_for_it():
    data = frame_bytes(frame(unwanted=True, done=True))
    assert len(data) == 24 + 2 * 4 * 7 * 2
    assert struct.unpack_from("<I", data, 0) == (3,)
    assert data[4:6] == bytes([3, 2])
    assert struct.unpack_from("<3H", data, 6) == (4, 9, 0)
    assert struct.unpack_from("<3f", data, 12) == (0.25, -0.5, 1.0)
    assert struct.unpack_from("<7h", data, 24) == (1000, -2000, 15000, 32767, 0, 0, 0)


@pytest.mark.parametrize(("unwanted", "done", "flags"), [(0, 0, 0), (1, 0, 1), (0, 1, 2)])
def test_flags_are_bits_of_their_own(unwanted, done, flags):
    assert frame_bytes(frame(unwanted=bool(unwanted), done=bool(done)))[4] == flags


@given(arrays(float, (3, 2, 3), elements=st.floats(-3, 3)), st.integers(0, 65535), st.booleans())
def test_a_frame_comes_back_to_its_resolution(places, counted, unwanted):
    poses = np.concatenate([places, np.tile(UPRIGHT[3:], (3, 2, 1))], axis=-1)
    back = read_frame(frame_bytes(frame(poses=poses, counted=counted, unwanted=unwanted)))
    np.testing.assert_allclose(back.poses, poses, atol=0.51 * POSITION_UNIT)
    assert (back.step, back.unwanted, back.counted, back.done) == (3, unwanted, counted, False)
    np.testing.assert_array_equal(back.hand, [0.25, -0.5, 1.0])


@pytest.mark.parametrize("cut", [slice(0, 10), slice(0, -1)])
def test_a_frame_of_another_length_is_refused(cut):
    with pytest.raises(ValueError, match=r"shorter than its head of 24|poses make 136 bytes"):
        read_frame(frame_bytes(frame())[cut])
