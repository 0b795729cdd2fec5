"""Help in colours, for terminals."""

from rich_argparse import RawDescriptionRichHelpFormatter

from .help_text import help_width

__all__ = ["ColouredHelp"]


class ColouredHelp(RawDescriptionRichHelpFormatter):
    """The same words as without colours."""

    # Brackets in our words are brackets, and titles are written as they stand.
    text_markup = False
    help_markup = False
    group_name_formatter = str
    highlights = [*RawDescriptionRichHelpFormatter.highlights, r"(?P<groups>^examples:)", r"(?P<prog># .*)"]

    def __init__(self, prog: str):
        super().__init__(prog, max_help_position=28, width=help_width())
