"""Names: what may stand in generated C, and what may not."""

from __future__ import annotations

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm.names import check_identifier
from armik_sym.errors import ArmModelError

LETTERS = string.ascii_letters
REST = LETTERS + string.digits + "_"
C99_KEYWORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int long
    register restrict return short signed sizeof static struct switch typedef union unsigned void volatile
    while
""".split()


@pytest.mark.parametrize("name", ["a", "q1", "elbow_flexion", "Int", "INT", "integer", "a_", "a" * 63])
def test_plain_identifiers_come_back_unchanged(name):
    assert check_identifier(name, "joint") == name


@pytest.mark.parametrize(
    "name",
    [
        *("elbow-flexion", "x;y", "x y", "", " ", "é", "_x", "1x", "a" * 64, "a\n", "a\0", "ａ", "q₁", "a.b"),
        *(5, 1.5, None, True, b"elbow", ["elbow"]),
    ],
)
def test_anything_else_is_refused_with_the_name_and_what_is_allowed(name):
    with pytest.raises(ArmModelError) as caught:
        check_identifier(name, "segment length")
    message = str(caught.value)
    assert message.startswith(f"segment length name {name!r} ")
    assert "1 to 63 ASCII letters, digits and underscores" in message


@pytest.mark.parametrize("name", C99_KEYWORDS)
def test_c_keywords_are_refused(name):
    with pytest.raises(ArmModelError, match=f"'{name}'.*no C keyword"):
        check_identifier(name, "joint")


@given(st.text(max_size=70))
def test_a_name_is_accepted_exactly_if_every_character_is_allowed(name):
    plain = 1 <= len(name) <= 63 and name[0] in LETTERS and all(c in REST for c in name)
    if plain and name not in C99_KEYWORDS:
        assert check_identifier(name, "arm") == name
    else:
        with pytest.raises(ArmModelError):
            check_identifier(name, "arm")


@given(st.sampled_from(LETTERS), st.text(alphabet=REST, max_size=62))
def test_letters_digits_and_underscores_are_enough(first, rest):
    name = first + rest
    if name not in C99_KEYWORDS:
        assert check_identifier(name, "arm") == name
