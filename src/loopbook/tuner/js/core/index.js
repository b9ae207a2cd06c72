// What the tests and the page take from the core.

import { margins } from "./margins.js";
import { decayRate, dominantPoles, isStable, unstableRoots } from "./stability.js";
import { LoopTransfer } from "./transfer.js";
import { absoluteError, inputMeasures, stepMeasures } from "./measures.js";
import { finalValues, loopTransfer, stepResponses } from "./response.js";

export const core = { LoopTransfer, decayRate, dominantPoles, isStable, margins, unstableRoots, loopTransfer, stepResponses, finalValues, stepMeasures, absoluteError, inputMeasures };
