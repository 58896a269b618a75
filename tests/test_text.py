"""Text from files, made safe for terminals, tables and spreadsheets."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.text import csv_text, one_line, printable, with_article

ANY = st.text()


@given(ANY)
def test_nothing_that_a_terminal_obeys_is_left(text: str):
    left = {character for character in printable(text) if unicodedata.category(character) in ("Cc", "Cs")}
    assert left <= {"\n", "\t"}
    assert not set(one_line(text)) & set("\n\r\x1b\u2028\u202e")


@given(st.text(st.characters(exclude_categories=("C", "Z"))))
def test_ordinary_text_stays_as_it_is(text: str):
    assert printable(text) == one_line(text) == text


@pytest.mark.parametrize(
    ("text", "cell"),
    [
        ("eight", "eight"),
        ("=1+1", "'=1+1"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("-2+3", "'-2+3"),
        ("+1", "'+1"),
        ("\n=1", "'=1"),
        ("two\nlines", "two lines"),
        ("\x1b[31mred", "\\u001b[31mred"),
    ],
)
def test_a_spreadsheet_computes_nothing(text: str, cell: str):
    assert csv_text(text) == cell


def test_a_noun_has_its_article():
    assert (with_article("ball"), with_article("arrow")) == ("a ball", "an arrow")
