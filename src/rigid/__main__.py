"""`python -m rigid`: the same commands as `rigid`."""

from rigid.cli import main

main()
