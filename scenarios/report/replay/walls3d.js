// SPDX-License-Identifier: Apache-2.0
// Walls over the building: those matched rightly and wrongly, and the chosen one.
"use strict";

Object.assign(Plumb.View3d.prototype, {
  /** A face without its doors, as faces. */
  solid(f) {
    const length = Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1]) || 1, parts = [];
    const at = (s) => [f.p[0] + ((f.q[0] - f.p[0]) * s) / length, f.p[1] + ((f.q[1] - f.p[1]) * s) / length];
    let s = 0;
    const add = (to) => { if (to > s + 0.01) parts.push({ p: at(s), q: at(to), z: f.z }); };
    for (const hole of [...(f.holes || [])].sort((a, b) => a[0] - b[0])) {
      if (hole[2] > f.z[0] + 0.3) continue; // a window has wall below
      add(hole[0]);
      s = Math.max(s, hole[1]);
    }
    add(length);
    return parts;
  },

  /** Strips along faces, from z0 to z1, moved out by `out`. */
  strip(faces, z0, z1, out) {
    const corners = [];
    for (const f of faces.flatMap((face) => this.solid(face))) {
      const dx = f.q[0] - f.p[0], dy = f.q[1] - f.p[1], d = Math.hypot(dx, dy) || 1, nx = (-dy / d) * out, ny = (dx / d) * out;
      const low = Math.max(f.z[0], z0), high = Math.min(f.z[1], z1);
      corners.push(f.p[0] + nx, f.p[1] + ny, low, f.q[0] + nx, f.q[1] + ny, low, f.q[0] + nx, f.q[1] + ny, high, f.p[0] + nx, f.p[1] + ny, high);
    }
    return corners;
  },

  /** Right matches are whole strips, wrong ones are cut into short pieces, so that they differ without colour. */
  drawWalls(moment) {
    this.clear(this.groups.walls);
    if (!moment.set) return;
    const floor = moment.floor, byId = this.facesById();
    const hypothesis = moment.set.hypotheses[0];
    if (!hypothesis) return;
    for (const right of [true, false]) {
      const faces = hypothesis.walls.filter((w) => w.right === right).flatMap((w) => w.faces.map((id) => byId.get(id)).filter(Boolean));
      let corners = this.strip(faces, floor + 0.05, floor + 1.19, 0.02);
      if (!right) {
        corners = [];
        for (const f of faces) {
          const length = Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1]), n = Math.max(2, Math.round(length / 0.3));
          for (let k = 0; k < n; k += 2) {
            const at = (s) => [f.p[0] + (f.q[0] - f.p[0]) * s, f.p[1] + (f.q[1] - f.p[1]) * s];
            corners.push(...this.strip([{ p: at(k / n), q: at((k + 1) / n), z: f.z }], floor + 0.05, floor + 1.19, 0.02));
          }
        }
      }
      if (corners.length) this.groups.walls.add(this.quads(corners, this.flat(right ? "#009E73" : "#D55E00", 0.75)));
    }
  },

  /** Lines from where what was seen stands to where it is taken to be. */
  drawDisplaced(moment) {
    const lines = moment.displaced.flatMap(([from, to]) => this.ribbon(from, to, moment.floor + 1.25));
    if (lines.length) this.groups.walls.add(this.quads(lines, this.flat("#D55E00", 0.6)));
  },

  /** Corners of a narrow level strip. */
  ribbon(a, b, z) {
    const d = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (d < 0.2) return [];
    const nx = (-(b[1] - a[1]) / d) * 0.025, ny = ((b[0] - a[0]) / d) * 0.025;
    return [a[0] - nx, a[1] - ny, z, b[0] - nx, b[1] - ny, z, b[0] + nx, b[1] + ny, z, a[0] + nx, a[1] + ny, z];
  },

  facesById() {
    if (!this.byId) this.byId = new Map(this.data.faces.map((f) => [f.id, f]));
    return this.byId;
  },

  drawSelection(moment) {
    this.clear(this.groups.selection);
    if (!moment.selected || moment.selected.faces.length === 0) return;
    this.groups.selection.add(this.quads(this.strip(moment.selected.faces, -1e9, moment.floor + 1.25, 0.035), this.flat("#F0E442", 0.85)));
  },
});
