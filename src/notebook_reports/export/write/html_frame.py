"""What frames a report on the screen: the bar with the ways to other pages, the contents, the way onward."""

from html import escape

from notebook_reports.export.around import Around, Door
from notebook_reports.export.model import Heading, Report, plain, words_only
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.write.html import HtmlWriter


def bar(around: Around | None, contents: bool) -> str:
    """The bar at the head of the page, in view all the time. contents: does the page have a list of them?"""
    if around is None:
        return ""
    parts = []
    if around.home:
        words = f'<span class="full">{_words(around.home)}</span><span class="short">Index</span>'
        parts.append(f'<a class="home" rel="up" href="{escape(around.home.url)}">{words}</a>')
    for door, name, arrow, told in (
        (around.before, "prev", "‹", "the chapter before"),
        (around.after, "next", "›", "the next chapter"),
    ):
        if door:
            label = f'aria-label="{told}: {_plain(door)}" title="{told}: {_plain(door)}"'
            parts.append(f'<a class="{name}" rel="{name}" href="{escape(door.url)}" {label}>{arrow}</a>')
    if contents:
        parts.append('<a class="to-contents" href="#contents-title">Contents</a>')
    parts += [f'<a class="file" href="{escape(door.url)}">{_words(door)}</a>' for door in around.files]
    return f'<nav class="bar" aria-label="Other pages">{"".join(parts)}</nav>'


def onward(around: Around | None) -> str:
    """At the end of the page, where it goes on."""
    if around is None or not (around.before or around.after):
        return ""
    doors = ((around.before, "prev", "before"), (around.after, "next", "next"))
    shown = (
        f'<a class="{rel}" rel="{rel}" href="{escape(door.url)}"><span>{told}</span> {_words(door)}</a>'
        for door, rel, told in doors
        if door
    )
    return f'<nav class="onward" aria-label="Neighbouring chapters">{"".join(shown)}</nav>'


def _words(door: Door) -> str:
    return HtmlWriter().inline(read_inline(door.words))


def _plain(door: Door) -> str:
    return escape(plain(read_inline(door.words), "text"))


def contents(report: Report) -> str:
    """The table of contents as nested lists."""
    writer = HtmlWriter(report.name)
    headings = [heading for heading in report.headings if heading.level <= 2]

    def entry(heading: Heading) -> str:
        number = f'<span class="number">{heading.number}</span> ' if heading.number else ""
        words = writer.inline(words_only(heading.children))
        return f'<a href="#{escape(heading.anchor)}">{number}<span>{words}</span></a>'

    parts, depth = [], 0
    for heading in headings:
        while depth < heading.level:
            parts.append("<ul><li>")
            depth += 1
            fresh = True
        if not fresh:
            parts.append("</li></ul>" * (depth - heading.level) + "</li><li>")
            depth = heading.level
        parts.append(entry(heading))
        fresh = False
    return "".join(parts) + "</li></ul>" * depth
