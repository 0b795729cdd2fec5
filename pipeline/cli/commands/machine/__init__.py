"""This machine and other programs: the shell, and what Holdfast finds here."""
