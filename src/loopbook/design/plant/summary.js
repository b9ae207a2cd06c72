"use strict";
(() => {
  const form = document.querySelector("form.tools");
  const [words, state] = ["words", "state"].map((name) => form.elements.namedItem(name));
  const said = form.querySelector("output");
  const body = document.querySelector("tbody");
  const heads = [...document.querySelectorAll("thead th")];
  const plain = (text) => text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f]/g, "");
  const rows = [...body.rows].map((row) => ({ row, state: row.dataset.state, words: plain(row.textContent) }));

  const filter = () => {
    const asked = plain(words.value).split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const one of rows) {
      const hit = (!state.value || one.state === state.value) && asked.every((word) => one.words.includes(word));
      one.row.hidden = !hit;
      shown += hit;
    }
    said.textContent = `${shown} of ${rows.length} loops`;
  };

  // numbers by value, those that are unknown always last; words by the alphabet
  const keyOf = (row, column, numeric) => {
    const cell = row.cells[column];
    if (!numeric) return cell.textContent;
    return cell.dataset.value === undefined ? Number(cell.textContent.trim() || NaN) : Number(cell.dataset.value);
  };
  const sort = (column) => {
    const head = heads[column];
    const up = head.getAttribute("aria-sort") !== "ascending";
    const numeric = head.classList.contains("number");
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", up ? "ascending" : "descending");
    const keyed = rows.map((one) => [keyOf(one.row, column, numeric), one]);
    keyed.sort(([a], [b]) => {
      if (numeric) {
        if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
        return up ? a - b : b - a;
      }
      return (up ? 1 : -1) * a.localeCompare(b, undefined, { numeric: true });
    });
    body.append(...keyed.map(([, one]) => one.row));
  };

  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", filter);
  heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => sort(column)));
  filter();
})();
