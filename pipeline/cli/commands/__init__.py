"""One module a command; each has `main(arguments)` that returns an exit code."""
