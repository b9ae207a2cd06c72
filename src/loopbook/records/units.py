"""Units of time as loggers write them, in seconds."""

_NAMES = {
    1.0: "s sec secs second seconds sek sekund sekunder sekunde sekunden sekundy segundo segundos",
    1e-3: "ms msec millis milli millisecond milliseconds millisekunder millisekunden milisekundy milisegundos",
    1e-6: "us µs μs usec micros microsecond microseconds",
    1e-9: "ns nanoseconds",
    60.0: "min mins minute minutes minut minuter minuten minuty minuto minutos",
    3600.0: "h hr hrs hour hours tim timme timmar stunde stunden godz godzina godziny hora horas",
    86400.0: "d day days dag dagar tage dni dias",
}
TIME_UNITS = {name: seconds for seconds, names in _NAMES.items() for name in names.split()}
"""Seconds in a unit, by its name in lower case."""
