"""What people write on a command line, as numbers."""

from __future__ import annotations

import math

from rigid.errors import UserError


def parse_seeds(text: str | None) -> tuple[int, ...] | None:
    """Seeds as `0,1,2`, `0..9` (ends included) or both; None stays None.

    Example:
        >>> parse_seeds("0..2,7")
        (0, 1, 2, 7)
        >>> parse_seeds("8")
        (8,)
    """
    if text is None:
        return None
    seeds: list[int] = []
    for part in text.split(","):
        first, dots, last = part.strip().partition("..")
        try:
            ends = int(first), int(last) if dots else int(first)
        except ValueError:
            raise UserError(
                f"--seeds {text!r}: {part.strip()!r} is no seed; write 0,1,2 or 0..9"
            ) from None
        if ends[1] < ends[0]:
            raise UserError(f"--seeds {text!r}: {part.strip()!r} runs backwards; write 0..9")
        seeds += range(ends[0], ends[1] + 1)
    if min(seeds) < 0 or len(set(seeds)) != len(seeds):
        raise UserError(f"--seeds {text!r} must be distinct and not negative")
    return tuple(seeds)


def parse_lambdas(text: str | None) -> tuple[float, ...] | None:
    """Weights as `0,0.01,1,inf`; None stays None.

    Example:
        >>> parse_lambdas("0,0.01,inf")
        (0.0, 0.01, inf)
    """
    if text is None:
        return None
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        raise UserError(f"--lambdas {text!r}: write numbers as 0,0.01,1,inf") from None
    if any(math.isnan(value) or value < 0 for value in values):
        raise UserError(f"--lambdas {text!r}: a weight is 0 or more, or inf")
    if len(set(values)) != len(values):
        raise UserError(f"--lambdas {text!r} names a weight twice")
    return values


_UNITS = {"s": 1.0, "m": 60.0, "h": 3600.0}


def parse_budget(text: str | None, option: str = "--budget") -> float | None:
    """A time as `90s`, `30m` or `2h`, in seconds; None stays None.

    Args:
        text: What the user wrote.
        option: Where; for the message.

    Example:
        >>> parse_budget("30m")
        1800.0
    """
    if text is None:
        return None
    number, unit = text[:-1], text[-1:]
    try:
        seconds = float(number) * _UNITS[unit]
    except (ValueError, KeyError):
        raise UserError(f"{option} {text!r}: write a time as 90s, 30m or 2h") from None
    if not 0 < seconds < math.inf:
        raise UserError(f"{option} {text!r} must be more than nothing")
    return seconds


def parse_expected(text: str | None) -> tuple[float, float] | None:
    """A mean and what it may differ by, as `431±15` or `431+-15`; None stays None.

    Example:
        >>> parse_expected("-4.5+-0.5")
        (-4.5, 0.5)
    """
    if text is None:
        return None
    mean, _, tolerance = text.replace("+-", "±").partition("±")
    try:
        numbers = float(mean), float(tolerance)
    except ValueError:
        raise UserError(f"--expect-return {text!r}: write it as 431±15 or 431+-15") from None
    if not (math.isfinite(numbers[0]) and 0 <= numbers[1] < math.inf):
        raise UserError(f"--expect-return {text!r} must be finite, and its tolerance 0 or more")
    return numbers


def at_least(option: str, value: int, least: int) -> None:
    """Refuses a count that is too small.

    Raises:
        UserError: The message names option and value.
    """
    if value < least:
        raise UserError(f"{option} is {value}, but must be at least {least}")


def parse_counts(option: str, text: str, *, least: int) -> tuple[int, ...]:
    """Whole numbers as `5,10,20`, distinct and sorted.

    Args:
        option: Where they stand; for the message.
        text: What the user wrote.
        least: The smallest number that makes sense.

    Example:
        >>> parse_counts("--raters", "20,5,10", least=2)
        (5, 10, 20)
    """
    try:
        counts = tuple(sorted({int(part) for part in text.split(",")}))
    except ValueError:
        raise UserError(f"{option} {text!r}: write whole numbers as 5,10,20") from None
    at_least(option, counts[0], least)
    return counts


def spoken(seconds: float) -> str:
    """A duration as people say it.

    Example:
        >>> spoken(45), spoken(200), spoken(8000)
        ('45 s', '3 min', '2 h 13 min')
    """
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def printable(text: str) -> str:
    r"""A stranger's text for the terminal: control characters become escapes.

    Example:
        >>> print(printable("a\x1b[2Jb"))
        a\x1b[2Jb
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
