// What the tests ask: everything of the page that needs no browser.

import { core } from "./core/index.js";
import { fitOf, replay } from "./core/replay.js";
import { unpacked } from "./core/unpacked.js";
import { emittedLaw } from "./generated/law.js";
import { rules, settingsBy } from "./rules/rules.js";
import { evaluate, nice, variants } from "./ui/compute.js";
import { modelToml, programSettings, programTexts, pythonNumber, regulatorJson } from "./ui/pythonic.js";
import { DEFAULTS, FORMS, fromText, pidOf, processOf, shown, toText, typed } from "./ui/state.js";
import { numbersOf, summary } from "./ui/words.js";

export const page = {
    ...core, DEFAULTS, FORMS, emittedLaw, evaluate, fitOf, fromText, modelToml, nice, numbersOf, pidOf, processOf, programSettings,
    programTexts, pythonNumber, regulatorJson, replay, rules, settingsBy, shown, summary, toText, typed, unpacked, variants,
};
