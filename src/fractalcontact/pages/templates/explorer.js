// The page: two states A and B, their controls, and all that follows from them.
const NAMES = { a: "A", b: "B" };
const INDEX = JSON.parse(document.getElementById("index").textContent);
const COLOURS = INDEX.colours.map((text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)));
const byId = (id) => document.getElementById(id);
const loaded = new Map();
const state = { a: null, b: null }; // {states, place, map}
const panels = {};
let drawn = 0;

/** States of the i-th specimen, unpacked once. */
function specimen(i) {
  if (!loaded.has(i)) {
    const { name, label } = INDEX.specimens[i];
    const raw = JSON.parse(byId(`states-${i}`).textContent);
    loaded.set(i, new States(name, label, raw).load());
  }
  return loaded.get(i);
}

const comparing = () => byId("compare").checked;
const shownStates = () => (comparing() ? ["a", "b"] : ["a"]);
const chosenField = () => document.querySelector("input[name=field]:checked").value;

// --- controls of one state

function makePanel(who) {
  const panel = byId("state").content.cloneNode(true).firstElementChild;
  panel.dataset.state = who;
  panel.querySelector(".badge").textContent = NAMES[who];
  const select = panel.querySelector(".specimen");
  INDEX.specimens.forEach(({ name, label }, i) => {
    const words = label === name ? name : `${name}: ${label}`;
    select.append(new Option(words, String(i)));
  });
  select.addEventListener("change", () => chooseSpecimen(who, Number(select.value)));
  for (const [name, dimension] of [["offset", "offset"], ["load", "normal_force"]])
    panel.querySelector(`.${name}`).addEventListener("input", (event) => move(who, { [dimension]: Number(event.target.value) }));
  panel.querySelector(".nearest").addEventListener("click", () => move(who, state[who].states.nearestSolved(state[who].place)));
  panel.querySelector(".go").addEventListener("click", () => goToStored(who));
  listenToMap(who, panel);
  byId("states").append(panel);
  return panel;
}

async function chooseSpecimen(who, i) {
  const states = await specimen(i);
  state[who] = { states, place: states.home(), number: i };
  fillControls(who);
  await show();
}

/** Controls of the specimen: lengths of the sliders, directions, resolutions. */
function fillControls(who) {
  const { states, number } = state[who];
  const panel = panels[who];
  panel.querySelector(".specimen").value = String(number);
  panel.querySelector(".offset").max = states.count("offset") - 1;
  panel.querySelector(".load").max = states.count("normal_force") - 1;
  for (const [name, dimension] of [["offset", "offset"], ["load", "normal_force"]]) {
    const strip = panel.querySelector(`.${name} + .strip`);
    strip.replaceChildren(...states.raw[dimension].map(() => document.createElement("i")));
  }
  const spacing = states.raw.window.spacing[1];
  fillChoice(who, "direction", (value) => TOWARDS[value] || value);
  fillChoice(who, "resolution", (value) => `${short(value * spacing, 3)} mm`);
}

function fillChoice(who, name, words) {
  const fieldset = panels[who].querySelector(`.${name}`);
  const labels = state[who].states.raw[name].map((value, i) => {
    const label = document.createElement("label");
    const input = document.createElement("input");
    Object.assign(input, { type: "radio", name: `${name}-${who}`, value: String(i) });
    input.addEventListener("change", () => move(who, { [name]: i }));
    const text = document.createElement("span");
    text.textContent = words(value);
    label.append(input, text);
    return label;
  });
  fieldset.replaceChildren(fieldset.querySelector("legend"), ...labels);
}

function move(who, change) {
  Object.assign(state[who].place, change);
  show();
}

/** The nearest state whose pressure, gap or flow is stored. */
function goToStored(who) {
  const { states, place } = state[who];
  const home = states.home();
  const loads = states.raw.fields[chosenField()].loads;
  const load = loads.reduce((best, i) => (Math.abs(i - place.normal_force) < Math.abs(best - place.normal_force) ? i : best), loads[0]);
  move(who, { ...home, normal_force: load });
}

function showControls(who) {
  const { states, place } = state[who];
  const panel = panels[who];
  const { raw } = states;
  const offset = `${short(raw.offset[place.offset])} mm`;
  const made = states.at("closure/offset_on_grid", place);
  const exactly = Math.abs(made - raw.offset[place.offset]) > 1e-9 ? ` (${short(made)} mm in whole cells)` : "";
  const force = raw.normal_force[place.normal_force];
  const load = `${forceWords(force)} = ${pressureWords(raw.nominal_pressure[place.normal_force])}`;
  for (const [name, dimension, words] of [["offset", "offset", offset + exactly], ["load", "normal_force", load]]) {
    const slider = panel.querySelector(`.${name}`);
    slider.value = String(place[dimension]);
    slider.setAttribute("aria-valuetext", words);
    slider.disabled = states.count(dimension) < 2;
    panel.querySelector(`.${name}-words`).textContent = words;
    [...panel.querySelector(`.${name} + .strip`).children].forEach((mark, i) => {
      const solved = states.solved({ ...place, [dimension]: i });
      mark.className = `${solved ? "solved" : "unsolved"}${i === place[dimension] ? " here" : ""}`;
    });
  }
  for (const name of ["direction", "resolution"])
    panel.querySelectorAll(`.${name} input`).forEach((input, i) => {
      input.checked = i === place[name];
      input.parentElement.classList.toggle("unsolved", !states.solved({ ...place, [name]: i }));
    });
  const missing = panel.querySelector(".missing");
  missing.hidden = states.solved(place);
  missing.querySelector("span").textContent = "This state was not solved: no figure or fit of the study needs it.";
}

// --- maps

async function showMap(who) {
  const { states, place } = state[who];
  const field = chosenField();
  const map = await mapOf(states, { ...place }, field, byId("marks").checked);
  if (state[who].states !== states || Object.keys(place).some((key) => place[key] !== map.place[key])) return;
  state[who].map = map;
  const panel = panels[who];
  const canvas = panel.querySelector("canvas");
  drawMap(canvas, map, COLOURS);
  canvas.closest(".canvas").style.aspectRatio = `${map.columns * states.raw.window.spacing[1]} / ${map.rows * states.raw.window.spacing[0]}`;
  canvas.classList.toggle("unsolved", !map.domain);
  const what = map.values ? field : "contact domain";
  const size = states.raw.window.shape.map((n, i) => short(n * states.raw.window.spacing[i], 3));
  canvas.setAttribute("aria-label", map.domain ? `Map of the ${what}, ${size[1]} mm East by ${size[0]} mm North` : "This state was not solved");
  panel.querySelector(".colour-key").replaceChildren(...mapLegend(map, COLOURS));
  showStored(panel, states, field, map);
  const at = state[who].node;
  if (at && at.row < map.rows && at.column < map.columns) readNode(who, at.row, at.column);
  else leaveNode(who);
}

/** Where the field is stored, if it is not here. */
function showStored(panel, states, field, map) {
  const note = panel.querySelector(".stored");
  const { fields } = states.raw;
  note.hidden = field === "contact" || Boolean(map.values);
  if (note.hidden) return;
  const stored = fields && fields[field].loads.length;
  note.querySelector("button").hidden = !stored;
  if (!stored) {
    note.querySelector("span").textContent = `The atlas has no map of the ${field} of this specimen. The contact domain is shown.`;
    return;
  }
  const loads = fields[field].loads.map((i) => forceWords(states.raw.normal_force[i]));
  const where = fields.direction === "none" ? "" : ` at v = ${short(fields.offset)} mm, ${TOWARDS[fields.direction]},`;
  const under = loads.length > 4 ? `${loads.length} loads` : loads.join(", ");
  note.querySelector("span").textContent = `The ${field} is stored${where} under ${under}, at the finest spacing. The contact domain is shown.`;
}

function listenToMap(who, panel) {
  const canvas = panel.querySelector("canvas");
  const read = (event) => {
    const { map } = state[who];
    const box = canvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - box.left) / box.width) * map.columns);
    const row = map.rows - 1 - Math.floor(((event.clientY - box.top) / box.height) * map.rows);
    readNode(who, within(row, map.rows), within(column, map.columns));
  };
  canvas.addEventListener("pointermove", read);
  canvas.addEventListener("pointerdown", read);
  // A finger that is lifted leaves what it read.
  canvas.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && leaveNode(who));
  canvas.addEventListener("keydown", (event) => {
    const { map, node } = state[who];
    const step = event.shiftKey ? 10 : 1;
    const change = { ArrowLeft: [0, -step], ArrowRight: [0, step], ArrowUp: [step, 0], ArrowDown: [-step, 0] }[event.key];
    if (!change) return;
    event.preventDefault();
    const { row, column } = node || { row: map.rows >> 1, column: map.columns >> 1 };
    readNode(who, within(row + change[0], map.rows), within(column + change[1], map.columns));
  });
}

const within = (i, n) => Math.min(n - 1, Math.max(0, i));

function readNode(who, row, column) {
  const { map } = state[who];
  state[who].node = { row, column };
  panels[who].querySelector(".node").textContent = nodeWords(map, row, column);
  const cursor = panels[who].querySelector(".cursor");
  cursor.hidden = false;
  cursor.style.left = `${((column + 0.5) / map.columns) * 100}%`;
  cursor.style.top = `${((map.rows - row - 0.5) / map.rows) * 100}%`;
}

function leaveNode(who) {
  state[who].node = null;
  panels[who].querySelector(".cursor").hidden = true;
  const { raw } = state[who].states;
  const size = raw.window.shape.map((n, i) => short(n * raw.window.spacing[i], 3));
  panels[who].querySelector(".node").textContent = `${size[1]} mm East by ${size[0]} mm North; point at a node to read it`;
}

/** Maps at one or four times their size, with the node that was read, or some contact, in sight. */
function zoom() {
  const factor = Number(document.querySelector("input[name=zoom]:checked").value);
  for (const who of ["a", "b"]) {
    const frame = panels[who].querySelector(".canvas");
    frame.classList.toggle("zoomed", factor > 1);
    const { map } = state[who];
    if (!map) continue;
    const node = state[who].node || contactNearMiddle(map);
    const [across, up] = [(node.column + 0.5) / map.columns, 1 - (node.row + 0.5) / map.rows];
    frame.scrollLeft = across * frame.scrollWidth - frame.clientWidth / 2;
    frame.scrollTop = up * frame.scrollHeight - frame.clientHeight / 2;
  }
}

// --- values, the lines of Python, the link

function showValues() {
  const { rows, arrays } = state.a.states.raw;
  const body = byId("values").querySelector("tbody");
  body.replaceChildren(...rows.map((key) => valueRow(key, arrays[key])));
  byId("values").classList.toggle("comparing", comparing());
}

function valueRow(key, { units, meaning }) {
  const row = document.createElement("tr");
  row.dataset.key = key;
  const head = document.createElement("th");
  head.scope = "row";
  head.textContent = symbols(meaning);
  const unit = document.createElement("td");
  unit.textContent = unitWords(units);
  // Beside the quantity where a phone has no room for a column.
  const beside = document.createElement("small");
  beside.textContent = unit.textContent ? ` (${unit.textContent})` : "";
  head.append(beside);
  row.append(head, unit);
  const values = {};
  for (const who of ["a", "b"]) {
    const cell = document.createElement("td");
    cell.className = who;
    if (comparing() || who === "a") {
      values[who] = state[who].states.at(key, state[who].place);
      cell.dataset.value = String(values[who]);
      cell.textContent = valueWords(key, state[who], values[who]);
    }
    row.append(cell);
  }
  const ratio = document.createElement("td");
  ratio.className = "b";
  if (comparing()) ratio.textContent = short(values.b / values.a, 3);
  row.append(ratio);
  return row;
}

/** A value with its interval or error, or why there is none. */
function valueWords(key, { states, place }, value) {
  if (!Number.isFinite(value)) return states.solved(place) ? states.reason(key, place) || "–" : "not solved";
  const words = short(value) + errorWords(key, states, place);
  const by = states.undetermined(key, place);
  const said = by ? `undetermined (${words})${by === "scan" ? ", by the scan" : ""}` : words;
  return states.ofFinest(key, place) ? `${said} at the finest spacing` : said;
}

/** Interval or total error of a number of the joint; where neither is known, the solver's part of it. */
function errorWords(key, states, place) {
  const [low, high, solver] = ["_low", "_high", "_error"].map((end) => states.at(key + end, place));
  if (Number.isFinite(low) && Number.isFinite(high)) return ` [${short(low, 3)}, ${short(high, 3)}]`;
  const total = states.total(key, place);
  if (Number.isFinite(total)) return ` ± ${short(total, 2)}`;
  return states.raw.of_joint.includes(key) ? `, error not known (solver’s part ${short(solver, 2)})` : "";
}

function showCode() {
  const { states, place } = state.a;
  const { raw } = states;
  const text = JSON.stringify;
  byId("code").textContent = [
    "import xarray as xr",
    'atlas = xr.open_datatree("atlas.nc")',
    `curves = atlas[${text(`closure/${states.name}`)}].to_dataset()`,
    `state = curves.sel(direction=${text(raw.direction[place.direction])}, resolution=${raw.resolution[place.resolution]})`,
    `state = state.sel(offset=${raw.offset[place.offset]}, normal_force=${raw.normal_force[place.normal_force]}, method="nearest")`,
    'state["closure"].item()' + (states.solved(place) ? `   # ${short(states.at("closure/closure", place))} mm` : "   # nan: not solved"),
  ].join("\n");
}

/** A state for a link. */
function stateWords({ states, place }) {
  const { raw } = states;
  return [
    encodeURIComponent(states.name),
    raw.direction[place.direction],
    Number(raw.offset[place.offset].toPrecision(8)),
    Number(raw.normal_force[place.normal_force].toPrecision(8)),
    raw.resolution[place.resolution],
  ].join("~");
}

function showLink() {
  const view = [`a=${stateWords(state.a)}`];
  if (comparing()) view.push(`b=${stateWords(state.b)}`);
  if (chosenField() !== "contact") view.push(`map=${chosenField()}`);
  if (byId("logarithmic").checked) view.push("log=1");
  if (!byId("marks").checked) view.push("marks=0");
  history.replaceState(null, "", `#${view.join("&")}`);
  byId("link").value = location.href;
}

/** State of words such as "twin~W~0.3~1000~1" or "twin"; what is missing is that of the maps. */
async function stateOf(words, fallback) {
  const parts = (words || "").split("~");
  const [direction, offset, force, resolution] = parts.length > 4 ? parts.splice(-4) : [];
  const name = parts.join("~");
  const i = INDEX.specimens.findIndex((one) => one.name === name);
  if (i < 0 && fallback) return { ...fallback, place: { ...fallback.place }, node: null };
  const number = Math.max(0, i);
  const states = await specimen(number);
  const place = states.home();
  const { raw } = states;
  if (raw.direction.includes(direction)) place.direction = raw.direction.indexOf(direction);
  if (raw.resolution.includes(Number(resolution))) place.resolution = raw.resolution.indexOf(Number(resolution));
  if (offset && Number.isFinite(Number(offset))) place.offset = nearest(raw.offset, Number(offset));
  if (force && Number.isFinite(Number(force))) place.normal_force = nearest(raw.normal_force, Number(force));
  return { states, place, number };
}

async function restore() {
  const view = new URLSearchParams(location.hash.slice(1));
  state.a = await stateOf(view.get("a") || view.get("specimen"));
  state.b = await stateOf(view.get("b"), state.a);
  byId("compare").checked = view.has("b");
  byId("logarithmic").checked = view.get("log") === "1";
  byId("marks").checked = view.get("marks") !== "0";
  const field = document.querySelector(`input[name=field][value="${["pressure", "gap", "flow"].includes(view.get("map")) ? view.get("map") : "contact"}"]`);
  field.checked = true;
  fillControls("a");
  fillControls("b");
  await show();
}

// --- all of it

async function show() {
  const turn = ++drawn;
  document.body.classList.toggle("comparing", comparing());
  panels.b.hidden = !comparing();
  byId("marking").hidden = !shownStates().some((who) => state[who].states.raw.marks);
  for (const who of shownStates()) showControls(who);
  showValues();
  showCode();
  showLink();
  showCurves();
  for (const who of shownStates()) await showMap(who);
  if (turn === drawn) document.body.dataset.drawn = String(turn);
}

async function start() {
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old for the page: it has no DecompressionStream (Chrome 80, Firefox 113, Safari 16.4)");
  if (!INDEX.specimens.length) throw new Error("the study has no contact states");
  for (const who of ["a", "b"]) panels[who] = makePanel(who);
  byId("explorer").hidden = false;
  for (const id of ["logarithmic", "marks"]) byId(id).addEventListener("change", show);
  byId("compare").addEventListener("change", show);
  document.querySelectorAll("input[name=field]").forEach((input) => input.addEventListener("change", show));
  byId("copy").addEventListener("click", copyLink);
  byId("view").addEventListener("submit", (event) => event.preventDefault());
  document.querySelectorAll("input[name=zoom]").forEach((input) => input.addEventListener("change", zoom));
  window.addEventListener("hashchange", restore);
  new ResizeObserver(() => state.a && showCurves()).observe(document.querySelector(".plots"));
  await restore();
}

async function copyLink() {
  const link = byId("link");
  link.select();
  const copied = navigator.clipboard ? navigator.clipboard.writeText(link.value) : Promise.reject(new Error());
  byId("copied").textContent = await copied.then(() => "copied", () => "press Ctrl-C: the link is selected");
}

start().catch((error) => {
  byId("message").textContent = `The explorer cannot be shown: ${error.message}`;
  byId("message").hidden = false;
});
