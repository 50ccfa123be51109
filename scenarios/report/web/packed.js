// ---- numbers packed as text by assets.hpp
const NONE = 0xffffffff;

/** Returns a Float32Array, or a Uint32Array in which NONE stands for kNull. */
function unpack(text) {
  const raw = atob(text.slice(3)),
    size = Number(text[1]),
    count = raw.length / size;
  if (text[0] === "f") {
    const bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    const view = new DataView(bytes.buffer),
      out = new Float32Array(count);
    for (let i = 0; i < count; i++) out[i] = view.getFloat32(4 * i, true);
    return out;
  }
  const out = new Uint32Array(count),
    none = size === 4 ? NONE : 256 ** size - 1;
  for (let i = 0; i < count; i++) {
    let n = 0;
    for (let k = size; k-- > 0;) n = n * 256 + raw.charCodeAt(i * size + k);
    out[i] = n === none ? NONE : n;
  }
  return out;
}

/** Returns the largest index whose value is at most `value`, of ascending ones; -1: none. */
function lastAtMost(ascending, value) {
  let low = 0,
    high = ascending.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ascending[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
