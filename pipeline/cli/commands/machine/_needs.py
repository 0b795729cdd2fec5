"""Which libraries the installation asks for, and which of them are here."""

import re
from dataclasses import dataclass
from importlib import metadata

__all__ = ["Need", "needs", "numbers", "version_of"]


@dataclass(frozen=True)
class Need:
    """A library that the installation asks for.

    Attributes:
        name: of the library.
        bounds: of its version, such as `>=3.17,<4`.
        extra: the extra that asks for it; None where everything does.
    """

    name: str
    bounds: str
    extra: str | None

    @property
    def installed(self) -> str | None:
        """The version that is here."""
        return version_of(self.name)

    @property
    def is_met(self) -> bool:
        """Whether it is here, within its bounds."""
        if self.installed is None:
            return False
        have = numbers(self.installed)
        for sign, bound in re.findall(r"(>=|<)([\d.]+)", self.bounds):
            if (have < numbers(bound)) == (sign == ">="):
                return False
        return True


def needs() -> list[Need]:
    """What the installation asks for; nothing where it is run from its sources."""
    try:
        lines = metadata.requires("holdfast") or []
    except metadata.PackageNotFoundError:
        lines = []
    found = []
    for line in lines:
        what, _, marker = line.partition(";")
        name = re.match(r"[\w.-]+", what.strip())
        extra = re.search(r"extra\s*==\s*['\"]([\w-]+)['\"]", marker)
        if name is not None:
            found.append(Need(name[0], what.strip()[len(name[0]) :].strip(), extra[1] if extra else None))
    return found


def version_of(name: str) -> str | None:
    """The version of a library; None where it is not installed."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def numbers(version: str) -> tuple[int, ...]:
    """The numbers of a release, three at least."""
    found = [int(part) for part in re.findall(r"\d+", version.partition("+")[0])[:4]]
    return tuple(found + [0] * (3 - len(found)))
