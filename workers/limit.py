"""A bound on how long a process may work at a job."""

__all__ = ["TimeOver"]


class TimeOver(Exception):
    """A job took longer than it may, and the process that worked on it was ended.

    Attributes:
        limit_s: how long it might.
    """

    def __init__(self, limit_s: float):
        super().__init__(limit_s)  # from which it is made again in another process
        self.limit_s = limit_s

    def __str__(self) -> str:
        return f"did not end within {self.limit_s:.0f} s"
