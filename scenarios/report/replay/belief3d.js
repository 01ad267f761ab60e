// SPDX-License-Identifier: Apache-2.0
// Hypotheses and particles of a localization, and the map cloud of a method.
"use strict";

Object.assign(Plumb.View3d.prototype, {
  /** A bar of 3 m for the whole belief, an arrow and the 95 % ellipse, for each hypothesis. */
  drawHypotheses(moment) {
    this.clear(this.groups.hypotheses);
    if (!moment.set) return;
    const colour = moment.colour;
    for (const h of moment.set.hypotheses) {
      const group = new THREE.Group(), w = 0.07, top = 3 * h.share, bar = [];
      for (const [a, b] of [[[-w, -w], [w, -w]], [[w, -w], [w, w]], [[w, w], [-w, w]], [[-w, w], [-w, -w]]])
        bar.push(...a, 0, ...b, 0, ...b, top, ...a, top);
      bar.push(-w, -w, top, w, -w, top, w, w, top, -w, w, top);
      group.add(this.quads(bar, this.flat(colour, 0.85)));
      const arrow = this.robot(colour, false);
      arrow.rotation.z = h.yaw;
      arrow.position.z = 0.03;
      group.add(arrow, this.ellipse(h.cov, colour));
      group.position.set(h.p[0], h.p[1], h.p[2] - this.base + 0.04);
      this.groups.hypotheses.add(group);
    }
  },

  ellipse([xx, xy, yy], colour) {
    const half = 0.5 * (xx + yy), root = Math.sqrt(Math.max(0, 0.25 * (xx - yy) ** 2 + xy * xy)), angle = 0.5 * Math.atan2(2 * xy, xx - yy);
    const a = Math.sqrt(5.991 * Math.max(0, half + root)), b = Math.sqrt(5.991 * Math.max(0, half - root)), corners = [];
    const at = (k, grow) => {
      const u = (2 * Math.PI * k) / 32, x = (a + grow) * Math.cos(u), y = (b + grow) * Math.sin(u);
      return [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), 0.02];
    };
    for (let k = 0; k < 32; ++k) corners.push(...at(k, 0), ...at(k, 0.03), ...at(k + 1, 0.03), ...at(k + 1, 0));
    return this.quads(corners, this.flat(colour));
  },

  drawParticles(moment) {
    const list = moment.particles, points = this.particlePoints;
    points.visible = !!list;
    if (!list) return;
    const n = Math.min(2048, list.length / 2), at = new Float32Array(3 * n), colours = new Uint8Array(3 * n);
    const rgb = [1, 3, 5].map((k) => parseInt(moment.colour.slice(k, k + 2), 16));
    for (let i = 0; i < n; ++i) {
      at.set([list[2 * i] * 0.01, list[2 * i + 1] * 0.01, moment.floor + 0.1], 3 * i);
      colours.set(rgb, 3 * i);
    }
    this.setPoints(points, at, colours, n);
  },

  /** The final map of the method, coloured by height. */
  drawMap(moment) {
    const at = moment.map;
    if (this.mapShown === at && this.mapFloor === moment.floor) return;
    [this.mapShown, this.mapFloor] = [at, moment.floor];
    this.clear(this.groups.map);
    if (!at) return;
    const n = at.length / 3, points = this.pointsOf(n, 2, 1e-4), even = Plumb.colours.even, colours = new Uint8Array(3 * n);
    for (let i = 0; i < n; ++i) colours.set(Plumb.colours.along(even, (at[3 * i + 2] - moment.floor) / 2.8), 3 * i);
    this.setPoints(points, at, colours, n);
    this.groups.map.add(points);
  },
});
