"""Code in colours: cut, and put together again, it is the same code."""

import pytest

from notebook_reports.export.write import highlighting

CODE = 'def f(x):  # half\n    return "a" + str(0.5 * x)\n\n\nf(2)'


@pytest.mark.parametrize("language", ["python", "ipython3", "c", "json", "", "no-such-language"])
def test_nothing_of_the_code_is_lost(language):
    assert "".join(text for _, text in highlighting.runs(CODE, language)) == CODE
    assert ["".join(t for _, t in row) for row in highlighting.highlighted_lines(CODE, language)] == CODE.split("\n")


def test_each_kind_has_its_class():
    seen = {text.strip(): kind for kind, text in highlighting.runs(CODE, "ipython3")}
    assert seen["def"] == "k" and seen["f"] == "f" and seen["# half"] == "c"
    assert seen['"a"'] == "s" and seen["0.5"] == "n"
    assert highlighting.runs(CODE, "no-such-language") == (("", CODE),)
