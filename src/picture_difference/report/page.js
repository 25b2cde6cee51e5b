"use strict";
const report = JSON.parse(document.getElementById("data").textContent);
const at = id => document.getElementById(id);
const MODES = [
  ["wipe", "Wipe"], ["a", "A"], ["b", "B"], ["difference", "Difference"], ["map", ""], ["channel", "Largest channel"],
];
// Views that only pictures of the same size have.
const MAPS = ["map", "channel"];
// Zoom is in pixels of the screen for each of the picture; x and y are where its upper left corner is on the stage.
const state = { pair: 0, mode: "wipe", wipe: 50, gain: 0, zoom: 1, x: 0, y: 0 };

const number = value => value === null ? "∞" : value === 0 ? "0" : value < 0.00005 ? "< 0.0001" : value < 1e6 ? value.toFixed(4) : value.toPrecision(4);
// NaN and infinity are text.
const rounded = value => typeof value === "string" ? value : +value.toPrecision(4);
const pair = () => report.pairs[state.pair];

function element(tag, text, properties) {
  const made = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) made.textContent = text;
  return made;
}

function list() {
  report.pairs.forEach((pair, index) => {
    const button = element("button", undefined, { type: "button" });
    const words = pair.why ? pair.why : `${pair.measure} ${number(pair.error)} · channel ${number(pair.largest)}`;
    button.append(element("b", pair.name), element("span", words, { className: pair.passes ? "good" : "bad" }));
    button.addEventListener("click", () => choose(index));
    at("pairs").append(button);
  });
}

function choose(index) {
  state.pair = Math.max(0, Math.min(report.pairs.length - 1, index));
  const shown = pair();
  if (!shown.map && MAPS.includes(state.mode)) state.mode = "wipe";
  at("pixel").textContent = "";
  [...at("pairs").children].forEach((button, other) => button.setAttribute("aria-current", other === state.pair));
  at("pairs").children[state.pair].scrollIntoView({ block: "nearest" });
  at("name").textContent = shown.name;
  at("numbers").textContent = shown.why ? "" :
    `${shown.measure} ${number(shown.error)} · largest difference of a channel ${number(shown.largest)} at ${shown.largest_at.join(", ")} · ` +
    `${shown.differing} of ${shown.pixels} pixels differ`;
  at("why").textContent = shown.why || "";
  at("why").hidden = !shown.why;
  for (const side of ["a", "b"]) {
    at(side).src = shown[side] ? shown[side].image : "";
    at("side-" + side).textContent = `${side.toUpperCase()}  ${shown[side] ? shown[side].file : ""}`;
  }
  Object.assign(at("view").style, { width: shown.size[0] + "px", height: shown.size[1] + "px" });
  settings(shown);
  fit();
}

function settings(shown) {
  const place = at("settings");
  place.replaceChildren();
  const texts = [shown.a, shown.b].map(side => side && side.settings);
  if (!texts[0] && !texts[1]) return;
  if (shown.settings.length > 0) {
    const table = element("table"), head = element("thead"), body = element("tbody");
    const row = (cells, kind) => {
      const line = element("tr");
      cells.forEach(cell => line.append(element(kind, cell)));
      return line;
    };
    head.append(row(["setting", "A", "B"], "th"));
    shown.settings.forEach(cells => body.append(row(cells, "td")));
    table.append(head, body);
    place.append(table);
  } else if (texts[0] && texts[1]) {
    place.append(element("p", "Both pictures have the same settings.", { className: "quiet" }));
  }
  const all = element("details"), both = element("div", undefined, { className: "texts" });
  texts.forEach(text => both.append(element("pre", text || "no settings in the file")));
  all.append(element("summary", "All settings"), both);
  place.append(all);
}

function update() {
  const shown = pair(), { mode } = state;
  const map = mode === "map" ? shown.map : mode === "channel" ? shown.channel : null;
  at("map").hidden = !map;
  if (map && at("map").getAttribute("src") !== map) at("map").src = map;
  at("a").hidden = !shown.a || mode === "b" || Boolean(map);
  at("b").hidden = !shown.b || mode === "a" || Boolean(map);
  at("b").style.mixBlendMode = mode === "difference" ? "difference" : "normal";
  at("b").style.clipPath = mode === "wipe" ? `inset(0 0 0 ${state.wipe}%)` : "none";
  const gains = mode === "difference" || mode === "channel";
  at("view").style.filter = gains && state.gain > 0 ? `brightness(${2 ** state.gain})` : "none";
  at("view").style.background = mode === "difference" ? "#000" : "none";
  at("border").hidden = mode !== "wipe" || !shown.a || !shown.b;
  const place = (x, y, width, height) => ({
    left: state.x + x * state.zoom + "px", top: state.y + y * state.zoom + "px", width: width * state.zoom + "px", height: height * state.zoom + "px",
  });
  Object.assign(at("border").style, place(shown.size[0] * state.wipe / 100, 0, 0, shown.size[1]));
  at("side-a").hidden = !["wipe", "a"].includes(mode);
  at("side-b").hidden = !["wipe", "b"].includes(mode);
  at("worst").hidden = Boolean(shown.why) || state.zoom < 4;
  Object.assign(at("worst").style, place(...(shown.largest_at || [0, 0]), 1, 1));
  at("view").style.transform = `translate(${state.x}px, ${state.y}px) scale(${state.zoom})`;
  at("view").classList.toggle("smooth", state.zoom < 1);
  at("wipe").value = state.wipe;
  at("gain").value = state.gain;
  at("gain-text").textContent = "×" + 2 ** state.gain;
  at("wipe-label").hidden = mode !== "wipe";
  at("gain-label").hidden = !gains;
  for (const button of at("modes").children) button.setAttribute("aria-pressed", button.dataset.mode === mode);
  const [named, channel] = MAPS.map(mode => at("modes").querySelector(`[data-mode=${mode}]`));
  named.textContent = `${shown.measure === "RMSE" ? "Difference of each channel" : "FLIP"} (5)`;
  named.disabled = channel.disabled = at("to-worst").disabled = !shown.map;
}

function fit() {
  const [width, height] = pair().size, { clientWidth, clientHeight } = at("stage");
  const most = Math.min(clientWidth / width, clientHeight / height);
  state.zoom = most >= 1 ? Math.floor(most) : most;
  state.x = (clientWidth - width * state.zoom) / 2;
  state.y = (clientHeight - height * state.zoom) / 2;
  update();
}

function zoom(factor, x = at("stage").clientWidth / 2, y = at("stage").clientHeight / 2) {
  const next = Math.max(0.05, Math.min(64, state.zoom * factor));
  state.x = x - (x - state.x) * next / state.zoom;
  state.y = y - (y - state.y) * next / state.zoom;
  state.zoom = next;
  update();
}

function toWorst() {
  const shown = pair();
  if (shown.why) return;
  const [x, y] = shown.largest_at;
  // Before the place: a long text makes the stage smaller.
  const [a, b] = shown.worst.map(values => values.map(rounded).join(" "));
  at("pixel").textContent = `${x}, ${y}: A ${a} · B ${b}`;
  state.zoom = 24;
  state.x = at("stage").clientWidth / 2 - (x + 0.5) * state.zoom;
  state.y = at("stage").clientHeight / 2 - (y + 0.5) * state.zoom;
  update();
}

function set(change) {
  Object.assign(state, change);
  state.wipe = Math.max(0, Math.min(100, state.wipe));
  update();
}

const flip = () => set({ mode: state.mode === "a" ? "b" : "a" });
const themes = { "": "dark", dark: "light", light: "" };
const theme = () => { document.documentElement.dataset.theme = themes[document.documentElement.dataset.theme || ""]; };
const KEYS = {
  " ": flip, z: toWorst, 0: fit, t: theme, "+": () => zoom(1.5), "=": () => zoom(1.5), "-": () => zoom(1 / 1.5),
  ArrowLeft: () => set({ mode: "wipe", wipe: state.wipe - 2 }), ArrowRight: () => set({ mode: "wipe", wipe: state.wipe + 2 }),
  ArrowUp: () => choose(state.pair - 1), ArrowDown: () => choose(state.pair + 1),
};
MODES.forEach(([mode, name], index) => {
  const button = element("button", `${name} (${index + 1})`, { type: "button" });
  button.dataset.mode = mode;
  button.addEventListener("click", () => set({ mode }));
  at("modes").append(button);
  KEYS[index + 1] = () => button.click();
});

document.addEventListener("keydown", event => {
  const own = event.target.matches("input, button") && [" ", "Enter", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"].includes(event.key);
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action || own && event.target.matches("input") || own && event.key === " " || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  action();
});
at("wipe").addEventListener("input", event => set({ wipe: Number(event.target.value) }));
at("gain").addEventListener("input", event => set({ gain: Number(event.target.value) }));
at("to-worst").addEventListener("click", toWorst);
at("fit").addEventListener("click", fit);
at("theme").addEventListener("click", theme);
at("stage").addEventListener("wheel", event => {
  const place = at("stage").getBoundingClientRect();
  event.preventDefault();
  zoom(event.deltaY < 0 ? 1.25 : 0.8, event.clientX - place.left, event.clientY - place.top);
}, { passive: false });
at("stage").addEventListener("pointerdown", event => {
  const place = at("stage").getBoundingClientRect(), width = pair().size[0] * state.zoom;
  const border = place.left + state.x + width * state.wipe / 100;
  const wipes = state.mode === "wipe" && Math.abs(event.clientX - border) < 12;
  let last = [event.clientX, event.clientY];
  const move = moved => {
    const [x, y] = [moved.clientX - last[0], moved.clientY - last[1]];
    last = [moved.clientX, moved.clientY];
    set(wipes ? { wipe: (moved.clientX - place.left - state.x) / width * 100 } : { x: state.x + x, y: state.y + y });
  };
  const end = () => {
    at("stage").removeEventListener("pointermove", move);
    at("stage").removeEventListener("pointerup", end);
  };
  at("stage").setPointerCapture(event.pointerId);
  at("stage").addEventListener("pointermove", move);
  at("stage").addEventListener("pointerup", end);
});
addEventListener("resize", fit);

document.title = report.title;
at("title").textContent = report.title;
const failed = report.pairs.filter(pair => !pair.passes).length;
at("summary").textContent = failed ? `${failed} of ${report.pairs.length} fail at ${report.limits}` : `all ${report.pairs.length} pass at ${report.limits}`;
at("summary").className = failed ? "bad" : "good";
list();
choose(0);
