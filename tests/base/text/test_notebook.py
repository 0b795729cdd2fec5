"""Tables are well formed, whatever is in them."""

from xml.etree import ElementTree

from holdfast.base.text.notebook import html_table


def parsed(html: str) -> ElementTree.Element:
    return ElementTree.fromstring(f"<div>{html}</div>")


def test_text_is_escaped_and_numbers_are_short() -> None:
    table = parsed(html_table("a < b & c", ["<script>", "x"], [["</td>", 1 / 3], ["&amp;", 2]]))
    assert table.findtext("p") == "a < b & c"
    assert [cell.text for cell in table.iter("th")] == ["<script>", "x"]
    assert [cell.text for cell in table.iter("td")] == ["</td>", "0.333333", "&amp;", "2"]


def test_no_rows_no_table() -> None:
    assert parsed(html_table("nothing", ["x"], [])).find("table") is None


def test_long_tables_end_with_what_is_left_out() -> None:
    table = parsed(html_table("many", ["k"], ([k] for k in range(170))))
    assert len(list(table.iter("td"))) == 50
    assert [p.text for p in table.iter("p")] == ["many", "and 120 more"]
