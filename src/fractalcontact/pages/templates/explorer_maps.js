// Maps of the contact, the pressure, the gap or the flow of one state on a canvas. Marked nodes are hatched
// over their colour, so that one sees both. Colours are Okabe and Ito's.
// Pressures stand on black: few nodes touch, and the colours of most are light.
const INK = { contact: [0, 0, 0], free: [255, 255, 255], missing: [205, 205, 205], dark: [0, 0, 0] };
const MARKS = {
  overlap: { colour: [213, 94, 0], rising: true, words: "faces overlap here as scanned" },
  suspect: { colour: [204, 121, 167], rising: false, words: "otherwise suspicious cell" },
};
// Pixels of a node's side where nodes are marked, up to this many pixels of the map's side.
const HATCHED = 3;
const LARGEST_HATCHED = 2000;
const DECADES_OF_PRESSURE = 3;

/** All that a map needs of a state: nodes by row from the South, column from the West. */
async function mapOf(states, place, field, marked) {
  const factor = states.raw.resolution[place.resolution];
  const [rows, columns] = states.raw.domains[factor].shape;
  const map = { states, place, factor, rows, columns, field, marks: {}, values: null };
  map.domain = await states.domain(place);
  if (marked)
    for (const kind of Object.keys(MARKS)) map.marks[kind] = await states.marks(kind, place);
  for (const one of ["pressure", "gap", "flow"])
    if (map.domain && states.stores(one, place)) map[one] = await states.field(one, place);
  if (field !== "contact" && map[field]) map.values = map[field];
  return map;
}

/** What kind of mark a node has, "" if none. */
function markOf(map, row, column) {
  for (const [kind, bits] of Object.entries(map.marks))
    if (bits && bits.at(row * map.factor, column * map.factor)) return kind;
  return "";
}

function drawMap(canvas, map, colours) {
  const { rows, columns } = map;
  const marked = Object.values(map.marks).some(Boolean);
  const size = marked && Math.max(rows, columns) * HATCHED <= LARGEST_HATCHED ? HATCHED : 1;
  canvas.width = columns * size;
  canvas.height = rows * size;
  const context = canvas.getContext("2d", { willReadFrequently: true }); // drawn pixel by pixel
  const image = context.createImageData(canvas.width, canvas.height);
  const pixels = new Uint32Array(image.data.buffer);
  const colour = map.values ? valueColour(map, colours) : () => null;
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const start = (rows - 1 - row) * size * canvas.width + column * size;
      const own = packedColour(nodeColour(map, row, column, colour));
      const kind = marked && map.domain ? markOf(map, row, column) : "";
      const mark = kind ? packedColour(MARKS[kind].colour) : own;
      for (let i = 0; i < size; i++)
        for (let j = 0; j < size; j++) {
          const hatched = kind && (size === 1 || (MARKS[kind].rising ? i + j === size - 1 : i === j));
          pixels[start + i * canvas.width + j] = hatched ? mark : own;
        }
    }
  context.putImageData(image, 0, 0);
  canvas.classList.toggle("fine", canvas.width > canvas.clientWidth * devicePixelRatio);
}

/** A colour as the four bytes of a pixel: every machine that has a browser is little-endian. */
function packedColour([red, green, blue]) {
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
}

function nodeColour(map, row, column, colour) {
  if (!map.domain) return INK.missing;
  const touching = map.domain.at(row, column);
  return colour(map.values && map.values[row * map.columns + column], touching) || (touching ? INK.contact : INK.free);
}

/** Colour of a pressure or a flow, on a logarithmic scale of three decades, or of a gap, on a linear one. */
function valueColour(map, colours) {
  const { largest } = map.states.raw.fields[map.field];
  if (map.field === "gap")
    return (gap, touching) => (touching ? INK.contact : Number.isFinite(gap) ? mixed(colours, gap / largest) : INK.missing);
  return (pressure) =>
    pressure > 0 ? mixed(colours, pressurePart(largest, pressure)) : INK.dark;
}

/** Place of a pressure on the colours, the darkest quarter left out. */
function pressurePart(largest, pressure) {
  return 0.25 + 0.75 * Math.max(0, 1 - Math.log10(largest / pressure) / DECADES_OF_PRESSURE);
}

/** Colour between those of a list, 0 the first and 1 the last. */
function mixed(colours, part) {
  const place = Math.min(1, Math.max(0, part)) * (colours.length - 1);
  const i = Math.min(colours.length - 2, Math.floor(place));
  return colours[i].map((first, k) => first + (place - i) * (colours[i + 1][k] - first));
}

/** Entries below a map: what its colours mean. */
function mapLegend(map, colours) {
  const entries = [];
  const swatch = (colour, words, hatched) => {
    const entry = document.createElement("span");
    const box = document.createElement("i");
    const ink = `rgb(${colour.join(" ")})`;
    box.style.background = hatched ? `repeating-linear-gradient(${hatched}, ${ink} 0 2px, #fff 2px 5px)` : ink;
    entry.append(box, words);
    entries.push(entry);
  };
  if (!map.domain) return entries;
  if (map.values) entries.push(colourBar(map, colours));
  const shown = map.values ? map.field : "contact";
  if (shown === "contact" || shown === "gap") swatch(INK.contact, "in contact");
  if (shown !== "gap") swatch(shown === "contact" ? INK.free : INK.dark, shown === "flow" ? "no flow" : "free");
  for (const [kind, bits] of Object.entries(map.marks)) if (bits) swatch(MARKS[kind].colour, MARKS[kind].words, MARKS[kind].rising ? "135deg" : "45deg");
  return entries;
}

function colourBar(map, colours) {
  const { largest, units } = map.states.raw.fields[map.field];
  const bar = document.createElement("span");
  bar.className = "colours";
  const strip = document.createElement("i");
  const first = map.field === "gap" ? 0 : pressurePart(1, 0);
  const parts = Array.from({ length: 17 }, (_, i) => first + ((1 - first) * i) / 16);
  const stops = parts.map((part) => `rgb(${mixed(colours, part).map(Math.round).join(" ")})`);
  strip.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const least = map.field === "gap" ? "0" : `≤ ${short(largest / 10 ** DECADES_OF_PRESSURE, 2)}`;
  const scale = map.field === "gap" ? "" : ", logarithmic";
  bar.append(least, strip, `${short(largest, 3)} ${units}${scale}`);
  return bar;
}

/** One node in words. */
function nodeWords(map, row, column) {
  const { spacing, first } = map.states.raw.window;
  const x = first[1] + column * map.factor * spacing[1];
  const y = first[0] + row * map.factor * spacing[0];
  const words = [`x = ${short(x)} mm, y = ${short(y)} mm`];
  if (!map.domain) return `${words[0]}: not solved`;
  words.push(map.domain.at(row, column) ? "in contact" : "free");
  const i = row * map.columns + column;
  if (map.pressure && map.pressure[i] > 0) words.push(`p = ${short(map.pressure[i])} MPa`);
  if (map.gap && Number.isFinite(map.gap[i])) words.push(`g = ${short(map.gap[i], 3)} mm`);
  if (map.flow && map.flow[i] > 0) words.push(`flow ${short(map.flow[i], 2)} of its mean`);
  const mark = markOf(map, row, column);
  if (mark) words.push(MARKS[mark].words);
  return words.join(", ");
}

/** The node in contact nearest to the middle; the middle if there is none. */
function contactNearMiddle(map) {
  const middle = { row: map.rows >> 1, column: map.columns >> 1 };
  let [best, least] = [middle, Infinity];
  for (let row = 0; map.domain && row < map.rows; row++)
    for (let column = 0; column < map.columns; column++) {
      const distance = Math.hypot(row - middle.row, column - middle.column);
      if (distance < least && map.domain.at(row, column)) [best, least] = [{ row, column }, distance];
    }
  return best;
}
