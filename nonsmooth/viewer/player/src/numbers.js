// How numbers and words are spelled.

export const DIGITS = 9; // of times: more than tolerances mean
const GOOD = 6; // digits of the largest energy: states between samples are good for 1e-7 of it, and what is less is round-off
const PREFIXES = { 3: "kJ", 0: "J", "-3": "mJ", "-6": "µJ", "-9": "nJ" };

/** How many decimals show so many digits of the largest number. */
export function decimals(largest, digits) {
  const before = largest > 0 ? Math.floor(Math.log10(largest)) + 1 : 1;
  return Math.min(Math.max(digits - before, 0), 20);
}

/** The largest magnitude of some numbers. */
export function largest(values) {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}

/** The unit of energies, and what spells one [J] in it: all with the same decimals. */
export function energyScale(energies) {
  const most = largest(energies);
  const power = Math.min(Math.max(3 * Math.floor(Math.log10(most || 1) / 3), -9), 3);
  const places = decimals(most / 10 ** power, GOOD);
  // without the sign of a negative zero
  const spell = (energy) => (energy / 10 ** power).toFixed(places).replace(/^-(?=[0.]*$)/, "");
  return [PREFIXES[power], spell];
}

export function spoken(speed) {
  return speed === 1 ? "real time" : `${Math.round(1 / speed)} × slower`;
}

/** Puts a text that may be broken between words and after commas, as modes are. */
export function breakable(element, text) {
  if (element.textContent === text) return;
  element.replaceChildren(...text.split(/(?<=,)/).flatMap((part) => [part, document.createElement("wbr")]));
}
