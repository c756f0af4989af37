"""`python -m rigid`: the same commands as `rigid`."""

from rigid.cli import main

if __name__ == "__main__":
    main()
