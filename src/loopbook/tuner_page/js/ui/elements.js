// Elements of a page, made in one line.

// Has a function called at an event.
export const on = (target, ...what) => target.addEventListener(...what);

// Gives an element attributes.
export function put(element, given) {
    for (const [name, value] of Object.entries(given)) element.setAttribute(name, value);
}

// h("button.small", { onclick, "aria-label": "…" }, "text", child, ...)
export function h(kind, given = {}, ...children) {
    const [tag, ...classes] = kind.split("."), element = document.createElement(tag);
    if (classes.length) element.className = classes.join(" ");
    for (const [name, value] of Object.entries(given)) {
        if (name.startsWith("on")) on(element, name.slice(2), value);
        else if (value === true) element.setAttribute(name, "");
        else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
    }
    element.append(...children.filter((child) => child !== null));
    return element;
}

export function download(name, text) {
    const link = h("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain;charset=utf-8" })), download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
