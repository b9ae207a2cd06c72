"""What a column's name says, by whole words, in English, German, Swedish, Polish and Spanish.

A name is split at everything that is no letter or digit, at a capital after a small letter, and read without accents:
"Oven temperature", "ovenTemperature", "oven_temperature" are one name. The unit is split off first.
"""

import re
import unicodedata
from dataclasses import dataclass
from enum import StrEnum

from loopbook.records.units import TIME_UNITS


class Role(StrEnum):
    """What a column can be. OTHER: named as something that is neither input nor output."""

    TIME = "time"
    DATE = "date"
    COUNTER = "counter"
    SETPOINT = "set-point"
    INPUT = "input"
    OUTPUT = "output"
    AMBIENT = "ambient"
    OTHER = "other"


def vocabulary(text: str) -> frozenset[str]:
    """The words of a text."""
    return frozenset(text.split())


WHOLE = {
    Role.TIME: vocabulary("t ts tid time czas zeit tiempo temps timestamp datetime uptime elapsed millis micros clock"),
    Role.COUNTER: vocabulary("i k n nr no lp rn id rad zeile row fila"),
    Role.SETPOINT: vocabulary("sp r w ref rsp ysp"),
    Role.INPUT: vocabulary("u mv op co cv in q"),
    Role.OUTPUT: vocabulary("y pv out ph rpm"),
    Role.OTHER: vocabulary("e err p d kp ki kd ti td"),
}
"""Names that stand alone."""

QUANTITIES = vocabulary(
    "temp temps temperature temperatur temperatura level niva nivel poziom fullstand fuellstand pegel pressure tryck "
    "druck cisnienie presion flow flode durchfluss przeplyw caudal flujo humidity fukt feuchte wilgotnosc humedad "
    "concentration koncentration konzentration stezenie concentracion ph co2 o2 ppm thermocouple "
    "thermoelement termopar termopara"
)
MEASURED = vocabulary(
    "y pv output measured measurement process sensor actual feedback value position lage pozycja posicion speed "
    "velocity hastighet varvtal drehzahl geschwindigkeit predkosc obroty velocidad rpm angle vinkel winkel kat angulo "
    "matvarde arvarde istwert messwert messung ist zmierzona pomiar wyjscie utsignal ausgang salida medida medicion "
    "weight vikt gewicht masa peso height hojd hohe hoehe wysokosc altura response"
)
MANIPULATED = vocabulary(
    "u input mv op heater heating heat power valve pump pwm duty control controller actuator command cmd drive voltage "
    "manipulated throttle opening dac styrsignal styrvarde utstyrning insignal ventil effekt varmare varme pumpe pump "
    "oppning sterowanie sterujacy sygnal wejscie moc zawor grzalka pompa napiecie otwarcie wysterowanie stellgrosse "
    "stellgroesse stellgrad stellwert stellsignal eingang heizung heizleistung leistung spannung offnung oeffnung "
    "entrada valvula potencia mando calefactor resistencia bomba tension apertura actuador voltaje regulator regler "
    "controlador regulador sterownik fan blower motor lufter flakt wentylator ventilador co cv u1"
)
COMMANDS = vocabulary(
    "control controller pwm duty valve command cmd dac ventil zawor valvula sterujacy stellgrad opening stellwert "
    "stellsignal styrsignal regler regulator voltage actuator drive controlador regulador sterownik op mv co cv"
)
"""Words that make an input even of "valve position", "pump speed command" and "controller output"."""
NAMED = {
    Role.TIME: vocabulary(
        "time tid czas zeit tiempo temps timestamp datetime elapsed uhrzeit zeitstempel tidpunkt klocka "
        "klockslag godzina hora uptime clock seconds second sec minutes minute sekunder sekunden sekundy "
        "segundos minuter minuten minuty minutos millis micros millisecond milliseconds xvalue"
    ),
    Role.DATE: vocabulary("date datum fecha dag dzien day tag dia data"),
    Role.COUNTER: vocabulary(
        "index idx counter count number sample samples record row seq sequence rownum nummer lopnummer zeile "
        "zeilennummer numer wiersz probka indice numero muestra fila unnamed lfdnr rad"
    ),
    Role.SETPOINT: vocabulary(
        "setpoint set-point sp ysp target reference referens referenz desired sollwert soll borvarde bor "
        "zadana zadane zadany consigna referencia wanted"
    ),
    Role.AMBIENT: vocabulary(
        "ambient outdoor outside room surroundings disturbance umgebung umgebungstemperatur aussentemperatur "
        "aussen raum raumtemperatur storung stoerung storgrosse omgivning omgivningstemperatur ute "
        "utetemperatur utomhus rumstemperatur storning otoczenia otoczenie zaklocenie pokojowa zewnetrzna "
        "ambiente exterior perturbacion"
    ),
    Role.OTHER: vocabulary(
        "error fel fehler alarm mode status state battery batteri batterie note comment kp ki kd integral "
        "derivative proportional"
    ),
}
LONE_UNITS = frozenset(unit for unit in TIME_UNITS if len(unit) > 1 or unit == "s")
ENDINGS = (*("temperatur", "druck", "tryck", "niva", "drehzahl", "varvtal", "flode", "durchfluss", "fullstand"),
           *("geschwindigkeit", "hastighet"))  # fmt: skip
BEGINNINGS = (*("ventil", "heiz", "pump", "styr", "stell", "regler", "varmeeffekt", "lufter", "antriebs", "steuer"),)
"""Of German and Swedish compounds: "Ofentemperatur" is a temperature, "Ventilstellung" a valve's."""
PAIR = re.compile(r"\s*(.*?)\s*(?:\[\s*(.*?)\s*\]|\(\s*(.*?)\s*\)|/\s*(\S+)|,\s*(\S+))?\s*")


@dataclass(frozen=True)
class Name:
    """A head: its text without the unit, the unit, and its words in plain lower case."""

    text: str
    unit: str
    words: tuple[str, ...]

    @property
    def blank(self) -> bool:
        return not self.words or self.words[0] == "unnamed"

    def says(self, role: Role) -> bool:
        """Is the role named, as the whole name or as one of its words?"""
        alone = len(self.words) == 1 and self.words[0] in WHOLE.get(role, ())
        alone |= role is Role.TIME and len(self.words) == 1 and self.words[0] in LONE_UNITS
        if role is Role.TIME and self.unit in TIME_UNITS and self.words[0] in WHOLE[role] and len(self.words) == 2:
            return True
        if role is Role.OUTPUT or role is Role.INPUT:
            return self.strength(role) > 0
        if role is Role.DATE and "data" in self.words and len(self.words) > 1:
            return False
        two = {"".join(pair) for pair in zip(self.words, self.words[1:], strict=False)}
        return alone or bool((set(self.words) | two) & NAMED.get(role, frozenset()))

    def strength(self, role: Role) -> float:
        """How loudly the name says input or output; 0 where it does not."""
        words = [w if w in QUANTITIES else re.sub(r"\d+$", "", w) or w for w in self.words]
        if any(self.says(r) for r in (Role.SETPOINT, Role.AMBIENT, Role.COUNTER, Role.OTHER)):
            return 0.0
        if len(words) == 1 and words[0] in WHOLE[role]:
            return 5.0
        if role is Role.OUTPUT and re.fullmatch(r"t\d+", "".join(self.words)):
            return 4.0
        commanded = bool(set(words) & COMMANDS)
        if role is Role.OUTPUT and any(w.endswith(ENDINGS) for w in words):
            return 4.0
        if role is Role.INPUT:
            return 4.0 if commanded else 2.0 if self._drives(words) else 0.0
        if set(words) & QUANTITIES:
            return 1.0 if commanded else 4.0
        return (0.5 if commanded else 3.0) if set(words) & MEASURED else 0.0

    @staticmethod
    def _drives(words: list[str]) -> bool:
        return bool(set(words) & MANIPULATED) or any(w.startswith(BEGINNINGS) for w in words)


def plain_letters(text: str) -> str:
    """Lower case without accents: "Füllstand" is "fullstand", "napięcie" is "napiecie".

    >>> plain_letters("Ärvärde"), plain_letters("Wartość"), plain_letters("Größe")
    ('arvarde', 'wartosc', 'grosse')
    """
    text = text.replace("ł", "l").replace("Ł", "L").replace("ß", "ss")
    return "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c)).lower()


def words_of(text: str) -> tuple[str, ...]:
    """The words of a name in plain lower case.

    >>> words_of("PWM controller"), words_of("ovenTemperature_2"), words_of("Q1"), words_of("time_ms")
    (('pwm', 'controller'), ('oven', 'temperature', '2'), ('q1',), ('time', 'ms'))
    >>> words_of("Tank pH")
    ('tank', 'ph')
    """
    parted = re.sub(r"(?<=[a-zà-öø-ÿ])(?=[A-ZÀ-ÖØ-Þ])", " ", re.sub(r"\bpH\b", "ph", text))
    return tuple(w for w in re.split(r"[^a-z0-9µ]+", plain_letters(parted)) if w)


def name_and_unit(head: str) -> tuple[str, str]:
    """Split "Time [s]", "temp (°C)", "u / V" or "time_ms" into name and unit.

    A unit without a sign around it is taken for one only where it is a unit of time after a name of time.

    >>> name_and_unit("Time [s]"), name_and_unit("time_ms"), name_and_unit("ms"), name_and_unit("pwm")
    (('Time', 's'), ('time_ms', 'ms'), ('ms', 'ms'), ('pwm', ''))
    """
    head = " ".join(head.split())  # a head of several lines is one name
    found = PAIR.fullmatch(head)
    assert found, "each part of the pattern may be absent"
    name, unit = found[1], next((g for g in found.groups()[1:] if g), "")
    if not unit:
        words = words_of(head)
        unit_word = words[-1] if words else ""
        timely = len(words) == 1 or Name("", "", words[:-1]).says(Role.TIME) or "in" in words
        if unit_word in TIME_UNITS and timely and (len(words) > 1 or unit_word in LONE_UNITS):
            return head, unit_word
    return name or head, unit


def read_name(head: str) -> Name:
    """A column's head, understood."""
    text, unit = name_and_unit(head)
    return Name(text, unit, words_of(text))
