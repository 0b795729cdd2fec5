"""Checks what a grasp file says was proved of its grasp, in arithmetic and with geometry of its own.

The file holds forces and planes. Where the contacts truly are, and that they hold there at all, is worked out
here from the file's numbers and the task's; so are the grasp matrix, the way of the fingers, and what the
forces and planes then show. Wrong hints make a check fail, and never make a false statement pass.
"""

from .check import GraspCheck, check_grasp

__all__ = ["GraspCheck", "check_grasp"]
