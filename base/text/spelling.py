"""The known name that a misspelt one was meant to be."""

from collections.abc import Iterable

__all__ = ["nearest_name"]

# Of a name so long, every third letter may be wrong; what differs more is another word.
_LETTERS_A_SLIP = 3
# A name cut short is taken for the whole one from so many letters on.
_SHORTEST_BEGINNING = 3
# Comparing takes quadratic time, and nobody misspells a name at such length.
_LONGEST = 64


def nearest_name(name: str, known: Iterable[str]) -> str | None:
    """The known name nearest to `name`; None where none means the same with a slip of the pen.

    A slip is a letter that is wrong, missing, too many or in the place of its neighbour, and so is the
    beginning of a name alone, half a name more, or a group before it. Dashes before it and case do not count:
    `help` means `--help`.

    Args:
        name: as it was written.
        known: the names that there are.
    """
    names, bare = tuple(known), _bare(name)
    longer = [other for other in names if _bare(other).startswith(bare)]
    if longer and len(bare) >= _SHORTEST_BEGINNING:
        return min(longer, key=len)
    # A name with a group that it is not in, such as `paper/playing` for `playing`.
    _, slash, last = bare.rpartition("/")
    if slash and (same := [other for other in names if _bare(other) == last]):
        return same[0]
    # Of a single letter there is no slip, for any other would do.
    best, least = None, max(len(bare) > 1, len(bare) // _LETTERS_A_SLIP) + 1
    for other in names:
        slips = _slips(bare, _bare(other), least)
        if slips < least:
            best, least = other, slips
    if best is not None:
        return best
    # A name that goes on where the known one ends, such as `inch` for `in`.
    shorter = [
        other for other in names if bare.startswith(_bare(other)) and 2 * len(_bare(other)) >= len(bare)
    ]
    return max(shorter, key=len, default=None)


def _bare(name: str) -> str:
    return name[:_LONGEST].lstrip("-").casefold()


def _slips(a: str, b: str, limit: int) -> int:
    """The fewest slips that make `b` of `a`, as far as they are fewer than `limit`."""
    if abs(len(a) - len(b)) >= limit:
        return limit
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        earlier, before, row = before, row, [i]
        for j, y in enumerate(b, start=1):
            slips = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and y == a[i - 2]:
                slips = min(slips, earlier[j - 2] + 1)
            row.append(slips)
        if min(row) >= limit:
            return limit
    return min(row[-1], limit)
