"""`python -m holdfast.pipeline.cli`."""

from .main import main

raise SystemExit(main())
