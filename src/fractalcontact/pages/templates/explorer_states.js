"use strict";
// Contact states of a specimen, unpacked: the atlas's numbers, contact domains and fields.

/** Bytes of a text that pages/packed_states.py packed. */
async function inflated(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Numbers of `size` bytes each, whose first bytes stand before all second ones. */
function joined(planes, size) {
  const count = planes.length / size;
  const bytes = new Uint8Array(planes.length);
  for (let k = 0; k < size; k++)
    for (let i = 0; i < count; i++) bytes[i * size + k] = planes[k * count + i];
  return bytes.buffer;
}

/** Truth values of a grid, kept as bits: rows are filled up to whole bytes. */
class Bits {
  constructor(bytes, [rows, columns], layer = 0) {
    this.width = Math.ceil(columns / 8);
    this.bytes = bytes;
    this.start = layer * rows * this.width;
  }
  at(row, column) {
    const byte = this.bytes[this.start + row * this.width + (column >> 3)];
    return (byte >> (7 - (column & 7))) & 1;
  }
}

/** All states of one specimen. A place is {direction, offset, resolution, normal_force}: indices. */
class States {
  constructor(name, label, raw) {
    Object.assign(this, { name, label, raw });
    this.cache = new Map();
  }
  /** Unpack the numbers; everything but maps may be asked for then. */
  async load() {
    this.numbers = new Float64Array(joined(await inflated(this.raw.numbers), 8));
    return this;
  }
  /** Length of a dimension. */
  count(dimension) {
    return this.raw[dimension].length;
  }
  /** Number of an array of the atlas at a place, NaN if there is none. */
  at(key, place) {
    const entry = this.raw.arrays[key];
    if (!entry) return NaN;
    let index = 0;
    entry.dims.forEach((dimension, i) => {
      index = index * entry.shape[i] + place[dimension];
    });
    return this.numbers[entry.start + index];
  }
  /** Numbers of an array along one dimension. */
  along(key, dimension, place) {
    const entry = this.raw.arrays[key];
    const n = entry ? entry.shape[entry.dims.indexOf(dimension)] : 0;
    return Array.from({ length: n }, (_, i) => this.at(key, { ...place, [dimension]: i }));
  }
  solved(place) {
    return this.at("closure/solved", place) === 1;
  }
  /** Why a number of a solved state is missing, in the words of the result page. */
  reason(key, place) {
    const reasons = this.raw.reasons[key];
    if (!reasons) return "";
    const entry = this.raw.arrays[key];
    const index = entry.dims.reduce((sum, dimension, i) => sum * entry.shape[i] + place[dimension], 0);
    return reasons.words[reasons.places[index]];
  }
  /** Whether a number of a state at a coarser spacing is that of the finest: dilatancy has no other. */
  ofFinest(key, place) {
    const { stage } = this.raw.arrays[key];
    return stage === "dilatancy" && this.raw.resolution[place.resolution] !== Math.min(...this.raw.resolution);
  }
  /** Error of all sources, where the error budget has one. */
  total(key, place) {
    const where = this.raw.totals;
    const here =
      where &&
      this.raw.direction[place.direction] === where.direction &&
      this.raw.offset[place.offset] === where.offset &&
      this.raw.resolution[place.resolution] === where.resolution;
    return here ? this.at(`total/${key}`, place) : NaN;
  }
  /** Whether the result page calls a number undetermined: "interval" or "scan" decides, "" if not. */
  undetermined(key, place) {
    if (this.at(`undetermined/${key}`, place) === 1) return "interval";
    const says = (rows, mask) => this.raw[rows].includes(key) && this.at(`undetermined/${mask}`, place) === 1;
    if (says("of_joint", "by_scan") || says("of_touch", "at_touch")) return "scan";
    return this.total(key, place) > this.raw.most[key] * Math.abs(this.at(key, place)) ? "interval" : "";
  }
  /** What `make` gives, made once. */
  async once(key, make) {
    if (!this.cache.has(key)) this.cache.set(key, make());
    return this.cache.get(key);
  }
  /** Contact domain as Bits, null if the state was not solved. */
  async domain(place) {
    const { shape, bits } = this.raw.domains[this.raw.resolution[place.resolution]];
    const text = bits[place.direction][place.offset];
    if (!text || !this.solved(place)) return null;
    const key = `domain ${place.direction} ${place.offset} ${place.resolution}`;
    return new Bits(await this.once(key, () => inflated(text)), shape, place.normal_force);
  }
  /** Marked nodes as Bits at the finest spacing: "overlap" or "suspect"; null if there are none. */
  async marks(kind, place) {
    const text = this.raw.marks && this.raw.marks[kind][place.direction][place.offset];
    if (!text) return null;
    const key = `${kind} ${place.direction} ${place.offset}`;
    return new Bits(await this.once(key, () => inflated(text)), this.raw.window.shape);
  }
  /** Whether pressure, gap or flow ("field") is stored at a place. */
  stores(field, place) {
    const fields = this.raw.fields;
    return Boolean(
      fields &&
        fields.direction === this.raw.direction[place.direction] &&
        fields.offset === this.raw.offset[place.offset] &&
        fields.resolution === this.raw.resolution[place.resolution] &&
        fields[field].loads.includes(place.normal_force)
    );
  }
  /** Pressure (MPa), gap (mm) or flow over its mean of every node, NaN where missing. */
  async field(field, place) {
    const stored = this.raw.fields[field];
    const i = stored.loads.indexOf(place.normal_force);
    return this.once(`${field} ${i}`, async () => {
      const bytes = await inflated(stored.data[i]);
      if (field !== "gap") return new Float32Array(joined(bytes, 4));
      return this.gaps(new Uint16Array(joined(bytes, 2)), stored);
    });
  }
  gaps(changes, stored) {
    const columns = this.raw.domains[this.raw.fields.resolution].shape[1];
    const gaps = new Float64Array(changes.length);
    let steps = 0;
    for (let i = 0; i < changes.length; i++) {
      steps = (i % columns ? steps + changes[i] : changes[i]) & 0xffff;
      gaps[i] = steps === stored.missing ? NaN : steps * stored.step;
    }
    return gaps;
  }
  /** Indices of the place of the maps with their load, or of the first state that was solved. */
  home() {
    const { fields, direction, offset, resolution, normal_force: force } = this.raw;
    const place = { direction: 0, offset: 0, resolution: 0, normal_force: force.length - 1 };
    if (!fields) return this.nearestSolved(place);
    return {
      direction: Math.max(0, direction.indexOf(fields.direction)),
      offset: nearest(offset, fields.offset),
      resolution: Math.max(0, resolution.indexOf(fields.resolution)),
      normal_force: nearest(force, fields.normal_force),
    };
  }
  /** The solved state that is fewest steps of the controls away; the place itself if none is. */
  nearestSolved(place) {
    let best = place;
    let least = Infinity;
    for (let d = 0; d < this.count("direction"); d++)
      for (let o = 0; o < this.count("offset"); o++)
        for (let r = 0; r < this.count("resolution"); r++)
          for (let f = 0; f < this.count("normal_force"); f++) {
            const other = { direction: d, offset: o, resolution: r, normal_force: f };
            const steps =
              Math.abs(f - place.normal_force) +
              Math.abs(o - place.offset) +
              20 * Math.abs(r - place.resolution) +
              20 * (d !== place.direction);
            if (steps < least && this.solved(other)) [best, least] = [other, steps];
          }
    return best;
  }
}

/** Index of the number nearest to a value. */
function nearest(numbers, value) {
  let best = 0;
  numbers.forEach((number, i) => {
    if (Math.abs(number - value) < Math.abs(numbers[best] - value)) best = i;
  });
  return best;
}
