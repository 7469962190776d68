// The bodies in space.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";

import { Arrows } from "./arrows.js";
import { SLIDE } from "./run.js";
import { Sheet } from "./sheet.js";

export const COLOURS = { stick: "#0072b2", slip: "#e69f00", impulse: "#d55e00", push: "#009e73", link: "#5b6675" };
const BODIES = ["#6fa8dc", "#f2b36b", "#7cc08f", "#d98fb8", "#b9a3e3", "#9fb8ad", "#d8c66a", "#8fc7d4"];
const FADING = 0.15; // how long an impulse is seen [s watched]
const CORNERS = [[0.9, -1.3, 0.7], [-0.9, -1.3, 0.7], [-0.9, 1.3, 0.7], [0.9, 1.3, 0.7]];
const VIEWS = { front: [0, -1, 0.0001], side: [1, 0, 0.0001], top: [0, -0.0001, 1] };
const GRID = 1000; // of a solid, half as many units as it is large
const LONG = 30; // a way so many times as long as the bodies is not seen whole: they would be some 20 pixels high
const ROUND = 3; // how much is seen round bodies that the camera goes with, measured by their size
const FILLED = 0.9; // of the picture, by what is to be seen
const LEAST = 0.08; // of what is seen, by what arrows, lines and marks are measured: thinner ones are below a pixel
const MOST = 0.2; // of what is seen: larger arrows hide the bodies

export class World {
  constructor(canvas, run, dark) {
    this.run = run;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.low = new THREE.Vector3(...run.told.low);
    this.high = new THREE.Vector3(...run.told.high);
    this.span = Math.max(this.high.distanceTo(this.low), 1e-9);
    this.reach = run.told.reach;
    this.sheets = [];
    this.showForces = true;
    this.frames = Array.from({ length: run.nFrames }, () => new THREE.Group());
    this.frames.forEach((frame) => this.scene.add(frame));
    const sun = new THREE.DirectionalLight("#ffffff", 2.2);
    sun.position.set(0.3, -0.5, 0.81);
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8a8f99", 1.6), sun);
    this.put(run.t0);
    const { radius } = this.group();
    this.follow = this.span > LONG * 2 * radius;
    const seen = this.follow ? 2 * ROUND * radius : this.span;
    this.size = Math.min(Math.max(this.unit, LEAST * seen), MOST * seen);
    run.told.parts.forEach((part) => this._addPart(part));
    this.strokes = run.told.strokes.map((stroke) => this._addStroke(stroke));
    this.arrows = new Arrows(this.scene, 0.04 * this.size);
    const strongest = Math.max(...run.strength, 1e-300);
    this.perImpulse = this.size / strongest;
    this.perForce = (0.6 * this.size) / this._typicalForce();
    this.theme(dark);
    this.scene.updateMatrixWorld();
    this.view("corner");
  }

  /** The size of what moves [m]. */
  get unit() {
    return Math.min(this.reach, 0.5 * this.span);
  }

  _typicalForce() {
    const sizes = [];
    const p = this.run.force_push;
    for (let i = 0; i < p.length; i += 3) sizes.push(Math.hypot(p[i], p[i + 1], p[i + 2]));
    sizes.sort((a, b) => a - b);
    return sizes[Math.floor(0.95 * sizes.length)] || 1;
  }

  _addPart(part) {
    const { told, vertices, triangles, lines } = this.run;
    const frame = this.frames[part.frame];
    const moves = told.bodies[part.body].moves;
    const colour = moves ? BODIES[told.bodies.slice(0, part.body).filter((b) => b.moves).length % BODIES.length] : "#aab2bd";
    const [first, end] = part.vertices;
    if (part.sheet) {
      const sheet = new Sheet(part.sheet, vertices[3 * first + 2], this.unit);
      this.sheets.push(sheet);
      return void frame.add(sheet.group);
    }
    const points = vertices.slice(3 * first, 3 * end);
    const used = new Set();
    const [a, b] = part.triangles;
    if (b > a) {
      const index = triangles.slice(3 * a, 3 * b);
      index.forEach((i) => used.add(i));
      frame.add(solid(points, index, colour));
    }
    const width = 0.03 * this.size;
    for (let i = part.lines[0]; i < part.lines[1]; i++) {
      const [p, q] = [lines[2 * i], lines[2 * i + 1]];
      used.add(p).add(q);
      const bar = new THREE.Mesh(BAR, new THREE.MeshLambertMaterial({ color: COLOURS.link }));
      span(bar, vector(points, p), vector(points, q), width);
      frame.add(bar);
    }
    for (let i = 0; i < end - first; i++) {
      if (used.has(i)) continue;
      const mark = new THREE.Mesh(DOT, new THREE.MeshLambertMaterial({ color: colour }));
      mark.position.copy(vector(points, i));
      mark.scale.setScalar(0.06 * this.size);
      frame.add(mark);
    }
  }

  _addStroke(stroke) {
    const mesh = new THREE.Mesh(
      stroke.kind === "load" ? COIL : BAR,
      new THREE.MeshLambertMaterial({ color: stroke.kind === "joint" ? "#8c6d46" : COLOURS.link }),
    );
    this.scene.add(mesh);
    const between = stroke.frames[0] !== stroke.frames[1];
    if (stroke.kind === "joint" && between) stroke.frames.forEach((frame, i) => this.frames[frame].add(this._ring(stroke.ends[i])));
    return { mesh, stroke };
  }

  /** The mark of a joint, over bodies: it is within them. */
  _ring(place) {
    const ring = new THREE.Group();
    for (const [colour, size, order] of [["#1c2430", 0.06, 8], ["#f4f6f9", 0.035, 9]]) {
      const dot = new THREE.Mesh(DOT, new THREE.MeshBasicMaterial({ color: colour, depthTest: false, transparent: true }));
      dot.scale.setScalar(size * this.size);
      dot.renderOrder = order;
      ring.add(dot);
    }
    ring.position.set(...place);
    return ring;
  }

  theme(dark) {
    this.scene.background = new THREE.Color(dark ? "#14181f" : "#f4f6f9");
    this.sheets.forEach((sheet) => sheet.theme(dark));
  }

  /** Puts all frames where they are at a time. */
  put(t) {
    const knot = this.run.knot(t);
    this.frames.forEach((frame, i) => this.run.place(i, knot, frame.position, frame.quaternion));
    for (const { mesh, stroke } of this.strokes ?? []) {
      const [p, q] = [0, 1].map((i) => {
        const frame = this.frames[stroke.frames[i]];
        return new THREE.Vector3(...stroke.ends[i]).applyQuaternion(frame.quaternion).add(frame.position);
      });
      span(mesh, p, q, (stroke.kind === "load" ? 0.12 : 0.035) * this.size);
    }
    return knot;
  }

  /** Middle of what moves and the radius of a ball round it [m]. */
  group() {
    const { parts, bodies } = this.run.told;
    const seen = parts.filter((part) => bodies[part.body].moves).map((part) => this.frames[part.frame].position);
    if (seen.length === 0) return { middle: this.low.clone().add(this.high).multiplyScalar(0.5), radius: 0.5 * this.span };
    const box = new THREE.Box3().setFromPoints(seen);
    const middle = box.getCenter(new THREE.Vector3());
    return { middle, radius: 0.5 * box.min.distanceTo(box.max) + this.reach };
  }

  view(name) {
    const away = new THREE.Vector3(...(VIEWS[name] ?? this._corner())).normalize();
    const { middle, radius } = this.group();
    const whole = new THREE.Box3(this.low, this.high);
    const seen = this.follow ? new THREE.Box3().setFromCenterAndSize(middle, new THREE.Vector3().setScalar(2 * ROUND * radius)) : whole;
    seen.getCenter(this.controls.target);
    const distance = this._distance(seen.getSize(new THREE.Vector3()), away);
    this.camera.position.copy(this.controls.target).addScaledVector(away, distance);
    this.camera.near = distance / 1000;
    this.camera.far = distance * 100 + 10 * this.span;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** Of the corners the first one from which most sheets show their upper side. */
  _corner() {
    const normals = this.sheets.map(({ group }) => new THREE.Vector3(0, 0, 1).transformDirection(group.matrixWorld));
    const shown = CORNERS.map((corner) => normals.filter((normal) => normal.dot(new THREE.Vector3(...corner)) > 0).length);
    return CORNERS[shown.indexOf(Math.max(...shown))];
  }

  /** From how far away a box is seen as large as the picture allows. */
  _distance(size, away) {
    const across = new THREE.Vector3().crossVectors(this.camera.up, away).normalize();
    const up = new THREE.Vector3().crossVectors(away, across);
    const tangent = FILLED * Math.tan((this.camera.fov * Math.PI) / 360);
    let found = 0;
    for (const signs of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
      const corner = new THREE.Vector3(signs[0] * size.x, signs[1] * size.y, size.z).multiplyScalar(0.5);
      // those opposite to the four have the same distances from the middle of the picture
      const wide = Math.max(Math.abs(corner.dot(across)) / this.camera.aspect, Math.abs(corner.dot(up)));
      found = Math.max(found, Math.abs(corner.dot(away)) + wide / tangent);
    }
    return found;
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** Draws time t [s]; of impulses those of one event, or, of none, those of the last moments watched. */
  draw(t, event, speed) {
    const before = this.follow ? this.group().middle : null;
    const [k] = this.put(t);
    if (before) {
      const moved = this.group().middle.sub(before);
      this.camera.position.add(moved);
      this.controls.target.add(moved);
    }
    this.arrows.clear();
    if (this.showForces) this._forces(k);
    this._impulses(t, event, speed);
    this.controls.update();
    this.sheets.forEach((sheet) => sheet.seenFrom(this.camera.position));
    this.renderer.render(this.scene, this.camera);
  }

  _forces(k) {
    const run = this.run;
    if (k + 1 >= run.force_first.length) return;
    for (let i = run.force_first[k]; i < run.force_first[k + 1]; i++) {
      const place = vector(run.force_point, i);
      this.arrows.add(place, vector(run.force_push, i).multiplyScalar(this.perForce).clampLength(0, 2 * this.size), COLOURS.push);
      const colour = run.force_mode[i] === SLIDE ? COLOURS.slip : COLOURS.stick;
      this.arrows.add(place, vector(run.force_rub, i).multiplyScalar(this.perForce).clampLength(0, 2 * this.size), colour);
    }
  }

  _impulses(t, event, speed) {
    const run = this.run;
    const show = (e, opacity) => {
      for (let i = run.event_first[e]; i < run.event_first[e + 1]; i++) {
        const along = vector(run.event_push, i).add(vector(run.event_rub, i)).multiplyScalar(this.perImpulse);
        this.arrows.add(vector(run.event_point, i), along, COLOURS.impulse, opacity);
      }
    };
    if (event >= 0) return show(event, 1);
    for (let e = run.event(t); e >= 0; e--) {
      const age = (t - run.event_time[e]) / speed;
      if (age > FADING) break;
      show(e, 1 - age / FADING);
    }
  }
}

const BAR = new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0);
const DOT = new THREE.SphereGeometry(1, 16, 12);
const COIL = new THREE.TubeGeometry(
  new (class extends THREE.Curve {
    getPoint(s) {
      const part = Math.min(Math.max((s - 0.08) / 0.84, 0), 1);
      const radius = s < 0.08 || s > 0.92 ? 0 : 1;
      return new THREE.Vector3(radius * Math.cos(50 * part), s, radius * Math.sin(50 * part));
    }
  })(),
  240, 0.012, 6,
);
const UP = new THREE.Vector3(0, 1, 0);

function vector(array, i) {
  return new THREE.Vector3(array[3 * i], array[3 * i + 1], array[3 * i + 2]);
}

/** Lays a mesh of unit length from one point to another. */
function span(mesh, from, to, width) {
  const along = to.clone().sub(from);
  const length = along.length();
  mesh.visible = length > 0;
  if (!mesh.visible) return;
  mesh.position.copy(from);
  mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
  mesh.scale.set(width, length, width);
}

function solid(points, index, colour) {
  // creases are looked for on a grid of a hundredth
  const size = points.reduce((most, x) => Math.max(most, Math.abs(x)), 0) / GRID || 1;
  let shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(points.map((x) => x / size), 3));
  shape.setIndex(new THREE.BufferAttribute(new Uint32Array(index), 1));
  shape = toCreasedNormals(shape, 0.6);
  const n = index.length / 3;
  const base = new THREE.Color(colour);
  const shade = base.clone().multiplyScalar(0.62);
  const [places, normals] = ["position", "normal"].map((name) => shape.getAttribute(name));
  const curved = (i) => {
    const [p, q, r] = [0, 1, 2].map((j) => new THREE.Vector3().fromBufferAttribute(normals, 3 * i + j));
    return Math.min(p.dot(q), p.dot(r)) < 1 - 1e-6;
  };
  shape.computeBoundingBox();
  const middle = shape.boundingBox.getCenter(new THREE.Vector3());
  const colours = new Float32Array(9 * n);
  for (let i = 0; i < n; i++) {
    const at = new THREE.Vector3();
    for (let j = 0; j < 3; j++) at.add(new THREE.Vector3().fromBufferAttribute(places, 3 * i + j));
    at.divideScalar(3).sub(middle);
    const used = at.x * at.y * at.z > 0 && curved(i) ? shade : base;
    for (let j = 0; j < 3; j++) used.toArray(colours, 9 * i + 3 * j);
  }
  shape.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  const mesh = new THREE.Mesh(shape, new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide }));
  mesh.scale.setScalar(size);
  return mesh;
}
