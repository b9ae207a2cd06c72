"use strict";
(() => {
  const form = document.querySelector("form.tools");
  const [words, documentOf, verdictOf] = ["words", "document", "verdict"].map((name) => form.elements.namedItem(name));
  const said = form.querySelector("output");
  const plain = (text) => text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f]/g, "").replace(/\u2212/g, "-");

  // every row with its words, its document and its verdict
  const tables = [...document.querySelectorAll("main .table")].map((frame) => {
    const caption = frame.querySelector("caption");
    const title = caption ? caption.textContent.replace(/^Table \S+ /, "") : "";
    const captioned = title.includes(": ");
    const heads = [...frame.querySelectorAll("thead th")].map((head) => head.textContent);
    const rows = [...frame.querySelectorAll("tbody tr")].map((row) => {
      const cells = [...row.cells].map((cell) => cell.textContent);
      const marked = heads.indexOf("verdict");
      const verdict = marked < 0 ? "" : cells[marked].replace(/^[^a-z]+/, "");
      const place = cells[heads.indexOf("place")] || "";
      const owner = captioned ? title.split(": ")[0] : place.split(", ")[0];
      return { row, owner, verdict, words: plain([title, ...cells].join(" ")) };
    });
    return { frame, captioned, rows };
  });
  const everything = tables.flatMap((table) => table.rows);
  const names = new Set(tables.filter((table) => table.captioned).flatMap((table) => table.rows.map((row) => row.owner)));
  const offer = (field, values) => {
    for (const value of values) if (value) field.append(new Option(value, value));
  };
  offer(documentOf, names);
  offer(verdictOf, [...new Set(everything.map((row) => row.verdict))].filter((v) => v && !/\d/.test(v)).sort());

  // what lies between two headings
  const sections = [...document.querySelectorAll("main h2[id], main h3[id]")];
  const main = document.querySelector("main");
  const filter = () => {
    const asked = plain(words.value).split(/\s+/).filter(Boolean);
    const active = Boolean(asked.length || documentOf.value || verdictOf.value);
    main.classList.toggle("filtered", active);
    let shown = 0;
    for (const table of tables) {
      let here = 0;
      for (const { row, owner, verdict, words: text } of table.rows) {
        const fits =
          (!documentOf.value || owner === documentOf.value) &&
          (!verdictOf.value || verdict === verdictOf.value) &&
          asked.every((word) => text.includes(word));
        row.hidden = active && !fits;
        here += fits ? 1 : 0;
      }
      table.frame.hidden = active && !here;
      shown += here;
    }
    said.textContent = active ? `${shown} of ${everything.length} rows` : "";
    for (const [i, head] of sections.entries()) {
      const next = sections.slice(i + 1).find((other) => other.tagName <= head.tagName);
      const inside = tables.filter(
        ({ frame }) =>
          head.compareDocumentPosition(frame) & Node.DOCUMENT_POSITION_FOLLOWING &&
          (!next || next.compareDocumentPosition(frame) & Node.DOCUMENT_POSITION_PRECEDING)
      );
      head.hidden = active && inside.every(({ frame }) => frame.hidden);
    }
  };
  let waiting = 0;
  form.addEventListener("input", () => {
    clearTimeout(waiting);
    waiting = setTimeout(filter, 120);
  });
  form.addEventListener("submit", (event) => event.preventDefault());
  form.hidden = false;
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && !["INPUT", "SELECT", "TEXTAREA"].includes(document.activeElement.tagName)) {
      event.preventDefault();
      words.focus();
    }
  });
})();
