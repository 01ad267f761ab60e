// SPDX-License-Identifier: Apache-2.0
// Distances of points to the plan: its wall faces, floors and ceilings. No drawing, no three.js.
"use strict";

Plumb.Residuals = class {
  /** Greater distances are given as this one, m: a red point is at least that far off. */
  static most = 0.2;

  /** Faces are found by cells of the plane; each cell lists those that come within `most` of it. */
  constructor(faces, storeys, cell = 1.0) {
    this.faces = faces;
    this.cell = cell;
    this.cells = new Map();
    this.levels = [];
    for (const s of storeys) this.levels.push(s.z, s.z + s.h);
    const reach = Plumb.Residuals.most;
    faces.forEach((f, index) => {
      const x0 = Math.floor((Math.min(f.p[0], f.q[0]) - reach) / cell), x1 = Math.floor((Math.max(f.p[0], f.q[0]) + reach) / cell);
      const y0 = Math.floor((Math.min(f.p[1], f.q[1]) - reach) / cell), y1 = Math.floor((Math.max(f.p[1], f.q[1]) + reach) / cell);
      const around = reach + cell * Math.SQRT1_2;
      for (let x = x0; x <= x1; ++x)
        for (let y = y0; y <= y1; ++y) {
          if (this.toFace(f, (x + 0.5) * cell, (y + 0.5) * cell) > around) continue;
          const key = x * 1e6 + y;
          if (!this.cells.has(key)) this.cells.set(key, []);
          this.cells.get(key).push(index);
        }
    });
  }

  /** Distance in the plane to the stretch of a face. */
  toFace(f, x, y) {
    const dx = f.q[0] - f.p[0], dy = f.q[1] - f.p[1], length2 = dx * dx + dy * dy;
    const s = length2 > 0 ? Math.min(1, Math.max(0, ((x - f.p[0]) * dx + (y - f.p[1]) * dy) / length2)) : 0;
    return Math.hypot(x - f.p[0] - s * dx, y - f.p[1] - s * dy);
  }

  /** Least distance of a point to the plan, at most `most`. */
  at(x, y, z) {
    let least = Plumb.Residuals.most;
    for (const level of this.levels) least = Math.min(least, Math.abs(z - level));
    const list = this.cells.get(Math.floor(x / this.cell) * 1e6 + Math.floor(y / this.cell));
    if (list)
      for (const index of list) {
        const f = this.faces[index];
        if (z < f.z[0] - least || z > f.z[1] + least) continue;
        least = Math.min(least, this.toFace(f, x, y));
      }
    return least;
  }

  /** The element of the plan that each point lies on, by index; -1: a floor or ceiling, -2: nothing within `most`. */
  owners(points, count) {
    if (!this.elements) {
      const known = new Map();
      this.elements = this.faces.map((f) => (known.has(f.wall) ? known : known.set(f.wall, known.size)).get(f.wall));
      this.names = [...known.keys()];
    }
    const out = new Int32Array(count);
    for (let i = 0; i < count; ++i) {
      const [x, y, z] = [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
      let least = Plumb.Residuals.most, owner = -2;
      for (const level of this.levels) if (Math.abs(z - level) < least) [least, owner] = [Math.abs(z - level), -1];
      for (const index of this.cells.get(Math.floor(x / this.cell) * 1e6 + Math.floor(y / this.cell)) || []) {
        const f = this.faces[index];
        if (z < f.z[0] - least || z > f.z[1] + least) continue;
        const d = this.toFace(f, x, y);
        if (d < least) [least, owner] = [d, this.elements[index]];
      }
      out[i] = owner;
    }
    return out;
  }

  /** Of every point. */
  of(points, count) {
    const out = new Float32Array(count);
    for (let i = 0; i < count; ++i) out[i] = this.at(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
    return out;
  }

  /** Median distance of the points nearer than `reach` to one of the faces, and how many there are. */
  ofFaces(faces, points, count, reach = 0.5) {
    const near = [];
    for (let i = 0; i < count; ++i) {
      let least = reach;
      for (const f of faces) {
        const z = points[3 * i + 2];
        if (z >= f.z[0] + 0.1 && z <= f.z[1] - 0.1) // not the floor and the ceiling beside it
          least = Math.min(least, this.toFace(f, points[3 * i], points[3 * i + 1]));
      }
      if (least < reach) near.push(least);
    }
    return { count: near.length, median: Plumb.median(near) };
  }
};

Plumb.median = (values) => {
  if (values.length === 0) return NaN;
  const sorted = Float64Array.from(values).sort();
  return 0.5 * (sorted[(sorted.length - 1) >> 1] + sorted[sorted.length >> 1]);
};
