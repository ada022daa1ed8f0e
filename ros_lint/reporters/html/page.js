"use strict";

const filters = document.getElementById("filters");
const findings = [...document.querySelectorAll("article")];
const NAMES = ["severity", "rule", "package", "confidence"];

/** Show the findings that meet all filters, and note the filters in the address, so that a link keeps them. */
function apply() {
  const wanted = new FormData(filters);
  const text = wanted.get("text").trim().toLowerCase();
  let shown = 0;
  for (const finding of findings) {
    const meets = NAMES.every((name) => !wanted.get(name) || finding.dataset[name] === wanted.get(name));
    finding.hidden = !meets || !finding.textContent.toLowerCase().includes(text);
    shown += finding.hidden ? 0 : 1;
  }
  for (const section of document.querySelectorAll("section")) section.hidden = !section.querySelector("article:not([hidden])");
  document.getElementById("shown").textContent = `${shown} of ${findings.length} findings`;
  const parts = [...NAMES, "text"].filter((name) => wanted.get(name)).map((name) => [name, wanted.get(name)]);
  history.replaceState(null, "", parts.length ? `#${new URLSearchParams(parts)}` : location.pathname);
}

for (const [name, value] of new URLSearchParams(location.hash.slice(1))) {
  if (filters.elements[name]) filters.elements[name].value = value;
}
filters.addEventListener("input", apply);
filters.addEventListener("submit", (event) => event.preventDefault());
filters.addEventListener("reset", () => setTimeout(apply));
apply();
