"""Truths under seal: a salted digest is published first, the truth itself after the forecasts."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping
from typing import Any

__all__ = ["opened", "sealed"]


def sealed(truth: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Return a truth with a salt, to be kept, and the digest that is published.

    Parameters
    ----------
    truth : mapping
        Plain data.
    """
    kept = {**truth, "salt": secrets.token_hex(16)}
    return kept, digest_of(kept)


def opened(kept: Mapping[str, Any], digest: str) -> bool:
    """Whether a truth is the one of which the digest was published."""
    return digest_of(kept) == digest


def digest_of(kept: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a truth with its salt, 64 hexadecimal digits."""
    text = json.dumps(kept, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()
