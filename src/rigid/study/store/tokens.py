"""Tokens of links: long enough that nobody guesses one, and never stored."""

from __future__ import annotations

import hashlib
import secrets

BYTES = 24
"""Of randomness; 192 bits. Ours: 128 are enough, and a link has room for 32 letters."""


def new_token() -> str:
    """A token that nobody has seen, of letters that a link can hold."""
    return secrets.token_urlsafe(BYTES)


def token_hash(token: str) -> str:
    """What is stored of it: SHA-256, from which a random token cannot be found."""
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).hexdigest()
