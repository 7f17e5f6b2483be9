"use strict";

// Charts are drawn when they come into sight, episodes when they are chosen. A file on disk cannot
// be fetched, but it can be a script: each episode's calls auvgymEpisode with its figure.
const settings = { responsive: true, displaylogo: false };
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const inked = (layout) => {
  const plain = structuredClone(layout);
  plain.font = { ...plain.font, color: colour("--ink") };
  for (const menu of plain.updatemenus ?? []) {
    menu.bgcolor = colour("--card");
    menu.font = { color: colour("--ink") };
  }
  for (const slider of plain.sliders ?? []) slider.currentvalue.font.color = colour("--ink");
  return plain;
};

const draw = (place) => {
  const { data, layout } = JSON.parse(place.nextElementSibling.textContent);
  Plotly.react(place, data, inked(layout), { responsive: true, displayModeBar: false });
};
const seen = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    seen.unobserve(target);
    draw(target);
  }
}, { rootMargin: "300px" });
for (const place of document.querySelectorAll(".chart")) seen.observe(place);

// One episode is shown at a time: a browser has few 3-D contexts.
let shown = null;
window.auvgymEpisode = async (number, figure) => {
  if (!shown || shown.number !== number) return;
  const { place } = shown;
  await Plotly.newPlot(place, figure.data, inked(figure.layout), settings);
  if (figure.frames) await Plotly.addFrames(place, figure.frames);
  place.dataset.shown = String(number);
};
const watch = (select) => {
  if (shown) {
    Plotly.purge(shown.place);
    shown.place.hidden = true;
    shown = null;
  }
  if (select.value === "") return;
  const place = select.closest(".viewer").querySelector(".episode");
  place.hidden = false;
  shown = { number: Number(select.value), place };
  const script = document.createElement("script");
  script.src = `episodes/${select.value}.js`;
  script.addEventListener("error", () => { place.textContent = `${script.src} is missing`; });
  document.head.append(script);
  script.addEventListener("load", () => script.remove());
};
const selects = [...document.querySelectorAll("select.watch")];
for (const select of selects) {
  select.addEventListener("change", () => {
    for (const other of selects) if (other !== select) other.value = "";
    watch(select);
  });
}

// index.html#episode-3 opens on that episode.
const asked = /^#episode-(\d+)$/.exec(location.hash);
if (asked) {
  const select = selects.find((one) => [...one.options].some((option) => option.value === asked[1]));
  if (select) {
    select.value = asked[1];
    watch(select);
    select.scrollIntoView();
  }
}
