// The tuner as an anywidget: the model's data in, the state of the knobs out.

import { texts } from "./core/texts.js";
import { h } from "./ui/elements.js";
import { Tuner } from "./ui/tuner.js";

export const widget = {
    render({ model, el }) {
        const place = h("div"), style = h("style", {}, texts.style);
        el.append(style, place);
        const tuner = new Tuner(place, { ...model.get("data"), state: { ...model.get("data").state, ...model.get("state") } }, 0);
        tuner.listeners.push(() => {
            const state = Object.fromEntries(Object.entries(tuner.state).map(([name, x]) => [name, x === Infinity ? "inf" : x]));
            if (JSON.stringify(state) === JSON.stringify(model.get("state"))) return;
            model.set("state", state);
            model.save_changes();
        });
    },
};
