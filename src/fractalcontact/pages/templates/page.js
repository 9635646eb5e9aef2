"use strict";
// Okabe and Ito's colours with markers and dashes, as the figures have them.
const COLOURS = ["#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
// Dashes of page.css.
const DASHES = 4;
const MARKERS = ["circle", "square", "triangle", "diamond"];
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

function draw() {
  const quantity = document.getElementById("quantity").value;
  const curves = curvesOf(quantity);
  const rows = [...curves.values()].flat().filter((row) => row.nominal_pressure_MPa > 0);
  const chart = document.getElementById("chart"), legend = document.getElementById("legend");
  chart.replaceChildren();
  legend.replaceChildren();
  if (!rows.length) {
    chart.append("Tick a specimen that has this quantity.");
    return;
  }
  const dimension = quantity.startsWith("Delta");
  const log = !dimension && rows.every((row) => row.value > 0);
  // As wide as its place, so that letters keep their size on a phone.
  const width = Math.max(320, Math.min(760, chart.clientWidth - 2)), height = Math.max(300, 0.58 * width);
  const frame = { right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
  const up = new Scale(rows.map((row) => row.value), dimension ? { from: 0, to: 2 } : { log }, frame.bottom, frame.top);
  const unit = /^(1|mm2.mm2)$/.test(rows[0].unit) ? "" : rows[0].unit;
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "font-size": 13 });
  chart.append(drawing);
  frame.left = leftOf(drawing, up.ticks(ticksAlong(frame.bottom - frame.top)));
  const across = new Scale(rows.map((row) => row.nominal_pressure_MPa), { log: true }, frame.left, frame.right);
  drawing.setAttribute("aria-label", `${quantity} against nominal pressure, ${[...curves.keys()].join(", ")}`);
  drawAxes(drawing, frame, across, up, { label: "nominal pressure (MPa)" }, { label: `${symbols(quantity)} (${unit || 1})` });
  // A bar that leaves the frame ends at it; of a missing end there is none.
  const within = (end) => (end === null ? NaN : Math.min(Math.max(end, up.low), up.high));
  [...curves].forEach(([name, of], i) => {
    const points = of.map((row) => ({
      x: row.nominal_pressure_MPa,
      y: row.value,
      low: within(row.low),
      high: within(row.high),
      hollow: String(row.resolved).toLowerCase() === "false",
      words: `${name}: ${short(row.value, 3)} ${unit} at ${short(row.nominal_pressure_MPa, 3)} MPa`,
    }));
    const [colour, marker] = [COLOURS[i % COLOURS.length], MARKERS[i % MARKERS.length]];
    const style = `dash-${Math.floor(i / COLOURS.length) % DASHES}`;
    const curve = { class: "curve", stroke: colour, fill: colour };
    drawSeries(svg("g", curve, drawing), { points, style, marker, size: 4.5 }, across, up);
    const key = svg("svg", { viewBox: "0 0 52 18", "aria-hidden": "true", ...curve });
    svg("path", { d: "M2 9H50", class: `line ${style}` }, key);
    drawMark(key, marker, 26, 9, 4.5, "mark");
    const entry = document.createElement("li");
    entry.append(key, name);
    legend.append(entry);
  });
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
