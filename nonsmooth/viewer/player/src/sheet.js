// A piece of a plane without end, seen from its upper side; from below only its edge is drawn.

import * as THREE from "three";

const FEWEST = 10; // cells along the longer side
const MOST = 200;

export class Sheet {
  /** corners: [x, y] in order, of a convex piece; unit: the size of what moves over it. */
  constructor(corners, height, unit) {
    this.group = new THREE.Group();
    this.group.position.z = height;
    const flat = corners.map(([x, y]) => [x, y, 0]);
    const fan = flat.slice(2).flatMap((corner, i) => [flat[0], flat[i + 1], corner]);
    this.face = new THREE.Mesh(
      geometry(fan).setAttribute("normal", new THREE.Float32BufferAttribute(fan.flatMap(() => [0, 0, 1]), 3)),
      new THREE.MeshLambertMaterial({ transparent: true, opacity: 0.35, depthWrite: false }),
    );
    const material = () => new THREE.LineBasicMaterial({ transparent: true, opacity: 0.5 });
    this.grid = new THREE.LineSegments(geometry(grid(corners, unit)), material());
    this.edge = new THREE.LineLoop(geometry(flat), material());
    this.group.add(this.face, this.grid, this.edge);
  }

  theme(dark) {
    this.face.material.color.set(dark ? "#3a4454" : "#c9d1db");
    for (const lines of [this.grid, this.edge]) lines.material.color.set(dark ? "#8794a8" : "#9aa5b4");
  }

  /** From behind a sheet one looks through it. */
  seenFrom(place) {
    this.face.visible = this.grid.visible = this.group.worldToLocal(place.clone()).z > 0;
  }
}

function geometry(points) {
  return new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(points.flat(), 3));
}

/** Ends of lines along both axes within a convex piece, at whole numbers of cells. */
function grid(corners, unit) {
  const sides = [0, 1].map((axis) => corners.map((corner) => corner[axis])).map((all) => [Math.min(...all), Math.max(...all)]);
  const longest = Math.max(...sides.map(([low, high]) => high - low));
  const cell = Math.max(longest / MOST, Math.min(longest / FEWEST, 2 * unit));
  const ends = [];
  for (const axis of [0, 1])
    for (let n = Math.ceil(sides[axis][0] / cell); n * cell <= sides[axis][1]; n++)
      for (const other of crossed(corners, axis, n * cell)) ends.push(axis === 0 ? [n * cell, other, 0] : [other, n * cell, 0]);
  return ends;
}

/** Where the line at a value of an axis enters and leaves a convex piece; nothing where it only touches it. */
function crossed(corners, axis, value) {
  const found = [];
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length];
    const [p, q] = [a[axis] - value, b[axis] - value];
    if (p < 0 !== q < 0) found.push(a[1 - axis] + (p / (p - q)) * (b[1 - axis] - a[1 - axis]));
  });
  return found;
}
