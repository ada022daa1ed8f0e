"use strict";

const CONDITIONS = JSON.parse(document.getElementById("data").textContent);
const WORDS = new Map([["true", true], ["1", true], ["false", false], ["0", false]]);
const form = document.getElementById("arguments");
const search = document.getElementById("search");
const all = document.getElementById("all");
const items = [...document.querySelectorAll(".item")];

/** Return the value of an argument. */
const valueOf = (name) => form.elements[name].value;

/** Return the text of a condition, null if it is unknown. */
function textOf(source) {
  if (source === null) return null;
  if (source.pieces) return source.pieces.map((piece, at) => (at % 2 ? valueOf(piece) : piece)).join("");
  const text = source.table[JSON.stringify(source.arguments.map(valueOf))];
  return text === undefined ? null : text;
}

/** Return whether a condition holds, null if that is unknown. */
function holds({ texts, equals, wanted }) {
  const answers = new Set(texts.map((source) => {
    const text = textOf(source);
    if (text === null) return null;
    const truth = equals === null ? WORDS.get(text.trim().toLowerCase()) : text === equals;
    return truth === undefined ? null : truth === wanted;
  }));
  return answers.size === 1 ? [...answers][0] : null;
}

/** Return "off", "open" or "on" for an item, given the truth of all conditions. */
function stateOf(item, truths) {
  const numbers = item.dataset.when.split(" ").filter(Boolean).map(Number);
  if (numbers.some((number) => truths[number] === false)) return "off";
  if (numbers.some((number) => truths[number] === null)) return "open";
  return numbers.length || item.dataset.certain === "1" ? "on" : "open";
}

/** Show the values of the arguments and what they start. */
function decide() {
  for (const place of document.querySelectorAll(".open")) place.textContent = valueOf(place.dataset.argument);
  for (const place of document.querySelectorAll(".name")) {
    const names = JSON.parse(place.dataset.names).map((pieces) => textOf({ pieces }).replace(/\/{2,}/g, "/"));
    place.textContent = [...new Set(names)].join(" | ");
  }
  const truths = CONDITIONS.map(holds);
  for (const place of document.querySelectorAll(".condition")) {
    const truth = truths[Number(place.dataset.condition)];
    place.querySelector(".truth").textContent = truth === null ? "(unknown)" : truth ? "(true)" : "(false)";
  }
  const counts = { on: 0, open: 0, off: 0 };
  for (const item of items) {
    const state = stateOf(item, truths);
    item.dataset.state = state;
    item.classList.toggle("off", state === "off");
    item.querySelector(":scope > details .state").textContent = { on: "", open: "perhaps", off: "does not start" }[state];
    if (!item.classList.contains("include")) counts[state] += 1;
  }
  document.getElementById("status").textContent = `${counts.on} start, ${counts.open} perhaps, ${counts.off} do not start`;
  show();
}

/** Show the items that meet the search, with the includes above them. */
function show() {
  const text = search.value.trim().toLowerCase();
  for (const item of items) {
    const own = item.querySelector(":scope > details").textContent.toLowerCase();
    item.dataset.found = String(own.includes(text));
    item.hidden = !all.checked && item.dataset.state === "off";
  }
  if (!text) return;
  for (const item of items) {
    const found = item.dataset.found === "true" || item.querySelector('[data-found="true"]') || item.parentElement.closest('[data-found="true"]');
    if (!found) item.hidden = true;
  }
}

form.addEventListener("input", decide);
form.addEventListener("reset", () => setTimeout(decide));
for (const element of [form, document.getElementById("view")]) element.addEventListener("submit", (event) => event.preventDefault());
search.addEventListener("input", show);
all.addEventListener("input", show);
for (const [button, open] of [["open", true], ["close", false]]) {
  document.getElementById(button).addEventListener("click", () => {
    for (const details of document.querySelectorAll("#tree details")) details.open = open;
  });
}
decide();
