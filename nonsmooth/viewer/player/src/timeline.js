// Two strips that steer the time: the whole run, and a part of it with contacts and energies.

import { COLOURS } from "./world.js";
import { last } from "./decode.js";
import { largest } from "./numbers.js";
import { SLIDE } from "./run.js";

const MOST_LANES = 6;
const MARGIN = 128; // room for names [px]
const TAIL = 8; // letters of a name that are kept where it is too long
const LEAST_SPAN = 1e-4; // height of the plot, relative to the largest energy: round-off, 1e-7 of that energy, is a flat line
const ENERGIES = [
  ["kinetic", "#1b9e77", []],
  ["potential", "#8f8ad0", [5, 3]],
  ["sum", "#a6761d", [2, 3]],
];

export class Timeline {
  constructor(canvas, run, look) {
    Object.assign(this, { canvas, run, look });
    this.from = run.t0;
    this.to = run.t1;
    const busy = [...run.lanes.entries()].sort((a, b) => b[1].length - a[1].length || a[0] - b[0]);
    this.lanes = busy.slice(0, MOST_LANES).sort((a, b) => a[0] - b[0]);
    this.rest = busy.slice(MOST_LANES);
    this.strongest = Math.max(...run.strength, 1e-300);
    this._energies();
    const lanes = this.lanes.length + (this.rest.length > 0);
    canvas.style.height = `${56 + 14 * lanes + 100}px`;
    canvas.addEventListener("pointerdown", (event) => this._drag(event));
    canvas.addEventListener("wheel", (event) => this._zoom(event), { passive: false });
  }

  _energies() {
    const { run } = this;
    const at = (k) => this._levels(run.energy.subarray(5 * k, 5 * k + 5));
    const rows = [];
    for (let k = 0; k < run.time.length; k++) {
      const into = run.energyInto(k);
      if (into.buffer !== run.energy.buffer) rows.push([run.time[k], this._levels(into)]);
      rows.push([run.time[k], at(k)]);
    }
    this.energies = rows;
    const lowest = Math.min(...rows.map(([, levels]) => levels[1]));
    // heights count from the lowest potential energy, as only differences mean something
    rows.forEach(([, levels]) => [1, 2].forEach((i) => (levels[i] -= lowest)));
    const exchanged = rows.reduce((most, [, levels]) => Math.max(most, ...levels), 0);
    this.top = Math.max(exchanged, LEAST_SPAN * largest(run.energy)) || 1;
  }

  _levels(energy) {
    return [energy[0], energy[1], energy[0] + energy[1]];
  }

  _drag(event) {
    const { canvas } = this;
    canvas.setPointerCapture(event.pointerId);
    const whole = event.offsetY < this.split;
    const seek = (e) => {
      const part = Math.min(Math.max((e.offsetX - MARGIN) / (canvas.clientWidth - MARGIN - 8), 0), 1);
      const [a, b] = whole ? [this.run.t0, this.run.t1] : [this.from, this.to];
      this.look(a + part * (b - a));
    };
    const stop = () => {
      canvas.removeEventListener("pointermove", seek);
      canvas.removeEventListener("pointerup", stop);
    };
    canvas.addEventListener("pointermove", seek);
    canvas.addEventListener("pointerup", stop);
    seek(event);
  }

  _zoom(event) {
    event.preventDefault();
    const part = Math.min(Math.max((event.offsetX - MARGIN) / (this.canvas.clientWidth - MARGIN - 8), 0), 1);
    this.zoom(Math.exp(0.0015 * event.deltaY), this.from + part * (this.to - this.from));
  }

  zoom(factor, about) {
    const { t0, t1 } = this.run;
    const width = Math.min(Math.max((this.to - this.from) * factor, 1e-6 * (t1 - t0)), t1 - t0);
    const part = (about - this.from) / (this.to - this.from);
    this.from = Math.min(Math.max(about - part * width, t0), t1 - width);
    this.to = this.from + width;
  }

  /** Keeps a time within the zoomed part. */
  keep(t) {
    const width = this.to - this.from;
    if (t >= this.from && t <= this.to) return;
    this.from = Math.min(Math.max(t - 0.1 * width, this.run.t0), this.run.t1 - width);
    this.to = this.from + width;
  }

  draw(t, event) {
    const { canvas, run } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    const style = getComputedStyle(document.documentElement);
    this.ink = style.getPropertyValue("--ink");
    this.faint = style.getPropertyValue("--faint");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    const x = (a, b) => (time) => MARGIN + ((time - a) / (b - a || 1)) * (width - MARGIN - 8);
    const whole = x(run.t0, run.t1);
    const part = x(this.from, this.to);
    this.split = 26;
    this._ticks(pen, whole, 4, 18, run.t0, run.t1);
    this._name(pen, "whole run", 13);
    pen.strokeStyle = this.ink;
    pen.strokeRect(whole(this.from), 3.5, Math.max(whole(this.to) - whole(this.from), 2), 19);
    this._ticks(pen, part, 32, 20, this.from, this.to);
    this._name(pen, "events", 42);
    let y = 56;
    for (const [contact, spells] of this.lanes) {
      this._name(pen, run.told.contacts[contact].name, y + 6);
      this._lane(pen, part, spells, y, 11);
      y += 14;
    }
    if (this.rest.length > 0) {
      this._name(pen, `${this.rest.length} more`, y + 6);
      this.rest.forEach(([, spells]) => this._lane(pen, part, spells, y, 11));
      y += 14;
    }
    this._plot(pen, part, y + 6, height - 22);
    this._axis(pen, part, height - 16);
    pen.strokeStyle = pen.fillStyle = COLOURS.impulse;
    pen.lineWidth = 1.5;
    for (const [at, top, bottom] of [[whole(t), 2, 24], [part(t), 28, height - 18]]) {
      if (at < MARGIN - 1 || at > width - 7) continue;
      pen.beginPath();
      pen.moveTo(at, top);
      pen.lineTo(at, bottom);
      pen.stroke();
    }
    pen.lineWidth = 1;
  }

  _name(pen, name, y) {
    pen.fillStyle = this.ink;
    pen.textAlign = "right";
    // what contacts of a kind differ by stands at the end
    let text = name;
    for (let left = name.length - TAIL - 1; left > 1 && pen.measureText(text).width > MARGIN - 10; left--)
      text = `${name.slice(0, left)}…${name.slice(-TAIL)}`;
    pen.fillText(text, MARGIN - 6, y);
  }

  /** Events as ticks, the stronger the higher; one a pixel. */
  _ticks(pen, x, top, height, from, to) {
    const { run } = this;
    pen.fillStyle = this.faint;
    pen.fillRect(x(from), top + height, x(to) - x(from), 1);
    const highest = new Map();
    for (let e = Math.max(last(run.event_time, from - 1e-300), 0); e < run.nEvents && run.event_time[e] <= to; e++) {
      if (run.event_time[e] < from) continue;
      const at = Math.round(x(run.event_time[e]));
      highest.set(at, Math.max(highest.get(at) ?? 0, run.strength[e] / this.strongest));
    }
    for (const [at, strength] of highest) {
      pen.fillStyle = strength > 0 ? COLOURS.impulse : this.ink;
      const size = 3 + (height - 3) * strength;
      pen.fillRect(at, top + height - size, 1, size);
    }
  }

  _lane(pen, x, spells, y, height) {
    for (const [from, to, mode] of spells) {
      if (to < this.from || from > this.to) continue;
      const [a, b] = [x(Math.max(from, this.from)), x(Math.min(to, this.to))];
      const size = Math.max(b - a, 1);
      pen.fillStyle = mode === SLIDE ? COLOURS.slip : COLOURS.stick;
      pen.fillRect(a, y, size, height);
      if (mode === SLIDE) continue;
      // hatched, so that it is told without colours
      pen.save();
      pen.beginPath();
      pen.rect(a, y, size, height);
      pen.clip();
      pen.strokeStyle = "#ffffff99";
      pen.beginPath();
      for (let h = a - (a % 6) - height; h < b; h += 6) pen.moveTo(h, y + height) || pen.lineTo(h + height, y);
      pen.stroke();
      pen.restore();
    }
  }

  _plot(pen, x, top, bottom) {
    const height = (level) => bottom - (level / this.top) * (bottom - top);
    const rows = this.energies;
    const first = Math.max(rows.findIndex(([time]) => time >= this.from) - 1, 0);
    const step = Math.max(1, Math.floor(rows.filter(([time]) => time >= this.from && time <= this.to).length / 3000));
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN, top - 2, x(this.to) - MARGIN + 1, bottom - top + 4);
    pen.clip();
    ENERGIES.forEach(([, colour, dash], i) => {
      pen.strokeStyle = colour;
      pen.setLineDash(dash);
      pen.beginPath();
      for (let k = first; k < rows.length; k += step) {
        pen.lineTo(x(rows[k][0]), height(rows[k][1][i]));
        if (rows[k][0] > this.to) break;
      }
      pen.stroke();
    });
    pen.setLineDash([]);
    pen.restore();
    ENERGIES.forEach(([name, colour, dash], i) => {
      const y = top + 8 + 14 * i;
      if (y > bottom) return;
      this._name(pen, name, y);
      pen.strokeStyle = colour;
      pen.setLineDash(dash);
      pen.beginPath();
      const end = MARGIN - 12 - pen.measureText(name).width;
      pen.moveTo(end - 16, y);
      pen.lineTo(end, y);
      pen.stroke();
      pen.setLineDash([]);
    });
  }

  _axis(pen, x, y) {
    const width = this.to - this.from;
    const raw = width / 6;
    const decade = 10 ** Math.floor(Math.log10(raw || 1));
    const step = [1, 2, 5, 10].map((n) => n * decade).find((n) => n >= raw) ?? decade;
    pen.fillStyle = this.ink;
    pen.textAlign = "center";
    const digits = Math.max(0, -Math.floor(Math.log10(step || 1)));
    for (let n = Math.ceil(this.from / step); n * step <= this.to; n++) {
      pen.fillRect(x(n * step), y - 4, 1, 4);
      const label = (n * step).toFixed(digits);
      const half = pen.measureText(label).width / 2;
      // the first one would lie on the name, the last one would be cut
      if (x(n * step) > MARGIN + 12) pen.fillText(label, Math.min(x(n * step), this.canvas.clientWidth - half - 2), y + 7);
    }
    this._name(pen, "t [s]", y + 7);
  }
}
