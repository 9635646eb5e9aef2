// The five plots of the page: what they draw of the states A and B.
const range = (n) => Array.from({ length: n }, (_, i) => i);

function showCurves() {
  const log = byId("logarithmic").checked;
  for (const figure of document.querySelectorAll(".plot")) drawPlot(figure, PLOTS[figure.dataset.plot](log));
}

/** Points of solved states along a dimension; a click on one goes to it. */
function pointsAlong(who, dimension, place, point) {
  const { states } = state[who];
  return range(states.count(dimension))
    .map((i) => ({ ...place, [dimension]: i }))
    .filter((other) => states.solved(other))
    .map((other) => ({ ...point(states, other), go: () => move(who, other) }));
}

/** Grey curves of the other offsets of A, then those of A and B. */
function overLoads(point, background = true) {
  const series = [];
  const { states, place } = state.a;
  if (background)
    for (const i of range(states.count("offset")))
      series.push({ points: pointsAlong("a", "normal_force", { ...place, offset: i }, point), style: "other", marker: "none" });
  for (const who of shownStates())
    series.push({ points: pointsAlong(who, "normal_force", state[who].place, point), style: who });
  return series;
}

/** The states themselves, B below A where they meet. */
function dotsOf(point) {
  return shownStates()
    .reverse()
    .filter((who) => state[who].states.solved(state[who].place))
    .map((who) => ({ ...point(state[who].states, state[who].place), who }));
}

/** Axis of the force in the unit that suits the largest one. */
function forceAxis(more) {
  const largest = Math.max(...shownStates().flatMap((who) => state[who].states.raw.normal_force));
  const [unit, per] = forceUnit(largest);
  return { label: `normal force F (${unit})`, per, ...more };
}

const forceOf = (states, place) => states.raw.normal_force[place.normal_force];
const unsolved = () => (state.a.states.solved(state.a.place) ? "" : "state A was not solved");
const keyOfStates = () => shownStates().map((who) => [who, `${NAMES[who]}: ${state[who].states.name}`]);

function closurePoint(states, place) {
  const [x, y] = [states.at("closure/closure", place), forceOf(states, place)];
  return { x, y, hollow: states.at("closure/resolved", place) !== 1, words: `w = ${short(x)} mm under ${forceWords(y)}` };
}

/** Corrected area where enough nodes touch, else the raw one, hollow. */
function areaPoint(states, place) {
  const corrected = states.at("closure/area_corrected_resolved", place) === 1;
  const y = states.at(corrected ? "closure/area_corrected" : "closure/area", place);
  const x = forceOf(states, place);
  return { x, y, hollow: !corrected, kind: corrected, words: `A = ${short(y)} mm² under ${forceWords(x)}${corrected ? "" : ", raw"}` };
}

/** Delta_sigma by boxes or by areas; hollow and without its interval where that says nothing. */
function dimensionPoint(key) {
  return (states, place) => {
    const [y, low, high] = ["", "_low", "_high"].map((end) => states.at(key + end, place));
    const x = forceOf(states, place);
    const determined = !states.undetermined(key, place);
    const value = `${short(y, 3)} [${short(low, 3)}, ${short(high, 3)}]`;
    const words = `Δσ = ${determined ? value : `undetermined (${value})`} under ${forceWords(x)}`;
    return { x, y, low: determined ? low : NaN, high: determined ? high : NaN, hollow: !determined, words };
  };
}

function dimensionSeries() {
  return shownStates().flatMap((who) =>
    [["domains/delta_sigma", who, "circle"], ["scaling/delta_sigma_area", `${who} dashed`, "square"]].map(([key, style, marker]) => ({
      points: pointsAlong(who, "normal_force", state[who].place, dimensionPoint(key)),
      style,
      marker,
    }))
  );
}

function elasticPoint(states, place) {
  const [x, y] = [states.at("closure/offset_on_grid", place), states.at("dilatancy/elastic_dilatancy", place)];
  return { x, y, words: `δ = ${short(y)} mm at v = ${short(x)} mm under ${forceWords(forceOf(states, place))}` };
}

function rigidSeries(who) {
  const { states, place } = state[who];
  const direction = states.raw.rigid_direction.indexOf(states.raw.direction[place.direction]);
  const heights = direction < 0 ? [] : states.along("dilatancy/rigid_dilatancy", "rigid_offset", { rigid_direction: direction });
  return heights.map((y, i) => ({ x: states.raw.rigid_offset[i], y }));
}

function boxSeries(who) {
  const { states, place } = state[who];
  if (!states.solved(place)) return [];
  const line = (side, count, scale, more = () => ({})) => {
    const sizes = states.along(side, scale, place);
    const counts = states.along(count, scale, place);
    return sizes.map((x, i) => ({ x, y: counts[i], words: `N = ${short(counts[i])} boxes of ${short(x)} mm`, ...more(i) }));
  };
  const used = states.along("domains/ordinary_used", "scale", place);
  const cover = line("domains/box_side", "domains/box_count", "scale", (i) => ({ hollow: used[i] !== 1 }));
  return [
    { points: line("domains/mean_side", "law_count", "mean_scale"), style: `${who} law`, marker: "none" },
    { points: line("domains/mean_side", "domains/mean_count", "mean_scale"), style: who, line: false, marker: "cross", size: 3 },
    { points: cover, style: who, line: false },
  ];
}

const PLOTS = {
  closure: (log) => ({
    x: { label: "closure w (mm)", log, zero: true },
    y: forceAxis({ log, zero: true }),
    series: overLoads(closurePoint),
    dots: dotsOf(closurePoint),
    key: [...keyOfStates(), ["other", "other offsets of A"], ["hollow", "fewer than 10 nodes touch"]],
    empty: unsolved(),
  }),
  area: (log) => ({
    x: forceAxis({ log, zero: true }),
    y: { label: "real contact area Aᵣ (mm²)", log, zero: true },
    series: overLoads(areaPoint),
    dots: dotsOf(areaPoint),
    key: [...keyOfStates(), ["other", "other offsets of A"], ["hollow", "raw, fewer than 30 nodes touch"]],
    empty: unsolved(),
  }),
  dimension: () => ({
    x: forceAxis({ log: true }),
    y: { label: "Δσ of the contact domain (1)", from: 0, to: 2 },
    series: dimensionSeries(),
    dots: dotsOf(dimensionPoint("domains/delta_sigma")),
    key: [...keyOfStates(), ["plain circle", "box counting"], ["plain square", "area over spacings"], ["hollow", "undetermined"]],
    empty: unsolved() || (dimensionSeries().some(({ points }) => points.some(({ y }) => Number.isFinite(y))) ? "" : "no Δσ under any load"),
  }),
  dilatancy: () => {
    const { place } = state.a;
    const sliding = shownStates().filter((who) => rigidSeries(who).length > 1);
    const loads = sliding.includes("a") ? range(state.a.states.count("normal_force")) : [];
    return {
      x: { label: "offset v (mm)", zero: true },
      y: { label: "dilatancy δ (mm)", zero: true },
      series: [
        ...loads.map((i) => ({ points: pointsAlong("a", "offset", { ...place, normal_force: i }, elasticPoint), style: "other", marker: "none" })),
        ...sliding.flatMap((who) => [
          { points: rigidSeries(who), style: `${who} dashed`, marker: "none" },
          { points: pointsAlong(who, "offset", state[who].place, elasticPoint), style: who },
        ]),
      ],
      dots: dotsOf(elasticPoint).filter(({ who }) => sliding.includes(who)),
      key: [...keyOfStates(), ["plain dashed", "rigid"], ["plain solid", "elastic under the load"], ["other", "other loads of A"]],
      empty: sliding.includes("a") ? unsolved() : sliding.length ? "" : "the surface does not slide",
    };
  },
  boxes: () => ({
    x: { label: "box side r (mm)", log: true },
    y: { label: "occupied boxes N(r) (1)", log: true },
    series: shownStates().flatMap(boxSeries),
    dots: [],
    key: [...keyOfStates(), ["plain circle", "minimal cover"], ["plain cross", "mean over origins"], ["plain solid", "count law fitted"], ["hollow", "not in the ordinary slope"]],
    empty: unsolved(),
  }),
};
