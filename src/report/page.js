"use strict";
// A click on a picture enlarges it; a click with Shift or Ctrl marks one, and the next click compares both with a border to move.
const at = id => document.getElementById(id);
const dark = matchMedia("(prefers-color-scheme: dark)");
const root = document.documentElement;
const toggleTheme = () => {
  const isDark = root.dataset.theme ? root.dataset.theme === "dark" : dark.matches;
  root.dataset.theme = isDark ? "light" : "dark";
};
at("theme").onclick = toggleTheme;

const buttons = [...document.querySelectorAll(".gallery button")];
const dialog = at("large");
let marked = null;
let shown = [];

function wipe(percent) {
  at("wipe").value = percent;
  at("b").style.clipPath = `inset(0 0 0 ${percent}%)`;
  at("border").style.left = `${percent}%`;
}

function mark(button) {
  marked?.setAttribute("aria-pressed", "false");
  marked = button === marked ? null : button;
  marked?.setAttribute("aria-pressed", "true");
}

function open(pair) {
  shown = pair;
  const images = pair.map(button => button.querySelector("img"));
  const isSingle = images.length === 1;
  at("a").src = images[0].src;
  at("a").alt = images[0].alt;
  at("b").src = images.at(-1).src;
  at("b").alt = images.at(-1).alt;
  at("stage").style.setProperty("--ratio", images[0].width ? images[0].naturalWidth / images[0].naturalHeight : 1.78);
  at("stage").classList.toggle("single", isSingle);
  for (const id of ["b", "border", "wipe-label"]) at(id).hidden = isSingle;
  at("names").textContent = images.map(image => image.alt).join("  |  ");
  wipe(50);
  if (!dialog.open) dialog.showModal();
}

for (const button of buttons) {
  button.setAttribute("aria-pressed", "false");
  button.onclick = event => {
    if (event.shiftKey || event.ctrlKey || event.metaKey) {
      mark(button);
    } else if (marked && marked !== button) {
      open([marked, button]);
    } else {
      open([button]);
    }
  };
}

at("wipe").oninput = () => wipe(at("wipe").value);
at("close").onclick = () => dialog.close();
dialog.onclose = () => mark(null);
const stage = at("stage");
const follow = event => {
  const area = stage.getBoundingClientRect();
  if (shown.length > 1) wipe(Math.max(0, Math.min(100, (event.clientX - area.left) / area.width * 100)));
};
stage.onpointerdown = event => { stage.setPointerCapture(event.pointerId); follow(event); };
stage.onpointermove = event => { if (event.buttons) follow(event); };
addEventListener("keydown", event => {
  if (event.key === "t" || event.key === "T") toggleTheme();
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!dialog.open || !step || event.target === at("wipe")) return;
  if (shown.length > 1) {
    wipe(Math.max(0, Math.min(100, Number(at("wipe").value) + 2 * step)));
  } else {
    const next = buttons[buttons.indexOf(shown[0]) + step];
    if (next) open([next]);
  }
  event.preventDefault();
});
