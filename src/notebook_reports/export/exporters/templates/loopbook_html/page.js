"use strict";
(() => {
  const all = (what, inside = document) => [...inside.querySelectorAll(what)];
  const button = (words, name) => {
    const made = document.createElement("button");
    made.type = "button";
    made.className = name;
    made.textContent = words;
    return made;
  };

  // copy what a listing holds
  const copy = (text) => {
    if (navigator.clipboard && window.isSecureContext) return navigator.clipboard.writeText(text);
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    document.execCommand("copy");
    field.remove();
    return Promise.resolve();
  };
  for (const listing of all("pre.input, pre.code, pre.output")) {
    const made = button("Copy", "copy");
    made.addEventListener("click", () => {
      copy(listing.querySelector("code").textContent + "\n").then(() => {
        made.textContent = "Copied";
        setTimeout(() => (made.textContent = "Copy"), 1500);
      });
    });
    const frame = document.createElement("div");
    frame.className = "listing";
    listing.replaceWith(frame);
    frame.append(listing, made);
  }

  // all the code at once
  const folds = all("details.fold");
  const bar = document.querySelector(".bar, main > header");
  if (folds.length > 1 && bar) {
    const made = button("Show code", "unfold");
    made.setAttribute("aria-pressed", "false");
    made.addEventListener("click", () => {
      const open = made.getAttribute("aria-pressed") === "false";
      folds.forEach((fold) => (fold.open = open));
      made.setAttribute("aria-pressed", String(open));
      made.textContent = open ? "Hide code" : "Show code";
    });
    bar.append(made);
  }
  window.addEventListener("beforeprint", () => folds.forEach((fold) => (fold.open = true)));

  // a link into what is folded opens it
  const unfold = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    let fold = target && target.closest("details:not([open])");
    if (!fold) return;
    for (; fold; fold = fold.parentElement.closest("details:not([open])")) fold.open = true;
    target.scrollIntoView();
  };
  window.addEventListener("hashchange", unfold);
  unfold();

  // the section that is read, in the contents
  const links = new Map(all(".contents a").map((link) => [decodeURIComponent(link.hash.slice(1)), link]));
  const heads = all("main h2[id], main h3[id]").filter((head) => links.has(head.id));
  const follow = () => {
    const line = window.innerHeight / 4;
    let now = null;
    for (const head of heads) if (head.getBoundingClientRect().top <= line) now = head;
    for (const link of links.values()) link.removeAttribute("aria-current");
    if (!now) return;
    const link = links.get(now.id);
    link.setAttribute("aria-current", "true");
    const list = link.closest(".contents");
    if (list.scrollHeight > list.clientHeight + 1) {
      const [outer, inner] = [list.getBoundingClientRect(), link.getBoundingClientRect()];
      if (inner.top < outer.top || inner.bottom > outer.bottom) list.scrollTop += inner.top - outer.top - 40;
    }
  };
  if (heads.length) {
    let asked = 0;
    const soon = () => (asked = asked || requestAnimationFrame(() => ((asked = 0), follow())));
    window.addEventListener("scroll", soon, { passive: true });
    window.addEventListener("resize", soon);
    follow();
  }
})();
