"""Numbers for people, with so many digits that count."""

__all__ = ["significant"]


def significant(value: float, digits: int) -> str:
    """A number rounded to so many significant digits: 100 and not 1e+02; exponents only where they are short.

    Args:
        value: the number.
        digits: how many digits count.
    """
    # Adding zero turns a -0 into 0; fifteen digits write what was rounded without more rounding.
    return f"{float(f'{value:.{digits}g}') + 0.0:.15g}"
