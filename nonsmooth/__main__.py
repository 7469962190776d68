"""``python -m nonsmooth``: the command line."""

import sys

from nonsmooth.cli.main import main

sys.exit(main())
