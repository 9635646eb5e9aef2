// Curves as SVG. A series is {points: [{x, y, low, high, hollow, kind, go, words}], style, line,
// marker}; its line breaks between points of different kinds.
const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 62, right: 14, top: 10, bottom: 42 };

function svg(name, attributes, parent, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/** Scale of an axis: from numbers to pixels, with its ticks, labelled in units of `per`. */
class Scale {
  constructor(values, { log = false, from, to, zero = false, per = 1 }, start, end) {
    const kept = values.filter((v) => Number.isFinite(v) && (!log || v > 0));
    let low = from ?? Math.min(...kept, zero && !log ? 0 : Infinity);
    let high = to ?? Math.max(...kept, zero && !log ? 0 : -Infinity);
    if (!Number.isFinite(low) || !Number.isFinite(high)) [low, high] = log ? [1, 10] : [0, 1];
    if (log) {
      if (high / low < 1.2) [low, high] = [low / 2, high * 2];
      const room = from === undefined ? (high / low) ** 0.05 : 1;
      [low, high] = [low / room, high * room];
    } else {
      if (high === low) [low, high] = [low - 0.5, high + 0.5];
      const room = 0.05 * (high - low);
      if (from === undefined && low !== 0) low -= room;
      if (to === undefined) high += room;
    }
    Object.assign(this, { log, low, high, start, end, per });
  }
  shows(value) {
    return Number.isFinite(value) && (!this.log || value > 0);
  }
  at(value) {
    const [v, low, high] = this.log
      ? [value, this.low, this.high].map(Math.log)
      : [value, this.low, this.high];
    const place = this.start + ((v - low) / (high - low)) * (this.end - this.start);
    const [least, most] = [Math.min(this.start, this.end), Math.max(this.start, this.end)];
    return Math.min(most + 2000, Math.max(least - 2000, place));
  }
  /** Pairs of a number and its label. */
  ticks(most) {
    return this.log ? this.decades(most) : this.steps(most);
  }
  steps(most) {
    const rough = (this.high - this.low) / most;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= rough) || 10);
    const ticks = [];
    for (let i = Math.ceil(this.low / step); i * step <= this.high * (1 + 1e-12); i++)
      ticks.push([i * step, short(Number(((i * step) / this.per).toPrecision(6)), 5)]);
    return ticks;
  }
  decades(most) {
    const [first, last] = [Math.ceil(Math.log10(this.low)), Math.floor(Math.log10(this.high))];
    const every = Math.max(1, Math.ceil((last - first + 1) / most));
    const ticks = [];
    for (let e = first; e <= last; e++) if ((e - first) % every === 0) ticks.push([10 ** e, decade(e - Math.round(Math.log10(this.per)))]);
    if (ticks.length >= 3) return ticks;
    for (let e = first - 1; e <= last; e++)
      for (const factor of [2, 5]) {
        const value = factor * 10 ** e;
        if (value >= this.low && value <= this.high) ticks.push([value, short(value / this.per, 1)]);
      }
    return ticks.sort((a, b) => a[0] - b[0]);
  }
}

function decade(exponent) {
  return Math.abs(exponent) <= 3 ? short(10 ** exponent, 1) : `10${raised(exponent)}`;
}

/** Draw curves into a figure; a click on a point calls its `go`. */
function drawPlot(figure, { x, y, series, dots, key, empty }) {
  const box = figure.querySelector(".drawing");
  const width = Math.max(260, box.clientWidth);
  const height = Math.round(Math.min(300, Math.max(220, 0.68 * width)));
  const points = series.flatMap((one) => one.points);
  const frame = { right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
  const up = new Scale(points.flatMap((p) => [p.y]), y, frame.bottom, frame.top);
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img" });
  box.replaceChildren(drawing);
  frame.left = leftOf(drawing, up.ticks(ticksAlong(frame.bottom - frame.top)));
  const across = new Scale(points.map((p) => p.x), x, frame.left, frame.right);
  drawing.setAttribute("aria-label", `${figure.querySelector("figcaption").textContent}: ${y.label} over ${x.label}`);
  drawAxes(drawing, frame, across, up, x, y);
  const clip = `clip-${figure.dataset.plot}`;
  const inside = svg("clipPath", { id: clip }, drawing);
  svg("rect", { x: frame.left - 7, y: frame.top - 7, width: frame.right - frame.left + 14, height: frame.bottom - frame.top + 14 }, inside);
  const curves = svg("g", { "clip-path": `url(#${clip})` }, drawing);
  for (const one of series) drawSeries(curves, one, across, up);
  for (const dot of dots) drawDot(drawing, dot, across, up);
  if (empty) svg("text", { x: (frame.left + frame.right) / 2, y: (frame.top + frame.bottom) / 2, class: "empty" }, drawing, empty);
  drawing.addEventListener("click", (event) => choose(event, drawing, points, across, up));
  figure.querySelector(".key").replaceChildren(...key.map(([style, words]) => keyEntry(style, words)));
}

/** Number of ticks along y. */
function ticksAlong(height) {
  return height / 45;
}

/** Place of the axis y: right of its title and of its widest number, in a drawing on the page. */
function leftOf(drawing, ticks) {
  const widths = ticks.map(([, label]) => {
    const text = svg("text", {}, drawing, label);
    const width = text.getComputedTextLength();
    text.remove();
    return width;
  });
  return Math.max(MARGIN.left, 28 + Math.max(0, ...widths));
}

function keyEntry(style, words) {
  const entry = document.createElement("span");
  entry.className = `entry ${style}`;
  entry.textContent = words;
  return entry;
}

function drawAxes(drawing, frame, across, up, x, y) {
  svg("rect", { x: frame.left, y: frame.top, width: frame.right - frame.left, height: frame.bottom - frame.top, class: "frame" }, drawing);
  for (const [value, label] of across.ticks((frame.right - frame.left) / 70)) {
    const place = across.at(value);
    svg("line", { x1: place, x2: place, y1: frame.bottom, y2: frame.top, class: "grid" }, drawing);
    svg("text", { x: place, y: frame.bottom + 16, "text-anchor": "middle" }, drawing, label);
  }
  for (const [value, label] of up.ticks(ticksAlong(frame.bottom - frame.top))) {
    const place = up.at(value);
    svg("line", { x1: frame.left, x2: frame.right, y1: place, y2: place, class: "grid" }, drawing);
    svg("text", { x: frame.left - 6, y: place + 4, "text-anchor": "end" }, drawing, label);
  }
  const middle = [(frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2];
  svg("text", { x: middle[0], y: frame.bottom + 35, "text-anchor": "middle", class: "axis" }, drawing, x.label);
  svg("text", { transform: `translate(13 ${middle[1]}) rotate(-90)`, "text-anchor": "middle", class: "axis" }, drawing, y.label);
}

function drawSeries(parent, { points, style, line = true, marker = "circle", size = 3 }, across, up) {
  const shown = points.filter((p) => across.shows(p.x) && up.shows(p.y));
  if (line && shown.length > 1) {
    const step = (p, i) => (i === 0 || (p.kind ?? "") !== (shown[i - 1].kind ?? "") ? "M" : "L");
    const path = shown.map((p, i) => `${step(p, i)}${across.at(p.x).toFixed(1)} ${up.at(p.y).toFixed(1)}`);
    svg("path", { d: path.join(""), class: `line ${style}` }, parent);
  }
  if (marker === "none") return;
  for (const p of shown) {
    const [px, py] = [across.at(p.x), up.at(p.y)];
    if (up.shows(p.low) && up.shows(p.high))
      svg("line", { x1: px, x2: px, y1: up.at(p.low), y2: up.at(p.high), class: `bar-of ${style}` }, parent);
    const mark = drawMark(parent, marker, px, py, size, `mark ${style}${p.hollow ? " hollow" : ""}`);
    if (p.words) svg("title", {}, mark, p.words);
  }
}

function drawMark(parent, marker, x, y, size, style) {
  if (marker === "square")
    return svg("rect", { x: x - size, y: y - size, width: 2 * size, height: 2 * size, class: style }, parent);
  if (marker === "cross")
    return svg("path", { d: `M${x - size} ${y - size}l${2 * size} ${2 * size}m0 ${-2 * size}l${-2 * size} ${2 * size}`, class: style }, parent);
  if (marker === "triangle")
    return svg("path", { d: `M${x} ${y - 1.2 * size}l${1.1 * size} ${2 * size}h${-2.2 * size}Z`, class: style }, parent);
  if (marker === "diamond")
    return svg("path", { d: `M${x} ${y - size}L${x + size} ${y}L${x} ${y + size}L${x - size} ${y}Z`, class: style }, parent);
  return svg("circle", { cx: x, cy: y, r: size, class: style }, parent);
}

/** The state itself on its curve: a circle for A, a diamond for B. */
function drawDot(drawing, { x, y, who }, across, up) {
  if (!across.shows(x) || !up.shows(y)) return;
  const mark = drawMark(drawing, who === "b" ? "diamond" : "circle", across.at(x), up.at(y), who === "b" ? 9 : 6, `dot ${who}`);
  mark.setAttribute("data-x", x);
  mark.setAttribute("data-y", y);
}

function choose(event, drawing, points, across, up) {
  const box = drawing.getBoundingClientRect();
  const [px, py] = [event.clientX - box.left, event.clientY - box.top];
  let best = null;
  let least = 28;
  for (const p of points) {
    if (!p.go || !across.shows(p.x) || !up.shows(p.y)) continue;
    const distance = Math.hypot(across.at(p.x) - px, up.at(p.y) - py);
    if (distance < least) [best, least] = [p, distance];
  }
  if (best) best.go();
}
