"""How fast it is, beside what one would use else: ``python -m bench``, or ``python -m bench build pid`` for some.

Each module ``bench_<name>.py`` measures one thing against its alternatives in one run:

    def rows() -> list[tuple[str, float | str, str]]:
        '''(what was measured, seconds or a text, a remark) for ours and for each alternative.'''

The first line of its docstring is the heading. A bench whose alternative is not installed says so in a row.
"""
