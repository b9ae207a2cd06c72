"""What a notebook can hold comes out in both formats, or fails by the name of its cell; nothing vanishes."""

import re
from html import unescape

import pytest
import sympy

from notebook_reports.display import Equation, Figure, Table
from notebook_reports.export.exporters.choose import ExportError, export

pytestmark = pytest.mark.builds


def words_of(page):
    return unescape(re.sub(r"<[^>]+>", "", page))


def comes_out(make, nb, *texts):
    source, page = make.typst(nb), words_of(make.html(nb))
    for text in texts:
        assert text in source, text
        assert text in page, text
    return source


def fails(make, nb, *texts, formats=("pdf", "html"), **particulars):
    for form in formats:
        with pytest.raises(ExportError) as caught:
            export(nb, form, name="folder/sample", **particulars)
        for text in texts:
            assert text in str(caught.value), text
    return caught.value


def test_pipe_table(make):
    nb = make.notebook("| quantity | value |\n|:--|--:|\n| flow $Q$ | 0.5 |\n| volume | 12.5 |")
    source = comes_out(make, nb, "quantity", "volume", "12.5")
    assert "#data-table(" in source and 'body: [#"12.5";]' in source
    assert "<table>" in make.html(nb) and '<td class="right">12.5</td>' in make.html(nb)


def test_pipe_table_torn_by_a_bar_in_mathematics_is_refused(make):
    nb = make.notebook("# T", "| a | b |\n|---|---|\n| $|x|$ | 2 |")
    fails(make, nb, "folder/sample, cell 2: a pipe table whose rows have different numbers of cells", "\\vert")


@pytest.mark.parametrize("text", ["åäö ÅÄÖ", "ą ę ł ż ź ć ń ó", "≈ ≤ ✓", "ψ β", "− – — …", "ℝ ∞ ∑", "☐ ☑ ✗ ◆"])
def test_letters_and_signs(make, text):
    comes_out(make, make.notebook(f"# {text}\n\n{text} **{text}** `{text}`", make.code(make.stream(text))), text)


def test_a_character_no_font_has_is_refused_with_its_cell_and_code(make):
    nb = make.notebook("# T", "fine", "and 水 here")
    error = fails(make, nb, "folder/sample, cell 3: no font of the report has '水' (U+6C34)", formats=["pdf"])
    assert error.cell == 3


def test_a_character_no_font_has_inside_a_drawing_is_refused_with_its_cell(make):
    drawing = Figure(make.svg.replace("ψ", "水"), "Caption", "Alt")
    fails(make, make.notebook("# T", make.code(drawing)), "folder/sample, cell 2: no font", formats=["pdf"])


def test_text_of_a_drawing_in_an_unknown_font_does_not_vanish(make):
    from notebook_reports.export.write.svg_fonts import with_known_fonts

    plain = '<svg xmlns="http://www.w3.org/2000/svg"><text>words</text></svg>'
    styled = plain.replace("<text>", '<text style="font: 10px Helvetica, serif; fill: red">')
    attribute = plain.replace("<text>", "<text font-family='Courier New'>")
    assert b'<svg font-family="DejaVu Sans"' in with_known_fonts(plain.encode())
    assert b"Helvetica, serif, 'Libertinus Serif'; fill" in with_known_fonts(styled.encode())
    assert b"Courier New, DejaVu Sans Mono" in with_known_fonts(attribute.encode())
    known = make.svg.encode()
    assert b"'DejaVu Sans', sans-serif\"" in with_known_fonts(known)


def test_figure(make):
    nb = make.notebook(make.code(Figure(make.svg, "A caption with $x^2$.", "What it shows")))
    source, page = make.typst(nb), make.html(nb)
    assert '"What it shows"' in source and '"Figure 1"' in source and "A caption with " in source
    assert 'aria-label="What it shows"' in page and "Drawn words ψ" in page and "<b>Figure 1.</b>" in page


def test_equation_of_three_hundred_characters_breaks_into_lines(make):
    x, y = sympy.symbols("x y")
    long = sum(sympy.Rational(i + 1, i + 2) * x**i * y / (i + 1) for i in range(16))
    latex = sympy.latex(sympy.Eq(y, long))
    assert len(latex) > 300
    source = make.typst(make.notebook(f"$${latex} \\tag{{7}}$$", make.code(Equation(latex, "4.9", "doc"))))
    assert '"(7)"' in source and '"(4.9)"' in source and 'label("eq-doc-4.9")' in source


def test_a_formula_that_fits_nowhere_is_refused(make):
    wide = r"\frac{" + " + ".join(f"a_{{{i}}} b_{{{i}}}" for i in range(60)) + "}{c}"
    fails(
        make, make.notebook("# T", f"$${wide}$$"), "cell 2: a formula is too wide", "write it narrower", formats=["pdf"]
    )


def test_mathematics_finds_its_own_functions(make):
    accents = r"\dot{y} = \hat{x} + \bar{z}, \underbrace{a}_{b}, \sqrt[3]{c}, \binom{n}{k}"
    assert "accent(" in make.typst(make.notebook(f"${accents}$ and $${accents}$$"))


def test_formulas_inside_a_line_fit_the_line_or_fail_by_name(make):
    sums = " + ".join(f"a_{{{i}}} b_{{{i}}}" for i in range(60))
    assert "#long-m(" in make.typst(make.notebook(f"breaks: ${sums}$"))
    fails(
        make,
        make.notebook("# T", f"not: $\\frac{{{sums}}}{{c}}$"),
        "cell 2: a formula inside a line is",
        formats=["pdf"],
    )


def test_wide_matrix_is_scaled(make):
    matrix = sympy.latex(sympy.Matrix(3, 9, lambda i, j: sympy.Symbol("x") ** (i + j) / (j + 2)))
    assert "mat(" in make.typst(make.notebook(f"$$M = {matrix}$$"))


def table(columns, rows=4, width=6):
    head = [f"column {i}" for i in range(columns)]
    return Table(head, [[round(j * i * 1.2345, width) for j in range(columns)] for i in range(rows)], "Wide")


def test_table_of_twelve_columns_fits(make):
    comes_out(make, make.notebook(make.code(table(12))), "column 11", "Wide")


def test_table_of_sixty_columns_fails_by_name(make):
    fails(make, make.notebook("# T", make.code(table(60))), "cell 2: Table 1 is too wide", formats=["pdf"])
    assert "column 59" in words_of(make.html(make.notebook(make.code(table(60)))))


def test_long_texts_in_a_table_are_wrapped(make):
    words = "a statement that goes on for so long that its column has to wrap it, with $K_p (1 + T_d s)$ and `code(x)` "
    rows = [["section 5.2.3", words * 2, words, "holds partly"], ["Figure 4.9 (caption)", "short", "x" * 60, "holds"]]
    claims = Table(
        ["place", "the document says", "computed", "verdict"], rows, "Claims", ["left"] * 4, [words], ["note", "good"]
    )
    source = comes_out(make, make.notebook(make.code(claims)), "holds partly")
    assert '[#"statement";]' in source and f'[#"{"x" * 20}";]' in source, "what a column must hold is measured"


def test_table_over_several_pages(make):
    comes_out(make, make.notebook(make.code(table(3, rows=300))), "column 2", "738.23")


def test_listing_of_two_hundred_lines_and_a_line_without_spaces(make):
    source = "\n".join(f"value_{i} = compute({i})" for i in range(200)) + '\nlong = "' + "x" * 300 + '"'
    text = make.typst(make.notebook(make.code(source=source)))
    assert "value_199 = compute(199)" in text and "x" * 300 in text


def test_dataframe_with_spans(make):
    import pandas

    columns = pandas.MultiIndex.from_product([["first", "second"], ["x", "y"]])
    index = pandas.MultiIndex.from_product([["q"], [1, 2, 3]], names=["n", "m"])
    frame = pandas.DataFrame([[1.5, 2, 3, 4.25]] * 3, columns=columns, index=index)
    nb = make.notebook(make.code({"text/html": frame._repr_html_(), "text/plain": repr(frame)}))
    source = comes_out(make, nb, "second", "4.25")
    assert "colspan: 2" in source and "rowspan: 3" in source
    assert 'colspan="2"' in make.html(nb) and 'rowspan="3"' in make.html(nb)


def test_dataframe_of_thirty_columns(make):
    import pandas

    frame = pandas.DataFrame([[i * 1.5 for i in range(30)]] * 3)
    nb = make.notebook(make.code({"text/html": frame._repr_html_(), "text/plain": repr(frame)}))
    assert "#landscape[" in comes_out(make, nb, "43.5")


def test_html_only_output_with_mathematics(make):
    system = "&lt;TransferFunction sys: ['u'] -&gt; ['y']&gt;\n$$\\dfrac{1}{s^2 + 2 s + 1}$$"
    nb = make.notebook(make.code({"text/html": system, "text/plain": "G"}))
    source = comes_out(make, nb, "<TransferFunction sys: ['u'] -> ['y']>")
    assert "#formula(" in source and "<mfrac>" in make.html(nb)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        ({"text/html": "<script>draw()</script>", "text/plain": "x"}, "<script>"),
        ({"text/html": "<iframe src='x'></iframe>"}, "<iframe>"),
        ({"text/html": "<p>a</p><canvas></canvas>"}, "<canvas>"),
        ({"text/html": "<form><input></form>"}, "<form>"),
        ({"application/javascript": "draw()", "text/plain": "x"}, "script"),
        ({"application/x-unknown": "?"}, "only as application/x-unknown"),
        ({"text/plain": "x" * 5_000_000}, "5.0 million characters"),
        ({"image/png": "not base64!"}, "damaged"),
        ({"image/png": "AAAA"}, "says it is PNG"),
        ({"image/svg+xml": "<svg><g></svg>"}, "cannot be read"),
        ({"image/svg+xml": '<svg xmlns:x="u"><image x:href="http://a/b.png"/></svg>'}, "another file"),
        ({"image/svg+xml": "<svg><script>1</script></svg>"}, "<script>"),
        ({"text/latex": r"$\fracc{1}{2}$"}, r"\fracc"),
    ],
)
def test_output_that_cannot_be_shown_fails_by_name(make, data, told):
    fails(make, make.notebook("# T", "text", make.code(data)), "folder/sample, cell 3: ", told, strict_alt=False)


def test_five_megabytes_of_picture_are_no_problem(make):
    drawing = make.svg.replace("</svg>", '<path d="M0 0' + " L1 1" * 1_000_000 + '"/></svg>')
    assert len(export(make.notebook(make.code(Figure(drawing, "c", "a"))), "html", name="x/y")) > 5_000_000


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("$$x = \\fracc{1}{2}$$", "unknown command \\fracc: did you mean \\frac"),
        ("so $\\frac{1}{$ ends", "a formula:"),
        ("$x \\unknowncommand y$", "\\unknowncommand"),
        ("![shown](missing.png)", "no image missing.png; it is looked for beside the notebook"),
        ("![shown](attachment:a.png)", "attachment 'a.png' is missing"),
        ("![shown](https://example.org/a.png)", "is on the network"),
        ("![shown](notes.txt)", "is none of"),
        ("![](data:image/png;base64,AAAA)", "no alternative text"),
        ("[there](#nowhere)", "a link to #nowhere, which is nowhere in this notebook"),
        ("[there](missing.csv)", "which is not beside the notebook"),
        ("[there](file:///etc/passwd)", "which a report cannot follow"),
        ("[there](javascript:alert(1))", "which a report cannot follow"),
        ("<iframe src='x'></iframe>", "<iframe>"),
        ("text <video src='x'></video> text", "<video"),
        ("text <b>bold", "not closed"),
        ("$$a \\tag{1} \\tag{2}$$", "a second \\tag"),
    ],
)
def test_markdown_that_cannot_be_shown_fails_by_name(make, tmp_path, text, told):
    (tmp_path / "notes.txt").write_text("x")
    fails(make, make.notebook("# T", text), "folder/sample, cell 2: ", told, assets=tmp_path)


def test_all_problems_of_a_notebook_are_named_at_once(make):
    nb = make.notebook("# T", "$\\fracc$ and $\\gammma$", "![x](gone.png)", make.code({"text/html": "<canvas>"}))
    first = fails(
        make, make.notebook("# T", "![x](gone.png)", make.code({"text/html": "<canvas>"})), "cell 2", "cell 3"
    )
    assert [problem.cell for problem in first.problems] == [2, 3]
    assert (first.notebook, first.cell) == ("folder/sample", 2)
    assert "gone.png" in str(fails(make, nb, "cell 3"))


def test_streams_errors_and_control_characters(make):
    nb = make.notebook(
        make.code(
            make.stream("10 %\r100 %\n\x1b[31mred\x1b[0m\n"),
            make.stream("tail\x07\n"),
            make.stream("careful\n", "stderr"),
            make.error("\x1b[1mTraceback\x1b[0m", "ValueError: no"),
        )
    )
    source = comes_out(make, nb, "careful", "ValueError: no")
    assert 'tail\\\\x07"' in source and "tail\\x07" in make.html(nb)
    assert "100 %\\nred\\ntail" in source and "\x1b" not in source and "10 %\\r" not in source


def test_nothing_of_a_notebook_is_markup(make):
    hostile = '#panic("a") $x$ @ref <lab> \\ ` * _ = - // /* */ ]) #{'
    nb = make.notebook(
        make.code(make.stream(hostile), source=hostile),
        make.code(Table([hostile.replace("$", "\\$").replace("`", "'")], [["</td><script>"]], "c")),
    )
    page = make.html(nb)
    assert "<script>" not in page and "&lt;/td&gt;&lt;script&gt;" in page
    assert 'panic(\\"a\\")' in make.typst(nb)


def test_tags(make):
    shown = make.code(make.stream("output one"), source="first()", tags=["remove-input"])
    silent = make.code(make.stream("output two"), source="second()", tags=["remove-output"])
    gone = make.code(make.stream("output three"), source="third()", tags=["remove-cell"])
    source = make.typst(make.notebook(shown, silent, gone))
    assert [t in source for t in ("output one", "first()", "output two", "second()", "third")] == [
        True,
        False,
        False,
        True,
        False,
    ]


def test_every_block_of_markdown(make, tmp_path):
    (tmp_path / "a.png").write_bytes(make.png())
    text = """# Title with $x$

Soft
break, hard  
break, *emphasis*, **strong**, ~~struck~~, `code`, https://example.org/a_b, a note[^n] and again[^n].

## Section

1. one
   - nested $x^2$

     second paragraph
2. two

- [ ] open
- [x] done

> quoted

term
: meaning

    indented code

```python
fenced = 1
```

***

![described](a.png)

Inline ![tiny](a.png) picture. H<sub>2</sub>O <a id="spot"></a> <!-- comment -->

\\begin{align}
a &= b \\\\
c &= d
\\end{align}

[^n]: The note's text.
"""
    nb = make.notebook(text)
    source = make.typst(nb, folder=tmp_path)
    for piece in (
        "#emph[",
        "#strong[",
        "#strike[",
        "#code(",
        "#outer(",
        "#footnote[",
        "#section(1",
        "#enum(",
        "#list(",
    ):
        assert piece in source, piece
    for piece in ("#task(true)", "#quoted[", "#terms(", "#thematic-break()", "#drawing(", "#inline-picture(", "#sub["):
        assert piece in source, piece
    assert "comment" not in source and 'label("spot")' in source
    page = make.html(nb, assets=tmp_path)
    for piece in (
        "<em>",
        "<strong>",
        "<s>",
        "<ol>",
        "<ul>",
        'type="checkbox" disabled checked',
        "<blockquote>",
        "<dl>",
    ):
        assert piece in page, piece
    for piece in (
        "<hr>",
        'alt="described"',
        "<sub>2</sub>",
        'id="spot"',
        'role="doc-endnotes"',
        "<mtable",
        "The note's text.",
    ):
        assert piece in page, piece
