"""XML of others as a tree: nothing in it grows when it is read, and no other file is reached."""

from typing import Any
from xml.etree import ElementTree
from xml.parsers import expat

__all__ = ["parse_xml"]


def parse_xml(data: bytes) -> ElementTree.Element:
    """The root of a document, which may declare neither a type nor entities.

    Raises:
        ValueError: it does.
        expat.ExpatError: it is no XML.
    """

    def refuse(*_: Any) -> None:
        raise ValueError("a document type or entities are not accepted")

    parser, builder = expat.ParserCreate(), ElementTree.TreeBuilder()
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.buffer_text = True
    parser.Parse(data, True)
    return builder.close()
