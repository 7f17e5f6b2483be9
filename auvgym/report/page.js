"use strict";

// Tables: a click on a heading sorts by it, a second click turns the order round.
for (const table of document.querySelectorAll("table.ranked")) {
  const body = table.tBodies[0];
  const headings = [...table.tHead.rows[0].cells];
  const mark = () => {
    for (const row of body.rows) row.classList.toggle("best", row.cells[0].textContent === "1");
  };
  const sort = (column) => {
    const heading = headings[column];
    const numeric = heading.classList.contains("number");
    // The first click shows large numbers first, and texts from A.
    const before = heading.getAttribute("aria-sort");
    const descending = before === "ascending" || (before !== "descending" && numeric);
    const sign = descending ? -1 : 1;
    const key = (row) => row.cells[column].dataset.value;
    const missing = (text) => text === "nan" || text === "";
    const rows = [...body.rows].sort((first, second) => {
      const [a, b] = [key(first), key(second)];
      if (missing(a) || missing(b)) return missing(a) - missing(b);
      return sign * (numeric ? Number(a) - Number(b) : a.localeCompare(b));
    });
    body.append(...rows);
    for (const other of headings) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
  };
  headings.forEach((heading, column) => {
    heading.querySelector("button")?.addEventListener("click", () => sort(column));
  });
  mark();
}

// Figures: only the chosen one is drawn, for a browser has few 3-D contexts.
const place = document.getElementById("figure");
if (place) {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const dressed = (layout) => {
    const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
    const card = getComputedStyle(document.documentElement).getPropertyValue("--card").trim();
    const plain = structuredClone(layout);
    plain.font = { ...plain.font, color: ink };
    for (const menu of plain.updatemenus ?? []) {
      menu.bgcolor = card;
      menu.font = { color: ink };
    }
    for (const slider of plain.sliders ?? []) slider.currentvalue.font.color = ink;
    return plain;
  };
  let shown = 0;
  const show = async () => {
    const source = document.getElementById(`figure-${shown}`);
    const figure = JSON.parse(source.textContent);
    Plotly.purge(place);
    const settings = { responsive: true, displaylogo: false };
    await Plotly.newPlot(place, figure.data, dressed(figure.layout), settings);
    if (figure.frames) await Plotly.addFrames(place, figure.frames);
  };
  document.getElementById("episode")?.addEventListener("change", (event) => {
    shown = Number(event.target.value);
    show();
  });
  dark.addEventListener("change", show);
  show();
}
