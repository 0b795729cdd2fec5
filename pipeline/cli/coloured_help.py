"""Help in colours, for terminals."""

from rich_argparse import RawDescriptionRichHelpFormatter

__all__ = ["ColouredHelp"]


class ColouredHelp(RawDescriptionRichHelpFormatter):
    """The same words as without colours."""

    # Brackets in our words are brackets, and titles are written as they stand.
    text_markup = False
    help_markup = False
    group_name_formatter = str
    highlights = [*RawDescriptionRichHelpFormatter.highlights, r"(?P<groups>^examples:)", r"(?P<prog># .*)"]
