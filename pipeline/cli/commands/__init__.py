"""A room for each group of commands; the modules here are what several of them share.

A command is two modules: one with `EXAMPLES` and `add_options(parser)`, one with `main(arguments)`, which
returns an exit code.
"""
