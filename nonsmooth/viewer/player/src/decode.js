// The words and arrays of the run that stand in the page.

const FORMAT = "nonsmooth-view/1";
const TYPES = { f8: Float64Array, f4: Float32Array, i4: Int32Array, i2: Int16Array, u1: Uint8Array };

/** Puts the bytes of each number side by side again. */
function unshuffled(block, size) {
  const n = block.length / size;
  const out = new Uint8Array(block.length);
  for (let j = 0; j < size; j++) for (let i = 0; i < n; i++) out[i * size + j] = block[j * n + i];
  return out;
}

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Returns {told, arrays}; throws an Error that says in words what is wrong. */
export async function read() {
  const told = JSON.parse(document.getElementById("told").textContent);
  if (told.format !== FORMAT)
    throw new Error(`This page holds a run of format "${told.format}"; its player reads "${FORMAT}". Write it again.`);
  let bytes;
  try {
    bytes = await unpacked(document.getElementById("arrays").textContent);
  } catch {
    throw new Error("This file is cut short: what it says of the run cannot be unpacked. Copy or write it again.");
  }
  const arrays = {};
  for (const { name, type, at, bytes: size } of told.directory) {
    if (at + size > bytes.length) throw new Error("This file is cut short. Copy or write it again.");
    const Kind = TYPES[type];
    arrays[name] = new Kind(unshuffled(bytes.subarray(at, at + size), Kind.BYTES_PER_ELEMENT).buffer);
  }
  return { told, arrays };
}

/** Returns the number of the last entry of a rising array that is not above a value; -1 if all are. */
export function last(array, value) {
  let low = 0;
  let high = array.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (array[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
