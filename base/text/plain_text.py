"""Text fit to be shown: of others, without control characters or what turns it round; counts."""

__all__ = ["counted", "one_line", "printable", "printable_lines", "shortened"]


def printable(text: str) -> str:
    """The text with question marks for what doesn't print, which a name from a file might hold."""
    return text if text.isprintable() else "".join(c if c.isprintable() else "?" for c in text)


def printable_lines(text: str) -> str:
    """The same of each line; the breaks between them stay."""
    return "\n".join(map(printable, text.split("\n")))


def one_line(text: str) -> str:
    """The text in a single line that no terminal misreads: what does not print is escaped."""
    text = " ".join(text.split())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def shortened(text: str, longest: int) -> str:
    """The text, or where that is too long its beginning and its end."""
    if len(text) <= longest:
        return text
    return f"{text[: longest // 2]} ... {text[-longest // 2 :]}"


def counted(number: int, one: str, more: str = "") -> str:
    """A number of things: `counted(2, "grasp")` is `2 grasps`; `more` where an s doesn't make many of one."""
    return f"{number} {one if number == 1 else more or one + 's'}"
