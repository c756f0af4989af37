"""`rigid` as its users run it, with one more preset and the referees of the toy measurements."""

import pytest

from rigid.cli import main
from rigid.presets import PRESETS
from tests.compute.tiny import TINY, hasten_referees

if __name__ == "__main__":  # Doctests import it.
    PRESETS[TINY.name] = TINY
    hasten_referees(pytest.MonkeyPatch())
    main()
