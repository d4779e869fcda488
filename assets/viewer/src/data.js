// Reads the data of the page: a description in JSON and packed columns (see pack.rs for the code).

/** Returns the description, with every column as numbers and every surface as arrays. */
export async function readData(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  const all = await new Response(stream).arrayBuffer();
  const length = new DataView(all).getUint32(0, true);
  const data = JSON.parse(new TextDecoder().decode(new Uint8Array(all, 4, length)));
  const [packed, floats, indices] = data.geometry;
  const start = aligned(4 + length);
  const numbers = new Uint8Array(all, start, packed);
  const floatStart = start + aligned(packed);
  data.floats = new Float32Array(all.slice(floatStart, floatStart + 4 * floats));
  const indexStart = floatStart + 4 * floats;
  data.indices = new Uint32Array(all.slice(indexStart, indexStart + 4 * indices));
  for (const run of data.runs) {
    const columns = new Map();
    const column = (k) => {
      if (!columns.has(k)) columns.set(k, unpacked(numbers, data.columns[k], run.rows));
      return columns.get(k);
    };
    run.times = column(run.time);
    run.tracks = run.poses.map((pose) => pose && pose.map(column));
    run.value = (channel) => column(run.channels[channel].column);
    // of the first run alone
    if (run === data.runs[0]) for (const overlap of data.overlaps) overlap.place = overlap.place.map(column);
  }
  return data;
}

const aligned = (n) => Math.ceil(n / 4) * 4;

/** Returns the numbers of a packed column; NaN where there are gaps. */
function unpacked(bytes, [offset, quantum, order, gaps], rows) {
  const values = new Float64Array(rows);
  let at = offset;
  let before = 0;
  let slope = 0;
  for (let k = 0; k < rows; k++) {
    let folded = 0;
    let factor = 1;
    let byte;
    do {
      byte = bytes[at++];
      folded += (byte & 127) * factor;
      factor *= 128;
    } while (byte > 127);
    const half = Math.floor(folded / 2);
    const now = before + slope + (folded % 2 === 0 ? half : -half - 1);
    if (order === 2) slope = now - before;
    before = now;
    values[k] = now * quantum;
  }
  for (const [from, to] of gaps ?? []) values.fill(NaN, from, to);
  return values;
}

/** Returns the last row whose time is not after `t`. */
export function rowAt(times, t) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Returns whether an element is switched off at a row of the first run. */
export function isOff(element, row) {
  return Boolean(element.off?.some(([from, to]) => row >= from && row < to));
}

/** Writes a number with six digits, without noise. */
export function digits(x) {
  if (x === undefined || x === null || Number.isNaN(x)) return '–';
  if (x === 0) return '0';
  const text = Number(x.toPrecision(6));
  const size = Math.abs(text);
  return size < 1e-4 || size >= 1e7 ? text.toExponential().replace('e+', 'e') : String(text);
}
