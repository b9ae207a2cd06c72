// What the tests take from the core.

import { CircleTransfer, sampledMargins, zerosOf } from "./circle.js";
import { margins } from "./margins.js";
import { absoluteError, inputMeasures, stepMeasures } from "./measures.js";
import { place } from "./placement.js";
import { finalValues, loopTransfer, stepResponses } from "./response.js";
import { pidPolynomials, rstController, simulate } from "./run.js";
import { pulseTransfer, sample } from "./sampled.js";
import { decayRate, dominantPoles, isStable, unstableRoots } from "./stability.js";
import { LoopTransfer } from "./transfer.js";

export const core = {
    CircleTransfer, LoopTransfer, absoluteError, decayRate, dominantPoles, finalValues, inputMeasures, isStable, loopTransfer,
    margins, pidPolynomials, place, pulseTransfer, rstController, sample, sampledMargins, simulate, stepMeasures,
    stepResponses, unstableRoots, zerosOf,
};
