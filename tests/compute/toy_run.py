"""`rigid` as its users run it, with one more preset."""

from rigid.cli import main
from rigid.presets import PRESETS
from tests.compute.tiny import TINY

PRESETS[TINY.name] = TINY
if __name__ == "__main__":  # Doctests import it.
    main()
