// The player: time, keys and what is said of the present.

import { read } from "./decode.js";
import { MARKUP, icon } from "./page.js";
import { DIGITS, breakable, decimals, energyScale, spoken } from "./numbers.js";
import { Run } from "./run.js";
import { Timeline } from "./timeline.js";
import { World } from "./world.js";

const SPEEDS = [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
const NEAR = 0.12; // of an impact, where it is slow [s watched]
const SLOWEST = 0.12;
const STRONG = 0.25; // of the strongest
const APART = 0.02; // impacts that are slowed down [s]

class Player {
  constructor(run) {
    this.run = run;
    this.t = run.t0;
    this.event = -1; // the event that was stepped to
    this.playing = false;
    this.draws = 0;
    this.speed = pace(run);
    this.decimals = decimals(run.t1, DIGITS);
    this.dark = matchMedia("(prefers-color-scheme: dark)").matches;
    document.title = run.told.title;
    this.at("panel").querySelector("h1").textContent = run.told.title;
    this.at("status").textContent = `${run.told.status}: ${run.told.message}; ${run.nEvents} events`;
    this._theme();
    try {
      this.world = new World(this.at("world"), run, this.dark);
    } catch (error) {
      this.world = null;
      this._trouble(`This browser shows no bodies, as WebGL is off or missing (${error.message}). Times, words and energies are all there.`);
    }
    this.timeline = new Timeline(this.at("strips"), run, (t) => this.go(t));
    this.impacts = this._impacts();
    this._bind();
    this._fill();
    new ResizeObserver(() => this._resize()).observe(this.at("picture"));
    new ResizeObserver(() => this.draw()).observe(this.at("strips"));
    this._resize();
    this.world?.view("corner");
    this.draw();
    // where several may stand on a page, or motion is not wanted, it waits to be asked
    if (window.top === window && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play(true);
    else this.at("start").hidden = false;
  }

  at(id) {
    return document.getElementById(id);
  }

  _trouble(words) {
    this.at("trouble").hidden = false;
    this.at("trouble").textContent = words;
    this.at("world").hidden = true;
  }

  /** Impacts that are watched slowly. */
  _impacts() {
    const { strength, event_time } = this.run;
    const strongest = strength.reduce((a, b) => Math.max(a, b), 0);
    const found = [];
    for (let e = 0; e < strength.length; e++)
      if (strength[e] > STRONG * strongest && !(event_time[e] - found[found.length - 1] < APART)) found.push(event_time[e]);
    return found;
  }

  _bind() {
    const on = (id, what) => this.at(id).addEventListener(id === "scrub" ? "input" : this.at(id).matches("button") ? "click" : "change", what);
    const speeds = [...new Set([...SPEEDS, this.speed])].sort((a, b) => b - a);
    this.at("speed").innerHTML = speeds.map((speed) => `<option value="${speed}">${spoken(speed)}</option>`).join("");
    this.at("speed").value = String(this.speed);
    on("back", () => this.step(-1));
    on("play", () => this.play(!this.playing));
    on("start", () => this.play(true));
    on("forth", () => this.step(1));
    on("scrub", (event) => this.go(this.run.t0 + (event.target.value / 1000) * (this.run.t1 - this.run.t0)));
    on("speed", (event) => (this.speed = Number(event.target.value)));
    on("slow", () => this.draw());
    on("forces", () => this._show());
    on("follow", () => this._show());
    on("view", (event) => this._view(event.target.value));
    on("help", () => this._help());
    this.at("follow").checked = this.world?.follow ?? false;
    this.world?.controls.addEventListener("change", () => this._lookRound());
    document.addEventListener("keydown", (event) => this._key(event));
  }

  _lookRound() {
    if (this.drawing) return;
    this.draw();
  }

  _show() {
    if (this.world) [this.world.showForces, this.world.follow] = [this.at("forces").checked, this.at("follow").checked];
    this.draw();
  }

  _view(name) {
    this.at("view").value = name;
    this.world?.view(name);
    this.draw();
  }

  _help() {
    const keys = this.at("keys");
    keys.hidden = !keys.hidden;
    this.at("help").setAttribute("aria-expanded", String(!keys.hidden));
  }

  _theme() {
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
    this.world?.theme(this.dark);
  }

  _key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const inside = event.target.matches?.("select, input[type=range], button");
    if (inside && [" ", "ArrowLeft", "ArrowRight", "Home", "End", "Enter"].includes(event.key)) return;
    const frame = this.speed / 30;
    const toggle = (id) => {
      this.at(id).checked = !this.at(id).checked;
      this._show();
    };
    const keys = {
      " ": () => this.play(!this.playing),
      ArrowLeft: () => this.go(this.t - frame),
      ArrowRight: () => this.go(this.t + frame),
      "[": () => this.step(-1),
      "]": () => this.step(1),
      Home: () => this.go(this.run.t0),
      End: () => this.go(this.run.t1),
      "-": () => this._pace(1),
      "=": () => this._pace(-1),
      "+": () => this._pace(-1),
      1: () => this._view("corner"),
      2: () => this._view("front"),
      3: () => this._view("side"),
      4: () => this._view("top"),
      t: () => toggle("follow"),
      f: () => toggle("forces"),
      s: () => (this.at("slow").checked = !this.at("slow").checked),
      l: () => {
        this.dark = !this.dark;
        this._theme();
        this.draw();
      },
      "?": () => this._help(),
    };
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  _pace(change) {
    const select = this.at("speed");
    select.selectedIndex = Math.min(Math.max(select.selectedIndex + change, 0), select.options.length - 1);
    this.speed = Number(select.value);
  }

  go(t) {
    this.at("start").hidden = true;
    this.event = -1;
    this.t = Math.min(Math.max(t, this.run.t0), this.run.t1);
    this.draw();
  }

  /** Goes to the event before (-1) or after (1), by its number: events may share an instant. */
  step(way) {
    const { run } = this;
    const here = this.event >= 0 ? this.event + way : way > 0 ? run.event(this.t) + 1 : run.event(this.t);
    this.stepTo(Math.min(Math.max(here, 0), run.nEvents - 1));
  }

  stepTo(e) {
    if (!(e >= 0 && e < this.run.nEvents)) return;
    this.play(false);
    this.at("start").hidden = true;
    this.event = e;
    this.t = this.run.event_time[e];
    this.draw();
    const { before, during, after } = this.run.words(e);
    breakable(this.at("event"), `Event ${e + 1} of ${this.run.nEvents}, ${this.run.title(e)}. ${before} → ${during} → ${after}`);
  }

  play(on) {
    if (on === this.playing) return;
    if (on && this.t >= this.run.t1) this.go(this.run.t0);
    this.playing = on;
    this.event = -1;
    this.at("start").hidden = true;
    const button = this.at("play");
    button.innerHTML = icon(on ? "pause" : "play");
    button.setAttribute("aria-label", on ? "pause" : "play");
    this.watched = undefined;
    if (on) requestAnimationFrame((now) => this._tick(now));
    else this.draw();
  }

  _tick(now) {
    if (!this.playing) return;
    const passed = this.watched === undefined ? 0 : Math.min((now - this.watched) / 1000, 0.1);
    this.watched = now;
    this.t += passed * this.speed * (this.at("slow").checked ? this._slowness() : 1);
    if (this.t >= this.run.t1) {
      this.t = this.run.t1;
      this.play(false);
    } else {
      this.draw();
      requestAnimationFrame((next) => this._tick(next));
    }
  }

  _slowness() {
    let nearest = Infinity;
    for (const impact of this.impacts) nearest = Math.min(nearest, Math.abs(this.t - impact));
    const part = Math.min(nearest / this.speed / NEAR, 1);
    return SLOWEST + (1 - SLOWEST) * part * part;
  }

  _resize() {
    const box = this.at("picture").getBoundingClientRect();
    if (this.world && box.width > 0 && box.height > 0) this.world.resize(box.width, box.height);
    this.draw();
  }

  draw() {
    if (!this.timeline) return;
    this.drawing = true;
    this.timeline.keep(this.t);
    // while it plays the strips are drawn every second time
    if (!this.playing || this.draws % 2 === 0) this.timeline.draw(this.t, this.event);
    this.world?.draw(this.t, this.event, this.playing ? this.speed : Math.max(this.speed, 1e-9));
    this.drawing = false;
    this.draws += 1;
    this._say();
  }

  _fill() {
    const body = this.at("energies").tBodies[0];
    const names = ["kinetic", "potential", "lost to restitution", "lost to friction", "work done"];
    body.innerHTML = names.map((name) => `<tr><th scope="row">${name}</th><td></td></tr>`).join("");
    this.cells = [...body.querySelectorAll("td")];
    const [unit, joules] = energyScale(this.run.energy);
    this.joules = joules;
    this.at("energies").caption.textContent = `energies [${unit}]`;
  }

  _say() {
    const { run, t } = this;
    const e = this.event >= 0 ? this.event : run.event(t);
    const scrub = this.at("scrub");
    scrub.value = String(Math.round((1000 * (t - run.t0)) / (run.t1 - run.t0 || 1)));
    scrub.setAttribute("aria-valuetext", `${t.toFixed(6)} s`);
    this.at("clock").textContent = `${t.toFixed(this.decimals)} s`;
    breakable(this.at("word"), run.told.contacts.length === 0 ? "no contacts" : e >= 0 ? run.words(e).after : "");
    if (this.event < 0) this.at("event").textContent = "";
    run.energies(t).forEach((value, i) => (this.cells[i].textContent = this.joules(value)));
    this._closed(e);
  }

  _closed(e) {
    const { run } = this;
    const list = [];
    if (e >= 0)
      for (let i = run.event_first[e]; i < run.event_first[e + 1]; i++) {
        const mode = { 1: "stick", 5: "slip" }[(run.event_codes[i] >> 6) & 7];
        if (mode) list.push([mode, run.told.contacts[run.event_contact[i]].name]);
      }
    const shown = list.slice(0, 12).map(([mode, name]) => `<li><span class="${mode}"></span>${mode} <b></b></li>`);
    if (list.length > 12) shown.push(`<li>and ${list.length - 12} more</li>`);
    const key = JSON.stringify(list);
    if (key === this.listed) return;
    this.listed = key;
    const element = this.at("contacts");
    element.innerHTML = shown.join("");
    // names are the user's own: they go in as text
    element.querySelectorAll("b").forEach((one, i) => (one.textContent = list[i][1]));
  }
}

/** A speed at which impacts can be told apart, and a run is not watched for more than a minute. */
function pace(run) {
  const span = run.t1 - run.t0;
  const instants = run.instant_knot.length;
  const slow = SPEEDS.find((speed) => span / speed >= 10 && (instants / span) * speed <= 6);
  const longest = [...SPEEDS].reverse().find((speed) => span / speed <= 60);
  return Math.max(slow ?? 0, longest ?? 1);
}

async function start() {
  document.body.querySelectorAll("#cut").forEach((one) => one.remove());
  const place = document.createElement("div");
  document.body.append(place);
  try {
    const run = new Run(await read());
    place.outerHTML = MARKUP;
    window.view = new Player(run);
  } catch (error) {
    place.outerHTML = `<main><p id="failure" role="alert"></p></main>`;
    document.getElementById("failure").textContent = error.message;
  }
  document.documentElement.dataset.ready = "yes";
}

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start);
else start();
