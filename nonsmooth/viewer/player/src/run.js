// The run as the player asks for it: poses, modes, energies and events at a time.

import { last } from "./decode.js";

export const [OPEN, STICK, SLIDE] = [0, 1, 2];
const CODES = { 1: STICK, 5: SLIDE };

export class Run {
  constructor({ told, arrays }) {
    Object.assign(this, arrays);
    this.told = told;
    this.t0 = this.time[0];
    this.t1 = this.time[this.time.length - 1];
    this.nFrames = this.origin.length / (3 * this.time.length);
    this.nEvents = this.event_time.length;
    this.strength = this._strengths();
    this.lanes = this._lanes();
  }

  /** Of each event the largest impulse of its contacts [N s]. */
  _strengths() {
    const found = new Float64Array(this.nEvents);
    for (let e = 0; e < this.nEvents; e++)
      for (let i = this.event_first[e]; i < this.event_first[e + 1]; i++) found[e] = Math.max(found[e], this.impulse(i));
    return found;
  }

  /** Size of the impulse of an entry [N s]. */
  impulse(i) {
    const [p, r] = [this.event_push, this.event_rub];
    return Math.hypot(p[3 * i] + r[3 * i], p[3 * i + 1] + r[3 * i + 1], p[3 * i + 2] + r[3 * i + 2]);
  }

  /** Of each contact that ever closes its spells: [from, to, mode]. */
  _lanes() {
    const lanes = new Map();
    let open = new Map();
    const end = (contact, t) => {
      const [from, mode] = open.get(contact);
      if (t > from) {
        if (!lanes.has(contact)) lanes.set(contact, []);
        lanes.get(contact).push([from, t, mode]);
      }
    };
    for (let e = 0; e < this.nEvents; e++) {
      const t = this.event_time[e];
      const now = new Map();
      for (let i = this.event_first[e]; i < this.event_first[e + 1]; i++) {
        const mode = CODES[(this.event_codes[i] >> 6) & 7] ?? OPEN;
        if (mode !== OPEN) now.set(this.event_contact[i], mode);
      }
      for (const [contact, [, mode]] of open) if (now.get(contact) !== mode) end(contact, t);
      const next = new Map();
      for (const [contact, mode] of now) {
        const before = open.get(contact);
        next.set(contact, before && before[1] === mode ? before : [t, mode]);
      }
      open = next;
    }
    for (const contact of open.keys()) end(contact, this.t1);
    return lanes;
  }

  /** Knot at or before a time, and the part of the way to the next one. */
  knot(t) {
    const k = Math.min(Math.max(last(this.time, t), 0), this.time.length - 1);
    if (k === this.time.length - 1) return [k, 0];
    return [k, (t - this.time[k]) / (this.time[k + 1] - this.time[k])];
  }

  /** Writes place and turn of a frame. */
  place(frame, [k, part], position, quaternion) {
    const at = (i) => i * this.nFrames + frame;
    const [a, b] = [at(k), at(part > 0 ? k + 1 : k)];
    position.fromArray(this.origin, 3 * a);
    const q = this.turn;
    let sign = 0;
    for (let i = 0; i < 4; i++) sign += q[4 * a + i] * q[4 * b + i];
    sign = sign < 0 ? -1 : 1;
    const mix = (i) => (1 - part) * q[4 * a + i] + sign * part * q[4 * b + i];
    quaternion.set(mix(0), mix(1), mix(2), mix(3)).normalize();
    if (part === 0) return;
    const o = this.origin;
    for (let i = 0; i < 3; i++) position.setComponent(i, (1 - part) * o[3 * a + i] + part * o[3 * b + i]);
  }

  /** Number of the last event at or before a time; -1 before the first. */
  event(t) {
    return last(this.event_time, t);
  }

  words(e) {
    const names = ["before", "during", "after"];
    return Object.fromEntries(names.map((name, i) => [name, this.told.words[this.event_words[3 * e + i]]]));
  }

  /** What an event is called. */
  title(e) {
    const cause = this.told.causes[this.event_cause[e]];
    const by = this.event_trigger[e];
    if (by < 0) return cause;
    const of = cause === "guard of the scenario" ? this.told.guards[by] : this.told.contacts[by].name;
    return `${cause}: ${of}`;
  }

  /** Kinetic, potential, losses and work [J] at a time. */
  energies(t) {
    const [k, part] = this.knot(t);
    const next = this.energyInto(k + 1);
    return [0, 1, 2, 3, 4].map((i) => (part > 0 ? (1 - part) * this.energy[5 * k + i] + part * next[i] : this.energy[5 * k + i]));
  }

  /** The account just before the events of a knot. */
  energyInto(k) {
    const i = last(this.instant_knot, k);
    const [from, at] = i >= 0 && this.instant_knot[i] === k ? [this.energy_before, i] : [this.energy, k];
    return from.subarray(5 * at, 5 * at + 5);
  }
}
