"use strict";
// Okabe and Ito's colours with markers and dashes, as the figures have them.
const COLOURS = ["#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
const DASHES = ["", "7 3", "2 3", "9 3 2 3"];
const MARKERS = ["circle", "square", "triangle", "diamond"];
const SVG = "http://www.w3.org/2000/svg";

function make(name, attributes, ...children) {
  const element = document.createElementNS(SVG, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  element.append(...children);
  return element;
}

// -- the table of specimens --

const table = document.getElementById("table");

function sortValue(row, column) {
  const cell = row.cells[column];
  const shown = cell.querySelector(`[data-load="${table.dataset.load}"]`) || cell;
  return shown.dataset.sort === undefined ? cell.textContent.trim() : shown.dataset.sort;
}

// One nominal pressure for all rows, so that a column compares like with like.
function showLoad(key) {
  table.dataset.load = key;
  for (const one of table.querySelectorAll("td > [data-load]")) one.hidden = one.dataset.load !== key;
  const sorted = table.querySelector("th[aria-sort]");
  if (sorted) order(sorted);
}

// Missing values stand last, whichever way.
function compare(a, b, down) {
  if (a === "" || b === "") return (a === "") - (b === "");
  const both = [Number(a), Number(b)];
  const order = both.some(Number.isNaN) ? a.localeCompare(b) : both[0] - both[1];
  return down ? -order : order;
}

function sortBy(header) {
  const down = header.getAttribute("aria-sort") === "ascending";
  for (const other of header.parentNode.children) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", down ? "descending" : "ascending");
  order(header);
}

function order(header) {
  const down = header.getAttribute("aria-sort") === "descending";
  const body = table.querySelector("tbody");
  const rows = [...body.rows].map((row) => [sortValue(row, header.cellIndex), row]);
  rows.sort((a, b) => compare(a[0], b[0], down));
  body.append(...rows.map((pair) => pair[1]));
}

// -- curves --

const own = JSON.parse(document.getElementById("curves-data").textContent);
let others = [];

function fields(line) {
  const found = [];
  line.replace(/("(?:[^"]|"")*"|[^,]*)(,|$)/g, (all, field, end, at) => {
    if (at < line.length || end === "" && line.endsWith(",")) {
      found.push(field.startsWith('"') ? field.slice(1, -1).replaceAll('""', '"') : field);
    }
    return "";
  });
  return found;
}

function readCurves(text) {
  const lines = text.split(/\r?\n/).filter((line) => line);
  const names = fields(lines.shift() || "");
  const needed = ["study", "specimen", "quantity", "unit", "nominal_pressure_MPa", "value", "low", "high"];
  const missing = needed.filter((name) => !names.includes(name));
  if (missing.length) throw new Error(`no column ${missing.join(", ")}: choose the curves.csv of a study`);
  return lines.map((line) => {
    const values = fields(line);
    const row = Object.fromEntries(names.map((name, i) => [name, values[i] ?? ""]));
    for (const name of needed.slice(4)) row[name] = row[name] === "" ? null : Number(row[name]);
    return row;
  });
}

function curvesOf(quantity) {
  const picked = new Set([...document.querySelectorAll(".pick:checked")].map((box) => box.value));
  const curves = new Map();
  for (const row of own.filter((row) => picked.has(row.specimen)).concat(others)) {
    if (row.quantity !== quantity) continue;
    const name = others.includes(row) ? `${row.specimen} (${row.study}, other file)` : row.specimen;
    if (!curves.has(name)) curves.set(name, []);
    curves.get(name).push(row);
  }
  return curves;
}

function scale(low, high, from, to, logarithmic) {
  const f = logarithmic ? Math.log10 : (x) => x;
  const span = f(high) - f(low) || 1;
  return (x) => from + (to - from) * (f(x) - f(low)) / span;
}

function ticks(low, high, logarithmic) {
  const found = [];
  if (logarithmic) {
    const steps = high / low > 200 ? [1] : [1, 2, 5];
    for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e++) {
      for (const step of steps) found.push(step * 10 ** e);
    }
  } else {
    const rough = (high - low) / 6 || 1;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((m) => m * power >= rough) * power;
    for (let t = Math.ceil(low / step) * step; t <= high + step / 1e6; t += step) found.push(t);
  }
  return found.filter((t) => t >= low * (1 - 1e-9) && t <= high * (1 + 1e-9));
}

function label(value) {
  return String(Number(value.toPrecision(3)));
}

function marker(kind, x, y, colour, full = true) {
  const shapes = {
    circle: () => make("circle", { cx: x, cy: y, r: 4.5 }),
    square: () => make("rect", { x: x - 4, y: y - 4, width: 8, height: 8 }),
    triangle: () => make("path", { d: `M${x} ${y - 5.5}l5 9h-10z` }),
    diamond: () => make("path", { d: `M${x} ${y - 6}l5.5 6l-5.5 6l-5.5-6z` }),
  };
  const shape = shapes[kind]();
  shape.setAttribute("fill", full ? colour : "#ffffff");
  shape.setAttribute("stroke", colour);
  return shape;
}

function style(i) {
  return {
    colour: COLOURS[i % COLOURS.length],
    dash: DASHES[Math.floor(i / COLOURS.length) % DASHES.length],
    mark: MARKERS[i % MARKERS.length],
  };
}

function draw() {
  const quantity = document.getElementById("quantity").value;
  const curves = curvesOf(quantity);
  const rows = [...curves.values()].flat();
  const chart = document.getElementById("chart"), legend = document.getElementById("legend");
  chart.replaceChildren();
  legend.replaceChildren();
  if (!rows.length) {
    chart.append("Tick a specimen that has this quantity.");
    return;
  }
  const dimension = quantity.startsWith("Delta");
  const logarithmic = !dimension && rows.every((row) => row.value > 0);
  // As wide as its place, so that letters keep their size on a phone.
  const width = Math.max(320, Math.min(760, chart.clientWidth - 2)), height = Math.max(300, 0.58 * width);
  const left = 72, right = 16, top = 14, bottom = 52;
  const pressures = rows.map((row) => row.nominal_pressure_MPa).filter((p) => p > 0);
  let values = rows.map((row) => row.value);
  if (dimension) values = [0, 2];
  const xs = [Math.min(...pressures) / 1.3, Math.max(...pressures) * 1.3];
  let ys = [Math.min(...values), Math.max(...values)];
  ys = logarithmic ? [ys[0] / 1.6, ys[1] * 1.6] : [ys[0] - 0.04 * (ys[1] - ys[0]), ys[1] + 0.04 * (ys[1] - ys[0] || 1)];
  const x = scale(...xs, left, width - right, true), y = scale(...ys, height - bottom, top, logarithmic);
  const clamp = (v) => Math.min(Math.max(v, ys[0]), ys[1]);
  const unit = rows[0].unit;
  const svg = make("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "font-size": 13 });
  svg.setAttribute("aria-label", `${quantity} against nominal pressure, ${[...curves.keys()].join(", ")}`);
  for (const t of ticks(...xs, true)) {
    svg.append(make("line", { x1: x(t), x2: x(t), y1: top, y2: height - bottom, stroke: "#e2e2e2" }));
    svg.append(make("text", { x: x(t), y: height - bottom + 18, "text-anchor": "middle" }, label(t)));
  }
  for (const t of ticks(...ys, logarithmic)) {
    svg.append(make("line", { x1: left, x2: width - right, y1: y(t), y2: y(t), stroke: "#e2e2e2" }));
    svg.append(make("text", { x: left - 8, y: y(t) + 4, "text-anchor": "end" }, label(t)));
  }
  svg.append(make("rect", { x: left, y: top, width: width - left - right, height: height - top - bottom, fill: "none", stroke: "#1b1b1b" }));
  svg.append(make("text", { x: (left + width - right) / 2, y: height - 12, "text-anchor": "middle" }, "nominal pressure (MPa)"));
  const middle = (top + height - bottom) / 2;
  svg.append(make("text", { x: 18, y: middle, "text-anchor": "middle", transform: `rotate(-90 18 ${middle})` }, `${quantity.replace("Delta_sigma", "Δσ")}${unit === "mm2/mm2" ? "" : ` (${unit})`}`));
  [...curves].forEach(([name, points], i) => {
    const { colour, dash, mark } = style(i);
    const drawn = points.filter((row) => row.nominal_pressure_MPa > 0);
    const path = drawn.map((row) => `${x(row.nominal_pressure_MPa)},${y(row.value)}`).join(" ");
    svg.append(make("polyline", { points: path, fill: "none", stroke: colour, "stroke-width": 2, "stroke-dasharray": dash }));
    for (const row of drawn) {
      const at = x(row.nominal_pressure_MPa);
      if (row.low !== null && row.high !== null) {
        svg.append(make("line", { x1: at, x2: at, y1: y(clamp(row.low)), y2: y(clamp(row.high)), stroke: colour, "stroke-width": 1.2 }));
      }
      const shape = marker(mark, at, y(row.value), colour, String(row.resolved).toLowerCase() !== "false");
      shape.append(make("title", {}, `${name}: ${label(row.value)} ${/^(1|mm2.mm2)$/.test(unit) ? "" : unit} at ${label(row.nominal_pressure_MPa)} MPa`));
      svg.append(shape);
    }
    const key = make("svg", { viewBox: "0 0 52 18", "aria-hidden": "true" });
    key.append(make("line", { x1: 2, x2: 50, y1: 9, y2: 9, stroke: colour, "stroke-width": 2, "stroke-dasharray": dash }), marker(mark, 26, 9, colour));
    const entry = document.createElement("li");
    entry.append(key, name);
    legend.append(entry);
  });
  chart.append(svg);
}

// -- statements --

function openStatement(event) {
  const link = event.target.closest("[data-opens]");
  if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
  const dialog = document.getElementById("opened");
  const content = document.getElementById(link.dataset.opens);
  event.preventDefault();
  dialog.querySelector("div").replaceChildren(content.content.cloneNode(true));
  dialog.showModal();
}

if (table) {
  document.getElementById("load")?.addEventListener("change", (event) => showLoad(event.target.value));
  table.querySelector("thead").addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (button) sortBy(button.closest("th"));
  });
  const select = document.getElementById("quantity");
  for (const name of new Set(own.map((row) => row.quantity))) select.append(new Option(name.replace("Delta_sigma", "Δσ"), name));
  select.addEventListener("change", draw);
  table.addEventListener("change", (event) => { if (event.target.matches(".pick")) draw(); });
  document.getElementById("other").addEventListener("change", async (event) => {
    const said = document.getElementById("other-said");
    try {
      others = event.target.files.length ? readCurves(await event.target.files[0].text()) : [];
      said.textContent = others.length ? `${new Set(others.map((row) => row.specimen)).size} specimens of ${others[0].study} laid over.` : "";
    } catch (error) {
      others = [];
      said.textContent = error.message;
    }
    draw();
  });
  document.addEventListener("click", openStatement);
  addEventListener("resize", draw);
  draw();
}
