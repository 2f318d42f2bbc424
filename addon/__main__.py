"""Command line as a module: ``python -m firetwin`` is ``firetwin``."""

import sys

from .cli import main

sys.exit(main())
