"""The command line: `holdfast COMMAND`, one module for each command."""

from .main import main

__all__ = ["main"]
