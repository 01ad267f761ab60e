// SPDX-License-Identifier: Apache-2.0
// The run seen from above, on a plain canvas: what a browser without WebGL shows.
"use strict";

Plumb.View2d = class {
  constructor(canvas, data, labels) {
    this.canvas = canvas;
    this.data = data;
    this.labels = labels;
    this.moved = [];
    this.centre = [0, 0];
    this.scale = 20;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-0.0015 * event.deltaY), event.offsetX, event.offsetY);
    }, { passive: false });
    const fingers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
    canvas.addEventListener("pointerup", (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointercancel", (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const other = [...fingers].find(([id]) => id !== event.pointerId);
      if (other) {
        const was = Math.hypot(before[0] - other[1][0], before[1] - other[1][1]);
        this.zoom(Math.hypot(event.offsetX - other[1][0], event.offsetY - other[1][1]) / Math.max(1, was), ...other[1]);
      } else {
        this.placed = true;
        this.centre[0] -= (event.offsetX - before[0]) / this.scale;
        this.centre[1] += (event.offsetY - before[1]) / this.scale;
        this.moved.forEach((f) => f());
      }
      fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
  }

  zoom(by, x, y) {
    const fixed = this.toScene(x, y);
    this.placed = true;
    this.scale = Math.min(2000, Math.max(2, this.scale * by));
    const now = this.toScene(x, y);
    this.centre[0] += fixed[0] - now[0];
    this.centre[1] += fixed[1] - now[1];
    this.moved.forEach((f) => f());
  }

  home() {
    const xs = this.data.faces.flatMap((f) => [f.p[0], f.q[0]]), ys = this.data.faces.flatMap((f) => [f.p[1], f.q[1]]);
    const truth = this.data.tracks.truth;
    const low = (list, track) => list.concat([...track]).reduce((a, b) => Math.min(a, b), 1e9);
    const high = (list, track) => list.concat([...track]).reduce((a, b) => Math.max(a, b), -1e9);
    const x0 = low(xs, truth.p[0]), x1 = high(xs, truth.p[0]), y0 = low(ys, truth.p[1]), y1 = high(ys, truth.p[1]);
    this.centre = [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
    if (this.size) this.scale = 0.94 * Math.min(this.size[0] / Math.max(1, x1 - x0), this.size[1] / Math.max(1, y1 - y0));
  }

  toScreen(p) {
    return [0.5 * this.size[0] + (p[0] - this.centre[0]) * this.scale, 0.5 * this.size[1] - (p[1] - this.centre[1]) * this.scale];
  }

  toScene(x, y) {
    return [this.centre[0] + (x - 0.5 * this.size[0]) / this.scale, this.centre[1] - (y - 0.5 * this.size[1]) / this.scale];
  }

  resize(width, height) {
    const first = !this.size;
    this.size = [width, height];
    const ratio = Math.min(2, devicePixelRatio || 1);
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    this.ratio = ratio;
    if (first) this.home();
  }

  draw(moment) {
    const g = this.canvas.getContext("2d");
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.fillStyle = moment.dark ? "#14181e" : "#fff";
    g.fillRect(0, 0, ...this.size);
    if (!moment.off.has("building")) this.drawPlan(g, moment);
    if (!moment.off.has("deviations")) this.drawDeviations(g, moment);
    if (moment.cloud && !moment.off.has("scan")) this.drawScan(g, moment);
    if (!moment.off.has("particles") && moment.particles) {
      g.fillStyle = moment.colour;
      for (let i = 0; i < moment.particles.length; i += 2) {
        const [x, y] = this.toScreen([moment.particles[i] * 0.01, moment.particles[i + 1] * 0.01]);
        g.fillRect(x - 1.5, y - 1.5, 3, 3);
      }
    }
    if (!moment.off.has("walls")) {
      this.drawWalls(g, moment);
      this.drawDisplaced(g, moment);
    }
    this.drawTracks(g, moment);
    if (!moment.off.has("hypotheses") && moment.set)
      for (const h of moment.set.hypotheses) this.arrow(g, h.p, h.yaw, moment.colour, 0.3 + 0.5 * h.share);
    Plumb.placeLabels(this.labels, moment, (p) => this.toScreen(p));
  }

  strokeFaces(g, faces, colour, width, dash = []) {
    g.strokeStyle = colour;
    g.lineWidth = width;
    g.setLineDash(dash);
    g.beginPath();
    for (const f of faces) {
      g.moveTo(...this.toScreen(f.p));
      g.lineTo(...this.toScreen(f.q));
    }
    g.stroke();
    g.setLineDash([]);
  }

  drawPlan(g, moment) {
    const here = this.data.faces.filter((f) => f.s === moment.storey);
    this.strokeFaces(g, here, moment.dark ? "#9aa5b3" : "#39424e", 1.5);
    g.strokeStyle = moment.dark ? "#14181e" : "#fff"; // openings
    g.lineWidth = 2.5;
    for (const f of here)
      for (const [s0, s1, z0] of f.holes) {
        if (z0 > moment.floor + 0.3) continue;
        const d = Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1]) || 1, at = (s) => [f.p[0] + ((f.q[0] - f.p[0]) * s) / d, f.p[1] + ((f.q[1] - f.p[1]) * s) / d];
        g.beginPath();
        g.moveTo(...this.toScreen(at(s0)));
        g.lineTo(...this.toScreen(at(s1)));
        g.stroke();
      }
    if (moment.selected) this.strokeFaces(g, moment.selected.faces, "#E69F00", 4);
  }

  drawDeviations(g, moment) {
    for (const d of this.data.scene.deviations) {
      if (d.s !== moment.storey) continue;
      for (const [outline, colour, dash] of [[d.built, "#E8871E", []], [d.planned, "#7A4A9E", [5, 4]]]) {
        g.strokeStyle = colour;
        g.lineWidth = 2;
        g.setLineDash(dash);
        g.beginPath();
        outline.forEach((p, i) => (i ? g.lineTo(...this.toScreen(p.map((v) => v * 1e-3))) : g.moveTo(...this.toScreen(p.map((v) => v * 1e-3)))));
        g.closePath();
        g.stroke();
      }
    }
    g.setLineDash([]);
  }

  drawScan(g, moment) {
    const { points, count } = moment.cloud;
    for (let i = 0; i < count; ++i) {
      if (points[3 * i + 2] > moment.floor + 2.3) continue;
      const [x, y] = this.toScreen([points[3 * i], points[3 * i + 1]]);
      g.fillStyle = Plumb.colours.css([...moment.colours.subarray(3 * i, 3 * i + 3)]);
      g.fillRect(x - 1, y - 1, 2, 2);
    }
  }

  drawWalls(g, moment) {
    const hypothesis = moment.set && moment.set.hypotheses[0];
    if (!hypothesis) return;
    const faces = (right) => hypothesis.walls.filter((w) => w.right === right)
      .flatMap((w) => w.faces.map((id) => this.data.faces.find((f) => f.id === id)).filter(Boolean));
    this.strokeFaces(g, faces(true), "#009E73", 4);
    this.strokeFaces(g, faces(false), "#D55E00", 4, [6, 4]);
  }

  /** Lines from where what was seen stands to where it is taken to be. */
  drawDisplaced(g, moment) {
    g.strokeStyle = "#D55E00";
    g.lineWidth = 1.5;
    for (const [from, to] of moment.displaced) {
      g.beginPath();
      g.moveTo(...this.toScreen(from));
      g.lineTo(...this.toScreen(to));
      g.stroke();
    }
  }

  drawTracks(g, moment) {
    for (const [name, track] of Object.entries(this.data.tracks)) {
      if (moment.hidden.has(name)) continue;
      const method = this.data.run.methods.find((m) => m.name === name), colour = method ? method.colour : moment.dark ? "#fff" : "#111";
      if (!moment.off.has("paths")) {
        g.strokeStyle = colour;
        g.lineWidth = name === "truth" ? 2 : 1.5;
        g.beginPath();
        let before = -1;
        for (let i = 0; i <= moment.known[name]; ++i) {
          if (track.lost[i] > 0.5 || Math.abs(track.p[2][i] - this.data.run.base * 1e-3 - moment.floor) > 1.2) continue;
          const p = [track.p[0][i], track.p[1][i]];
          const joined = before >= 0 && track.t[i] - track.t[before] <= 1 && Math.hypot(p[0] - track.p[0][before], p[1] - track.p[1][before]) <= 1;
          if (joined) g.lineTo(...this.toScreen(p));
          else g.moveTo(...this.toScreen(p));
          before = i;
        }
        g.stroke();
      }
      const pose = moment.poses[name];
      if (pose && !moment.off.has("robots")) this.arrow(g, pose.p, Plumb.data.yawOf(pose.q), colour, name === "truth" ? 1.15 : 1);
    }
  }

  arrow(g, p, yaw, colour, scale) {
    const s = Math.max(0.45 * this.scale, 9) * scale;
    g.save();
    g.translate(...this.toScreen(p));
    g.rotate(-yaw);
    g.beginPath();
    g.moveTo(0.8 * s, 0);
    g.lineTo(-0.52 * s, -0.48 * s);
    g.lineTo(-0.24 * s, 0);
    g.lineTo(-0.52 * s, 0.48 * s);
    g.closePath();
    g.fillStyle = colour;
    g.fill();
    g.strokeStyle = "#fff";
    g.lineWidth = 1.5;
    g.stroke();
    g.restore();
  }

  pick(x, y, moment) {
    const p = this.toScene(x, y), reach = 8 / this.scale;
    let best = null, least = reach;
    for (const f of this.data.faces) {
      if (f.s !== moment.storey) continue;
      const d = Plumb.Residuals.prototype.toFace(f, p[0], p[1]);
      if (d < least) [best, least] = [f.wall, d];
    }
    return best;
  }

  camera6() { return [...this.centre, this.scale, 0, 0, 0].map((v) => Math.round(100 * v) / 100); }
  setCamera6(values) {
    this.placed = true;
    this.centre = values.slice(0, 2);
    this.scale = Math.min(2000, Math.max(2, values[2]));
  }
  onMove(callback) { this.moved.push(callback); }
};
