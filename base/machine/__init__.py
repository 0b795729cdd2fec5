"""The machine: compiled code, clocks, renderers, packages that need not be there."""
