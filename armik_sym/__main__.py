"""`python -m armik_sym`: the command `armik`."""

from armik_sym.cli import main

if __name__ == "__main__":
    main()
