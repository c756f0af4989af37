"""What a user allows, and adds, when a file of somebody else's making is opened as a policy."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rigid.errors import UserError


@dataclass(frozen=True, kw_only=True)
class Opening:
    """How policies of other libraries are opened; the default runs no code of theirs."""

    trust: bool = False
    """Open formats that can run code, such as pickles: only from people one trusts."""
    vecnormalize: Path | None = None
    """Statistics of Stable-Baselines3's VecNormalize that the policy was trained behind."""
    frames: int = 1
    """Observations that it sees at a time, as Stable-Baselines3's VecFrameStack stacks them."""
    named_by_user: bool = True
    """Whether the user wrote the policy's name. A name in a file is never taken for a command."""

    def need_trust(self, where: object, why: str) -> None:
        """Refuses, before anything is opened, what can run code of its maker.

        Raises:
            UserError: The user does not trust the file.
        """
        if not self.trust:
            raise UserError(
                f"{where} is {why}, which can run any code when it is opened: say --trust if you "
                "trust whoever made it, or convert it to ONNX (docs/policies.md)"
            )


SAFE = Opening()
"""Nothing is trusted, nothing is added."""
NAMED_BY_FILE = Opening(named_by_user=False)
"""For names that a file holds, such as that of a measured robot: nothing of it runs code."""
