// What the tests ask.

import { core } from "./core/index.js";
import { rules, settingsBy } from "./rules/rules.js";

export const page = { ...core, rules, settingsBy };
