"""`python -m twin`: the same as `twin`."""

import sys

from twin.cli import main

sys.exit(main())
