// Each place for a tuner in the page gets one.

import { texts } from "./core/texts.js";
import { Tuner } from "./ui/tuner.js";

const MIME = "application/vnd.loopbook.tuner+json";

function begin() {
    const places = [...document.querySelectorAll(".live")].filter((place) => place.dataset.mime === MIME);
    if (!places.length) return;
    const style = document.createElement("style");
    style.textContent = texts.style;
    document.head.append(style);
    places.forEach((place, number) => {
        const data = JSON.parse(place.querySelector("script.data").textContent);
        place.tuner = new Tuner(place.querySelector(".lbt-place"), data, number);
    });
}

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", begin);
else begin();
