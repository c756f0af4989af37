"""JSON headers of files, checked against what their format looks like.

Apart from `rigid.files`, since every command needs that one, and pydantic takes a third of the time
that `rigid --help` has.
"""

from __future__ import annotations

from typing import TypeVar

from pydantic import BaseModel, ValidationError

from rigid.errors import UserError

_Header = TypeVar("_Header", bound=BaseModel)


class _Version(BaseModel):
    """The only part of a header that every format version shares."""

    format: int


def parse_header(
    model: type[_Header], text: str | bytes, *, version: int, where: object, cure: str
) -> _Header:
    """A JSON header, checked against `model`.

    Args:
        model: What format `version` looks like.
        text: JSON.
        version: The newest format version that this RIGID reads.
        where: Whose header it is; begins every message.
        cure: What to do about a bad header; ends every message but the one on newer versions.

    Raises:
        UserError: The header is no JSON, of another version, or does not fit `model`.
    """
    try:
        found = _Version.model_validate_json(text).format
        if found > version:
            raise UserError(
                f"{where} has format version {found}, but this RIGID reads up to {version}: "
                "install a newer rigid-frontier"
            )
        if found < 1:
            raise UserError(f"{where} has unknown format version {found}: {cure}")
        return model.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "the header"
        raise UserError(f"{where}: {place}: {first['msg']}: {cure}") from None
