"""`holdfast completion SHELL`."""

import argparse

from .....base.text.console import emit
from .....errors import HoldfastError
from ...completions import completions

__all__ = ["main"]

# Each asks for the words that could stand at the cursor, and takes names of files where there are none.
_SCRIPTS = {
    "bash": """\
_holdfast() {
    local IFS=$'\\n'
    COMPREPLY=($("${COMP_WORDS[0]}" completion words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _holdfast holdfast""",
    "zsh": """\
#compdef holdfast
_holdfast() {
    local -a found
    found=(${(f)"$("${words[1]}" completion words "${(@)words[2,CURRENT]}" 2>/dev/null)"})
    if (( $#found )); then compadd -a found; else _files; fi
}
if [ "$funcstack[1]" = "_holdfast" ]; then _holdfast "$@"; else compdef _holdfast holdfast; fi""",
    "fish": """\
function __holdfast_words
    set -l words (commandline -opc)
    $words[1] completion words $words[2..] (commandline -ct) 2>/dev/null
end
complete -c holdfast -a "(__holdfast_words)\"""",
}


def main(arguments: argparse.Namespace) -> int:
    """Prints the script that a shell reads, or answers what such a script asks."""
    if arguments.shell == "words":
        found = completions(arguments.words)
        if found:
            emit("\n".join(found))
        return 0
    if arguments.words:
        raise HoldfastError(f"completion: unknown argument {arguments.words[0]!r}")
    emit(_SCRIPTS[arguments.shell])
    return 0
