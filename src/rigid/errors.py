"""Errors that a user can cause and mend."""

from __future__ import annotations

from typing import ClassVar


class UserError(Exception):
    """Bad input. The message names the bad value and the cure; commands print it and exit 2.

    Example:
        >>> raise UserError("--seeds 0.5 is no seed: give whole numbers, such as 0,1,2 or 0..9")
        Traceback (most recent call last):
        rigid.errors.UserError: --seeds 0.5 is no seed: give whole numbers, such as 0,1,2 or 0..9
    """

    exit_code: ClassVar[int] = 2
