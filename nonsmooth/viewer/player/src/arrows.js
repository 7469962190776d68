// Arrows, drawn over everything: else they hide in the bodies they push.

import * as THREE from "three";

const UP = new THREE.Vector3(0, 1, 0);

export class Arrows {
  constructor(scene, width) {
    this.scene = scene;
    this.width = width;
    this.pool = [];
    this.used = 0;
    this.shaft = new THREE.CylinderGeometry(1, 1, 1, 8).translate(0, 0.5, 0);
    this.head = new THREE.ConeGeometry(2.6, 6, 12).translate(0, -3, 0);
  }

  _made() {
    const material = new THREE.MeshBasicMaterial({ transparent: true, depthTest: false });
    const group = new THREE.Group();
    group.add(new THREE.Mesh(this.shaft, material), new THREE.Mesh(this.head, material));
    group.renderOrder = 10;
    group.children.forEach((child) => (child.renderOrder = 10));
    this.scene.add(group);
    this.pool.push(group);
    return group;
  }

  clear() {
    this.pool.forEach((one) => (one.visible = false));
    this.used = 0;
  }

  /** Adds an arrow from a place along a vector, of that length [m]. */
  add(place, along, colour, opacity = 1) {
    const length = along.length();
    if (!(length > 0)) return;
    const group = this.pool[this.used] ?? this._made();
    this.used += 1;
    const width = Math.min(this.width, length / 9);
    const [shaft, head] = group.children;
    shaft.scale.set(width, Math.max(length - 5 * width, 0.01 * length), width);
    head.scale.setScalar(width);
    head.position.set(0, length, 0);
    group.position.copy(place);
    group.quaternion.setFromUnitVectors(UP, along.clone().divideScalar(length));
    shaft.material.color.set(colour);
    shaft.material.opacity = opacity;
    group.visible = true;
    group.userData = { length };
  }

  lengths() {
    return this.pool.slice(0, this.used).map((one) => one.userData.length);
  }
}
