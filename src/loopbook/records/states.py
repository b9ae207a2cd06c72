"""Columns of two words, as a valve or a relay is logged: on and off, open and closed, read as 1 and 0."""

from loopbook.records.names import plain_letters, vocabulary

ON = vocabulary(
    "on true yes open opened high active run running start ein an auf offen ja pa till oppen oppet sann wlaczony "
    "wlaczona wl zalaczony zal otwarty otwarta tak encendido encendida abierto abierta si activado"
)
OFF = vocabulary(
    "off false no close closed shut low inactive stop stopped aus zu geschlossen nein av fran stangd stangt nej falsk "
    "wylaczony wylaczona wyl zamkniety zamknieta nie apagado apagada cerrado cerrada desactivado"
)


def state(text: str) -> float:
    """1 for a word of being on, 0 for one of being off, NaN for anything else.

    >>> state("ON"), state("geschlossen"), state("40")
    (1.0, 0.0, nan)
    """
    word = plain_letters(text.strip())
    return 1.0 if word in ON else 0.0 if word in OFF else float("nan")
