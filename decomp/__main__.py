"""The command line as `python -m decomp`."""

from decomp.cli.main import program

program()
