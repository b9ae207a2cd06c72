// The texts of the page, unpacked once: programs, what is said of the rules, the style sheet.

import { packedTexts } from "../generated/texts.js";
import { unpacked } from "./unpacked.js";

export const texts = JSON.parse(unpacked(packedTexts));
