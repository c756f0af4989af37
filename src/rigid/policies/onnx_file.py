"""ONNX models on disk: read whole, external tensors included, without leaving their folder."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from rigid.errors import UserError
from rigid.files import read_bytes

_CURE = "export it again"


class OnnxFile(NamedTuple):
    """A model that needs no other file any more."""

    model: bytes
    sha256: str
    """Of the file's bytes, and of those of its external tensors after them."""


def read_onnx(path: Path) -> OnnxFile:
    """Reads a model.

    Raises:
        UserError: It is missing, empty or no ONNX, or a tensor lies outside its folder.
    """
    import onnx

    data = read_bytes(path, cure="name an ONNX file")
    if not data:
        raise UserError(f"{path} is empty: {_CURE}")
    try:
        model = onnx.load_model_from_string(data)
    except Exception:  # noqa: BLE001 - protobuf's error; protobuf is no dependency of ours.
        raise UserError(f"{path} is no ONNX file, or a truncated one: {_CURE}") from None
    external = [tensor for tensor in _tensors(model) if tensor.data_location == tensor.EXTERNAL]
    digest = hashlib.sha256(data)
    if not external:
        return OnnxFile(data, digest.hexdigest())
    for place in sorted({_place_of(tensor, path) for tensor in external}):
        digest.update(read_bytes(place, cure=f"it holds weights of {path}; {_CURE}"))
    try:
        onnx.load_external_data_for_model(model, str(path.parent))
        left = [
            tensor.name for tensor in _tensors(model) if tensor.data_location == tensor.EXTERNAL
        ]
        whole = model.SerializeToString()
    except (ValueError, RuntimeError, OSError, onnx.checker.ValidationError) as error:
        raise UserError(f"{path}: its external tensors cannot be read ({error}): {_CURE}") from None
    if left:  # onnx does not read those of sparse weights.
        raise UserError(
            f"{path}: tensor {left[0]!r} lies in another file, from which onnx does not read it: "
            "export the model with its weights inside"
        )
    return OnnxFile(whole, digest.hexdigest())


def _place_of(tensor: Any, path: Path) -> Path:
    """Where the bytes of a tensor lie."""
    location = {entry.key: entry.value for entry in tensor.external_data}.get("location", "")
    folder = path.parent.resolve()
    place: Path = (folder / location).resolve()
    if not location or not place.is_relative_to(folder):
        raise UserError(
            f"{path}: tensor {tensor.name!r} lies in {location!r}, outside of the model's folder: "
            "export it with its weights inside"
        )
    return place


def _tensors(message: Any) -> Iterator[Any]:
    """Every tensor of a model, also those of graphs within graphs, of functions and attributes."""
    if message.DESCRIPTOR.name == "TensorProto":
        yield message
        return
    for field, value in message.ListFields():
        if field.message_type is None:
            continue
        for part in value if field.is_repeated else (value,):
            yield from _tensors(part)
