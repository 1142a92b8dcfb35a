"""The command line as `python -m decomp`."""

import sys

from decomp.cli.main import main

sys.exit(main())
