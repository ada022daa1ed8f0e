"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const nodes = new Map(data.nodes.map((node) => [node.name, node]));
const needs = new Map(data.nodes.map((node) => [node.name, []]));
const neededBy = new Map(data.nodes.map((node) => [node.name, []]));
for (const edge of data.edges) {
  needs.get(edge.start).push(edge);
  neededBy.get(edge.end).push(edge);
}
const inCycle = new Set(data.edges.filter((edge) => edge.cycle).flatMap((edge) => [edge.start, edge.end]));
const state = { focus: "", selected: "", matrix: false, zoom: 0 };
const HEIGHT = 26;
const ROW = 38;
const GAP = 70;

/** Return an HTML element with attributes, properties of functions, and children. */
function element(tag, attributes = {}, ...children) {
  const result = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") result[name] = value;
    else result.setAttribute(name, value);
  }
  result.append(...children);
  return result;
}

function svgElement(tag, attributes = {}) {
  const result = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) result.setAttribute(name, value);
  return result;
}

/** Return the names within a number of edges from a package, along dependencies or dependents; 0 is any number. */
function within(start, edgesOf, other, distance) {
  const found = new Set([start]);
  let border = [start];
  for (let step = 0; border.length && (!distance || step < distance); step += 1) {
    const next = [];
    for (const name of border) {
      for (const edge of edgesOf.get(name)) {
        if (isEdgeShown(edge, true) && !found.has(edge[other])) {
          found.add(edge[other]);
          next.push(edge[other]);
        }
      }
    }
    border = next;
  }
  return found;
}

function isEdgeShown(edge, evenImplied) {
  return (byId("tests").checked || !edge.test) && (evenImplied || byId("implied").checked || !edge.implied);
}

/** Return the names and edges to draw. */
function visible() {
  let names = new Set(nodes.keys());
  if (state.focus) {
    const distance = Number(byId("depth").value);
    const below = within(state.focus, needs, "end", distance);
    const above = within(state.focus, neededBy, "start", distance);
    names = new Set([...nodes.keys()].filter((name) => below.has(name) || above.has(name)));
  }
  if (!byId("external").checked) names = new Set([...names].filter((name) => nodes.get(name).path || name === state.focus));
  const edges = data.edges.filter((edge) => names.has(edge.start) && names.has(edge.end) && isEdgeShown(edge, state.matrix));
  return { names: [...names], edges };
}

/** Return the edges without those that close a cycle, by depth-first search. */
function acyclic(names, edges) {
  const out = new Map(names.map((name) => [name, []]));
  for (const edge of edges) if (edge.start !== edge.end) out.get(edge.start).push(edge);
  const status = new Map();
  const kept = [];
  for (const root of names) {
    if (status.has(root)) continue;
    const stack = [[root, 0]];
    status.set(root, "open");
    while (stack.length) {
      const top = stack[stack.length - 1];
      const edge = out.get(top[0])[top[1]];
      top[1] += 1;
      if (!edge) {
        status.set(top[0], "done");
        stack.pop();
      } else if (status.get(edge.end) !== "open") {
        kept.push(edge);
        if (!status.has(edge.end)) {
          status.set(edge.end, "open");
          stack.push([edge.end, 0]);
        }
      }
    }
  }
  return kept;
}

/** Return the layer of each package: the number of edges on the longest path to a package without dependencies. */
function layersOf(names, edges) {
  const waiting = new Map(names.map((name) => [name, 0]));
  const dependents = new Map(names.map((name) => [name, []]));
  for (const edge of edges) {
    waiting.set(edge.start, waiting.get(edge.start) + 1);
    dependents.get(edge.end).push(edge.start);
  }
  const layer = new Map(names.map((name) => [name, 0]));
  const ready = names.filter((name) => !waiting.get(name));
  while (ready.length) {
    const name = ready.pop();
    for (const dependent of dependents.get(name)) {
      layer.set(dependent, Math.max(layer.get(dependent), layer.get(name) + 1));
      waiting.set(dependent, waiting.get(dependent) - 1);
      if (!waiting.get(dependent)) ready.push(dependent);
    }
  }
  return layer;
}

const measure = document.createElement("canvas").getContext("2d");
measure.font = "13px system-ui, sans-serif";

/**
 * Place packages in columns, dependents left of their dependencies, and route each edge through a point in every column
 * between its ends. The order in the columns comes from sweeps that put each point at the mean of its neighbours.
 */
function layout(names, edges) {
  const kept = acyclic(names, edges);
  const layer = layersOf(names, kept);
  const last = Math.max(0, ...layer.values());
  const columns = Array.from({ length: last + 1 }, () => []);
  const points = new Map();
  const add = (key, column, width) => {
    const point = { key, column, width, left: [], right: [], order: columns[column].length };
    points.set(key, point);
    columns[column].push(point);
    return point;
  };
  for (const name of names) add(name, last - layer.get(name), measure.measureText(name).width + 20);
  const join = (from, to) => {
    from.right.push(to);
    to.left.push(from);
  };
  const routes = new Map();
  const forward = new Set(kept);
  for (const edge of edges) {
    const route = [points.get(edge.start)];
    if (forward.has(edge)) {
      for (let column = route[0].column + 1; column < points.get(edge.end).column; column += 1) {
        const point = add(`${edge.start}\0${edge.end}\0${column}`, column, 0);
        join(route[route.length - 1], point);
        route.push(point);
      }
      join(route[route.length - 1], points.get(edge.end));
    }
    route.push(points.get(edge.end));
    routes.set(edge, route);
  }
  const mean = (list, fallback) => (list.length ? list.reduce((sum, point) => sum + point.order, 0) / list.length : fallback);
  for (let sweep = 0; sweep < 12; sweep += 1) {
    const side = sweep % 2 ? "right" : "left";
    for (const column of sweep % 2 ? [...columns].reverse() : columns) {
      for (const point of column) point.wanted = mean(point[side], point.order);
      column.sort((first, second) => first.wanted - second.wanted || first.order - second.order);
      column.forEach((point, number) => (point.order = number));
    }
  }
  const heightOf = (point) => (point.width ? ROW : 12);
  let x = 20;
  let bottom = 0;
  for (const column of columns) {
    const width = Math.max(...column.map((point) => point.width));
    let y = 20;
    for (const point of column) {
      point.x = x;
      point.end = x + (point.width ? point.width : width);
      point.y = y + heightOf(point) / 2;
      y += heightOf(point);
    }
    bottom = Math.max(bottom, y);
    x += width + GAP;
  }
  for (const column of columns) {
    const used = column.reduce((sum, point) => sum + heightOf(point), 0);
    for (const point of column) point.y += (bottom - 20 - used) / 2;
  }
  return { points, routes, width: x, height: bottom + 20 };
}

function pathOf(route, edge) {
  const first = route[0];
  const last = route[route.length - 1];
  if (first === last) return `M${first.end},${first.y} c30,-30 -30,-40 -20,-13`;
  if (last.column <= first.column) {
    const low = Math.max(first.y, last.y) + ROW;
    return `M${first.end},${first.y} C${first.end + 50},${low} ${last.x - 50},${low} ${last.x - 6},${last.y}`;
  }
  let text = `M${first.end},${first.y}`;
  let x = first.end;
  let y = first.y;
  for (const point of route.slice(1)) {
    const target = point === last ? point.x - 6 : point.x;
    const middle = (x + target) / 2;
    text += ` C${middle},${y} ${middle},${point.y} ${target},${point.y}`;
    if (point !== last) text += ` L${point.end},${point.y}`;
    x = point.end;
    y = point.y;
  }
  return text;
}

function drawGraph() {
  const { names, edges } = visible();
  const placed = layout(names, edges);
  const svg = svgElement("svg", { viewBox: `0 0 ${placed.width} ${placed.height}`, role: "group", "aria-label": "Packages" });
  const arrow = svgElement("marker", {
    id: "arrow", viewBox: "0 0 8 8", refX: "2", refY: "4", markerWidth: "7", markerHeight: "7", orient: "auto-start-reverse",
  });
  arrow.append(svgElement("path", { d: "M0,0 L8,4 L0,8 z", fill: "context-stroke" }));
  svg.append(arrow);
  for (const edge of edges) {
    const classes = ["edge", ...["test", "cycle", "implied"].filter((name) => edge[name])];
    const path = svgElement("path", { d: pathOf(placed.routes.get(edge), edge), class: classes.join(" "), "marker-end": "url(#arrow)" });
    path.edge = edge;
    const title = svgElement("title");
    title.textContent = `${edge.start} needs ${edge.end}: ${edge.reasons.map((reason) => `<${reason.tag}> ${reason.place}`).join(", ")}`;
    path.append(title);
    svg.append(path);
  }
  const ordered = [...names].map((name) => placed.points.get(name)).sort((a, b) => a.column - b.column || a.order - b.order);
  for (const point of ordered) svg.append(drawNode(point));
  byId("picture").replaceChildren(svg);
  state.size = placed;
  applyZoom();
  return { names, edges };
}

function drawNode(point) {
  const name = point.key;
  const node = nodes.get(name);
  const classes = ["node", ...(node.path ? [] : ["external"]), ...(inCycle.has(name) ? ["cycle"] : [])];
  const label = `${name}, ${node.path ? node.type : "outside of the workspace"}, needs ${needs.get(name).length}, needed by ${neededBy.get(name).length}`;
  const group = svgElement("g", {
    class: classes.join(" "), tabindex: "-1", role: "button", "aria-label": label, transform: `translate(${point.x},${point.y - HEIGHT / 2})`,
  });
  group.append(svgElement("rect", { width: point.width, height: HEIGHT, rx: 5 }));
  const text = svgElement("text", { x: 10, y: 17 });
  text.textContent = name;
  group.append(text);
  group.point = point;
  group.addEventListener("click", () => select(name));
  group.addEventListener("dblclick", () => focusOn(name));
  group.addEventListener("keydown", (event) => onKey(event, name));
  return group;
}

/** Move among packages with the arrow keys; Enter shows only the neighbourhood, Escape shows all packages. */
function onKey(event, name) {
  const all = [...document.querySelectorAll(".node")];
  const here = all.find((node) => node.point.key === name).point;
  const nearest = (list) => {
    const ranked = list.sort((a, b) => Math.abs(a.y - here.y) - Math.abs(b.y - here.y));
    return ranked.length ? ranked[0].key : "";
  };
  const others = all.map((node) => node.point);
  let next = "";
  if (event.key === "ArrowRight") next = nearest(others.filter((point) => needs.get(name).some((edge) => edge.end === point.key)));
  else if (event.key === "ArrowLeft") next = nearest(others.filter((point) => neededBy.get(name).some((edge) => edge.start === point.key)));
  else if (event.key === "ArrowDown") next = nearest(others.filter((point) => point.column === here.column && point.y > here.y));
  else if (event.key === "ArrowUp") next = nearest(others.filter((point) => point.column === here.column && point.y < here.y));
  else if (event.key === "Enter") focusOn(name);
  else if (event.key === " ") select(name);
  else if (event.key === "Escape") focusOn("");
  else return;
  event.preventDefault();
  if (next) select(next, true);
}

function drawMatrix() {
  const { names, edges } = visible();
  const layer = layersOf(names, acyclic(names, edges));
  const order = [...names].sort((a, b) => layer.get(a) - layer.get(b) || a.localeCompare(b));
  const cells = new Map(edges.map((edge) => [`${edge.start}\0${edge.end}`, edge]));
  const head = element("tr", {}, element("th", { scope: "col" }, "needs"));
  for (const name of order) head.append(element("th", { scope: "col" }, element("span", {}, name)));
  const body = element("tbody");
  for (const name of order) {
    const row = element("tr", {}, element("th", { scope: "row" }, link(name)));
    for (const other of order) {
      const edge = cells.get(`${name}\0${other}`);
      const cell = element("td", name === other ? { class: "self" } : {});
      if (edge) {
        const classes = ["test", "cycle"].filter((kind) => edge[kind]).join(" ");
        const label = `${name} needs ${other}`;
        cell.append(element("button", { type: "button", class: classes, "aria-label": label, title: label, onclick: () => select(name) }));
      }
      row.append(cell);
    }
    body.append(row);
  }
  const caption = element("caption", {}, "A mark means that the package of the row needs the package of the column.");
  byId("picture").replaceChildren(element("table", {}, caption, element("thead", {}, head), body));
  return { names, edges };
}

function link(name) {
  return element("button", { type: "button", class: "link", onclick: () => select(name, true) }, name);
}

function draw() {
  const { names, edges } = state.matrix ? drawMatrix() : drawGraph();
  if (!names.includes(state.selected)) state.selected = state.focus;
  const what = state.focus ? `around ${state.focus}` : "of the workspace";
  const cycles = data.cycles.length ? ` ${data.cycles.length === 1 ? "There is a dependency cycle" : `There are ${data.cycles.length} dependency cycles`}.` : "";
  byId("status").textContent = `${names.length} packages and ${edges.length} dependencies ${what}.${cycles}`;
  byId("matrix-button").setAttribute("aria-pressed", String(state.matrix));
  mark();
  details();
}

/** Mark the selected package and its edges, and make one package reachable by the Tab key. */
function mark() {
  const all = [...document.querySelectorAll(".node")];
  const near = new Set([state.selected]);
  for (const path of document.querySelectorAll("path.edge")) {
    const isNear = path.edge.start === state.selected || path.edge.end === state.selected;
    path.classList.toggle("near", isNear);
    path.classList.toggle("faded", Boolean(state.selected) && !isNear);
    if (isNear) near.add(path.edge.start).add(path.edge.end);
  }
  for (const node of all) {
    const name = node.point.key;
    node.classList.toggle("selected", name === state.selected);
    node.classList.toggle("faded", Boolean(state.selected) && !near.has(name));
    node.setAttribute("tabindex", name === state.selected || (!state.selected && node === all[0]) ? "0" : "-1");
  }
}

function select(name, focus = false) {
  if (!visible().names.includes(name)) focusOn(name);
  state.selected = name;
  mark();
  details();
  const node = [...document.querySelectorAll(".node")].find((candidate) => candidate.point.key === name);
  if (node && focus) node.focus();
  node?.scrollIntoView({ block: "nearest", inline: "nearest" });
  location.hash = encodeURIComponent(name);
}

function focusOn(name) {
  state.focus = name;
  state.selected = name;
  state.zoom = 0;
  byId("search").value = name;
  draw();
  if (name) [...document.querySelectorAll(".node")].find((node) => node.point.key === name)?.focus();
}

function details() {
  const panel = byId("details");
  const node = nodes.get(state.selected);
  if (!node) {
    const parts = [element("h2", {}, "No package is selected")];
    parts.push(element("p", {}, "Select a package to list its dependencies. Enter or a double click shows only its neighbourhood."));
    if (data.cycles.length) parts.push(element("h3", { class: "cycle-text" }, "Dependency cycles"));
    for (const cycle of data.cycles) {
      const names = cycle.flatMap((name, number) => (number ? [" needs ", link(name)] : [link(name)]));
      parts.push(element("p", {}, ...names));
    }
    panel.replaceChildren(...parts);
    return;
  }
  panel.replaceChildren(
    element("h2", {}, node.name),
    element("p", {}, node.path ? `${node.type} in ${node.path}` : "Outside of the workspace"),
    element("button", { type: "button", onclick: () => focusOn(node.name) }, "Show only its neighbourhood"),
    ...section("Needs", needs.get(node.name), "end"),
    ...section("Needed by", neededBy.get(node.name), "start"),
  );
}

function section(title, edges, other) {
  const list = element("ul");
  for (const edge of [...edges].sort((a, b) => a[other].localeCompare(b[other]))) {
    const item = element("li", {}, link(edge[other]));
    if (edge.cycle) item.append(element("span", { class: "cycle-text" }, " (cycle)"));
    if (edge.test) item.append(" (tests only)");
    for (const reason of edge.reasons) {
      const condition = reason.certain ? "" : ", if its condition is true";
      item.append(element("div", { class: "evidence" }, `<${reason.tag}> ${reason.place}${condition}`));
    }
    list.append(item);
  }
  return [element("h3", {}, `${title} (${edges.length})`), list];
}

function applyZoom() {
  const svg = document.querySelector("svg");
  if (!svg) return;
  const picture = byId("picture");
  if (!state.zoom) state.zoom = Math.min(1.2, Math.max(0.75, (picture.clientWidth - 4) / state.size.width));
  svg.setAttribute("width", state.size.width * state.zoom);
  svg.setAttribute("height", state.size.height * state.zoom);
}

function zoom(factor) {
  state.zoom = factor ? Math.min(4, Math.max(0.1, state.zoom * factor)) : 0;
  applyZoom();
}

byId("names").append(...data.nodes.map((node) => element("option", { value: node.name })));
byId("externals").hidden = data.nodes.every((node) => node.path);
byId("search").addEventListener("input", (event) => {
  const text = event.target.value.trim();
  if (nodes.has(text)) focusOn(text);
  else if (!text) focusOn("");
});
byId("controls").addEventListener("submit", (event) => {
  event.preventDefault();
  const text = byId("search").value.trim().toLowerCase();
  const names = [...nodes.keys()];
  const match = names.find((name) => name.toLowerCase() === text) ?? names.find((name) => name.toLowerCase().includes(text));
  if (match && text) focusOn(match);
  else byId("status").textContent = `No package contains '${text}'.`;
});
for (const id of ["depth", "tests", "implied", "external"]) byId(id).addEventListener("change", draw);
byId("all").addEventListener("click", () => focusOn(""));
byId("smaller").addEventListener("click", () => zoom(0.8));
byId("larger").addEventListener("click", () => zoom(1.25));
byId("fit").addEventListener("click", () => zoom(0));
byId("matrix-button").addEventListener("click", () => {
  state.matrix = !state.matrix;
  draw();
});
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && document.activeElement !== byId("search")) {
    event.preventDefault();
    byId("search").focus();
  }
});
const wanted = decodeURIComponent(location.hash.slice(1));
if (nodes.has(wanted)) state.selected = wanted;
draw();
