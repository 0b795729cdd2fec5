"""`python -m holdfast`: the command line."""

from .pipeline.cli import main

raise SystemExit(main())
