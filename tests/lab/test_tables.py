"""Tables that fit the terminal, and lose nothing."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.lab.report import as_text
from sandbox.lab.stress import FAILED, HELD, Outcome, report_of
from sandbox.lab.tables import length, paragraph, table, unit_of_length

WORD = st.text("abcdefg-.", min_size=1, max_size=30)
NUMBER = st.text("0123456789", max_size=7)


@given(st.lists(st.tuples(st.lists(WORD, max_size=12).map(" ".join), NUMBER, st.lists(WORD).map(" ".join), NUMBER)))
def test_lines_fit_and_no_letter_is_lost(rows: list[tuple[str, ...]]):
    lines = table(("case", "published", "what it says", "off by"), rows, "lrlr")
    assert max(map(len, lines)) <= 80
    letters = sorted("".join("".join(line.split()) for line in lines))
    assert letters == sorted(
        "".join("".join("".join(row).split()) for row in [("casepublishedwhatitsaysoffby",), *rows])
    )


@given(st.lists(st.tuples(NUMBER, NUMBER, WORD), min_size=1))
def test_numbers_are_never_folded(rows: list[tuple[str, ...]]):
    lines = table(("", "", ""), rows, "rrl")
    for number, other, _ in rows:
        assert any(number in line and other in line for line in lines)


def test_headings_of_numbers_are_wrapped_and_no_digit_is_lost():
    names = ["launch.angle (deg)", "±", "launch.speed (m/s)", "±", "carry (m)", "±", "apex (m)", "±"]
    numbers = ["16.027061", "9e-08", "61.737761", "8e-08", "200", "3e-07", "30", "1e-07"]
    *heads, row = table(names, [numbers], "r" * 8)
    assert row.split() == numbers
    assert len(heads) == 2
    assert sorted(" ".join(heads).split()) == sorted(" ".join(names).split())
    assert max(map(len, [*heads, row])) <= 80
    row = ("p = 1, 45 deg", "carry", "23.5604720 m", "23.5604720", "-2.5e-10", "1.0e-06", "holds")
    assert table(("case", "result", "published", "computed", "off by", "allowed", ""), [row], "llrrrrl")[1].endswith(
        "23.5604720 m  23.5604720  -2.5e-10  1.0e-06  holds"
    )
    assert "".join(table(["", ""], [["1" * 60, "2" * 60]], "rr")).split() == ["1" * 60, "2" * 60]


def test_a_word_of_usual_length_is_not_broken():
    numbers = ["+0.00310", "+0.00307 to +0.00312", "0.00065", "0.00316", "+0.00525", "1017", "1.2", "3.45"]
    lines = table(("pitch_name", *"abcdefgh"), [["4-Seam Fastball", *numbers]], "l" + "r" * 8)
    assert [line.split()[0] for line in lines] == ["pitch_name", "4-Seam", "Fastball"]


def test_room_that_a_heading_gives_up_is_that_of_a_text():
    text = " ".join(["word"] * 14)
    assert table(("a heading of three words", "said"), [("1", text)], "rl")[-1] == f"        1  {text}"


def test_brackets_are_text_and_nothing_splits_a_row():
    assert table(("a", "b"), [("[red]x[/red]", "two\nlines"), ("\x1b[2J", ":smile:")], "ll") == [
        "  a             b",
        "  [red]x[/red]  two lines",
        "  \\u001b[2J     :smile:",
    ]


def test_a_wider_terminal_is_used(monkeypatch: pytest.MonkeyPatch):
    row = ("one", " ".join(["word"] * 30))
    assert len(table(("", ""), [row], "ll")) == 3
    monkeypatch.setenv("COLUMNS", "200")
    assert len(table(("", ""), [row], "ll")) == 1
    monkeypatch.setenv("COLUMNS", "20")
    assert max(map(len, table(("", ""), [row], "ll"))) <= 20


@pytest.mark.parametrize("text", ["日本語" * 60, "日本語 and " * 20])
def test_letters_as_wide_as_two_fit(text: str):
    lines = table(("", ""), [("own", text)], "ll", indent="")
    assert max(len(line) + sum(letter in "日本語" for letter in line) for line in lines) <= 80
    assert "".join("".join(lines).split()) == "own" + text.replace(" ", "")


def test_a_paragraph_fits():
    lines = paragraph("word " * 40)
    assert max(map(len, lines)) <= 80
    assert [line[: len(line) - len(line.lstrip())] for line in lines] == ["  ", "    ", "    "]


@pytest.mark.parametrize("room", range(12, 60))
def test_a_number_and_its_unit_are_on_one_line(room: int, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("COLUMNS", str(room))
    text = "dropped from 45 m at 3.2 m/s and 12 % of it, off by ± 0.4 mm"
    for lines in (paragraph(text, ""), table(("", ""), [("", text)], "ll", indent="")):
        assert " ".join(line.strip() for line in lines) == text
        for amount in ("45 m", "3.2 m/s", "12 %", "± 0.4 mm"):
            assert any(amount in line for line in lines)


def test_outcomes_of_stress_fit_80_columns():
    outcomes = [
        Outcome("golf", "all numbers at their highest", method, word, "a long message of why " * 5)
        for method in ("semi-implicit-euler", "plain")
        for word in (HELD, FAILED)
    ]
    assert max(map(len, as_text(report_of(outcomes)))) <= 80


def test_a_column_without_text_takes_no_room():
    assert table(("", "", ""), [("24.30 s", "stone", "")], "rll") == ["  24.30 s  stone"]
    assert table(("a", "b"), [], "ll") == ["  a  b"]


@pytest.mark.parametrize("metres", [2500.0, 1.0, 0.02, 0.003, 4e-6, 7e-9])
def test_an_axis_and_a_table_have_the_same_unit_of_length(metres: float):
    unit, factor = unit_of_length(metres)
    assert length(metres) == f"{metres * factor:g} {unit}"
