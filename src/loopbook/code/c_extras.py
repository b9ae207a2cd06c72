"""Around an emitted C controller, on request: a main that tries it and an Arduino sketch."""

from loopbook.code.block import UNLIMITED, Block, CodeError

TRIAL = """\
/* Tries {name}: at rest its output must stand still; then the set-point steps.
 *     cc -std=c99 -ffp-contract=off {stem}.c {stem}_test.c -o {stem}_test && ./{stem}_test
 */
#include "{stem}.h"
#include <stdio.h>

int main(void) {{
    {name} loop;
    {name}_settings s = {name}_designed();
    const lb_real u0 = (lb_real){u0!r}, y0 = (lb_real){y0!r};
    int k;
    if (!{name}_init(&loop, &s)) {{
        fprintf(stderr, "{name}: a setting is out of range\\n");
        return 1;
    }}
{start}    for (k = 0; k < 100; ++k) {{
        const lb_real u = {name}_step(&loop, {still});
        const lb_real moved = u - u0;
        if (!(k == 0 ? moved == 0 : moved * moved <= (lb_real){few!r})) {{
            fprintf(stderr, "{name}: at rest the output went from %.9g to %.9g\\n", (double)u0, (double)u);
            return 1;
        }}
    }}
    printf("k,u,flags\\n");
    for (k = 0; k < 20; ++k) {{
        const lb_real u = {name}_step(&loop, {stepped});
        printf("%d,%.9g,%lu\\n", k, (double)u, (unsigned long){name}_flags(&loop));
    }}
    return 0;
}}
"""

SKETCH = """\
/* {name} on an Arduino: one step every h seconds, measured, not waited for.
 * Put {stem}.h and {stem}.c beside this file. Set the two pins and the two scalings.
 */
#include "{stem}.h"

const int MEASURED = A0, DRIVEN = 9;

{name} loop_state;
{name}_settings settings;
unsigned long last_us;

/* the converter's number as a measurement */
static lb_real measured(int raw) {{ return {measured}; }}

/* the output as the number that analogWrite takes, 0..255 */
static int driven(lb_real u) {{
    const lb_real share = (u - settings.{low}) / (settings.{high} - settings.{low});
    return (int)(share * (lb_real)255.0 + (lb_real)0.5);
}}

void setup() {{
    settings = {name}_designed();
    if (!{name}_init(&loop_state, &settings)) {{ for (;;) {{ }} }}
    const lb_real y = measured(analogRead(MEASURED));
    {begin}
    last_us = micros();
}}

void loop() {{
    const unsigned long now = micros();
    const unsigned long due = (unsigned long)(settings.h * (lb_real)1000000.0);
    if (now - last_us < due) {{ return; }}
    {cycle}
    last_us += due;
    const lb_real y = measured(analogRead(MEASURED));
    const lb_real set_point = (lb_real){y0!r};
    analogWrite(DRIVEN, driven({name}_step(&loop_state, {arguments})));
}}
"""


def test_main(block: Block, stem: str) -> str:
    """A program that exits with 1 where the controller moves the output at rest."""
    u0, y0 = block.rest or (_middle(block), 0.0)
    start = f"    {block.name}_start(&loop, {block.arguments('start', y='y0', y_sp='y0', u_0='u0')});\n"
    still = block.arguments("step", y="y0", y_sp="y0")
    stepped = block.arguments("step", y="y0", y_sp="y0 + (lb_real)1")
    few = ((abs(u0) + abs(y0) + 1) * 1e-4) ** 2
    return TRIAL.format(
        name=block.name, stem=stem, u0=float(u0), y0=float(y0), start=start, still=still, stepped=stepped, few=few
    )


def sketch(block: Block, stem: str) -> str:
    """The controller in an Arduino's loop, from rest."""
    limits = block.settings()
    if max(abs(limits["u_low"]), abs(limits["u_high"])) >= UNLIMITED:
        raise CodeError("an Arduino sketch needs both limits of u: they are what analogWrite's 0..255 stand for")
    u0, y0 = block.rest or (_middle(block), 0.0)
    low, high = block.y.span or (0.0, 1023.0)
    raw_low, raw_high = 0.0, 1023.0
    scaled = (
        f"(lb_real){low!r} + ((lb_real)raw - (lb_real){raw_low!r}) * (lb_real){(high - low) / (raw_high - raw_low)!r}"
    )
    begin = f"{block.name}_start(&loop_state, {block.arguments('start', y_sp='y', u_0=f'(lb_real){float(u0)!r}')});"
    cycle = f"{block.name}_cycle(&loop_state, (lb_real)(now - last_us) / (lb_real)1000000.0);"
    return SKETCH.format(
        name=block.name,
        stem=stem,
        measured=scaled,
        low="u_low",
        high="u_high",
        begin=begin,
        cycle=cycle if block.program.has("cycle") else "",
        y0=float(y0),
        arguments=block.arguments("step", y_sp="set_point"),
    )


def _middle(block: Block) -> float:
    """An output between its limits, where nothing better is known."""
    numbers = block.settings()
    low, high = numbers.get("u_low", 0.0), numbers.get("u_high", 0.0)
    return (low + high) / 2 if abs(low) < 1e30 and abs(high) < 1e30 else 0.0
