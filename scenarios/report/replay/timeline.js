// SPDX-License-Identifier: Apache-2.0
// The time line: states of localizations as bands, marks, errors of all methods as curves, the scans that the page holds.
// Drawn once on a canvas of its own, then copied with a cursor. No three.js.
"use strict";

Plumb.Timeline = class {
  static mostRows = 10; // of labels
  static pale = "#F3B183"; // beside vermilion

  constructor(canvas, data, seek) {
    this.canvas = canvas;
    this.data = data;
    this.hidden = new Set();
    this.method = "";
    this.t = 0;
    this.seek = seek;
    this.store = document.createElement("canvas");
    const follow = (event, snaps) => {
      const box = canvas.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
      const mark = snaps ? this.markAt(x, y) : null;
      seek(mark ? mark.t : this.timeOf(x));
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      this.down = event.clientX;
      follow(event, true);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (canvas.hasPointerCapture(event.pointerId) && Math.abs(event.clientX - this.down) > 3) follow(event, false);
      const box = canvas.getBoundingClientRect(), mark = this.markAt(event.clientX - box.left, event.clientY - box.top);
      canvas.style.cursor = mark ? "pointer" : "";
      canvas.title = mark ? mark.full : "";
      this.hover(event.clientX - box.left);
    });
    canvas.addEventListener("pointerleave", () => this.hover(null));
  }

  /** The mark whose label or line is under a place of the canvas, or null. */
  markAt(x, y) {
    const on = (m) => (x >= m.from && x <= m.to && y >= 15 * m.row && y < 15 * (m.row + 1)) || (Math.abs(x - this.x(m.t)) <= 3 && y >= 15 * m.row);
    return (this.marks || []).find(on) || null;
  }

  get beliefs() { return Object.entries(this.data.beliefs).filter(([name]) => !this.hidden.has(name)); }
  x(t) { return this.x0 + (this.x1 - this.x0) * (this.data.end > 0 ? t / this.data.end : 0); }
  timeOf(x) { return Math.min(this.data.end, Math.max(0, ((x - this.x0) / (this.x1 - this.x0)) * this.data.end)); }

  /** What is shown has changed, or the size: draws all again. */
  layout() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    this.width = Math.max(240, Math.floor(box.width));
    this.narrow = this.width < 520;
    this.x0 = 46;
    this.x1 = this.width - 12;
    const marks = (this.marks = this.placedMarks());
    this.marksHeight = 15 * (1 + marks.reduce((most, m) => Math.max(most, m.row), -1));
    this.bandsTop = this.marksHeight + 4;
    this.plotTop = this.bandsTop + 16 * this.beliefs.length + 6;
    this.plotBottom = this.plotTop + (this.narrow ? 70 : 96);
    this.height = this.plotBottom + 22;
    const ratio = Math.min(2, devicePixelRatio || 1);
    for (const canvas of [this.canvas, this.store]) {
      canvas.width = this.width * ratio;
      canvas.height = this.height * ratio;
    }
    this.canvas.style.height = this.height + "px";
    const g = this.store.getContext("2d");
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, this.width, this.height);
    const style = getComputedStyle(this.canvas);
    this.ink = style.getPropertyValue("--ink").trim();
    this.soft = style.getPropertyValue("--soft").trim();
    this.line = style.getPropertyValue("--line").trim();
    this.paper = style.getPropertyValue("--paper").trim();
    g.font = "11px system-ui, sans-serif";
    this.drawBands(g);
    this.drawErrors(g);
    this.drawScans(g);
    this.drawMarks(g, marks);
    this.draw(this.t);
  }

  drawBands(g) {
    this.beliefs.forEach(([name, belief], row) => {
      const y = this.bandsTop + 16 * row;
      belief.states.forEach(([t, state], i) => {
        const from = this.x(t * 1e-3), to = this.x(i + 1 < belief.states.length ? belief.states[i + 1][0] * 1e-3 : this.data.end);
        g.fillStyle = Plumb.colours.states[state];
        g.fillRect(from, y, Math.max(1, to - from), 13);
        const first = i === 0 || belief.states[i - 1][1] !== state;
        let end = i;
        while (end + 1 < belief.states.length && belief.states[end + 1][1] === state) ++end;
        const last = this.x(end + 1 < belief.states.length ? belief.states[end + 1][0] * 1e-3 : this.data.end);
        const wrong = this.wrongStretches(name).reduce((sum, [a, b]) => sum + Math.max(0, Math.min(b, last) - Math.max(a, from)), 0);
        const label = Plumb.data.states[state] + (wrong > 0.5 * (last - from) ? ", wrong" : "") + (this.beliefs.length > 1 ? " · " + name : "");
        if (!first) return;
        belief.labels = belief.labels || [];
        belief.labels.push([label, from, last, y]);
      });
      g.fillStyle = this.hatch(g);
      for (const [a, b] of this.wrongStretches(name)) g.fillRect(a, y, Math.max(1, b - a), 13);
      for (const [label, from, last, y2] of belief.labels || []) {
        const width = g.measureText(label).width;
        if (width + 8 >= last - from) continue;
        g.fillStyle = Plumb.Timeline.pale;
        if (label.includes(", wrong")) g.fillRect(from + 2, y2, width + 4, 13); // letters on strokes are hard to read
        g.fillStyle = "#111";
        g.fillText(label, from + 4, y2 + 10);
      }
      belief.labels = null;
    });
  }

  /** Where a method's answer was too far off, from and to in px: no state of its own says so. */
  wrongStretches(name) {
    const track = this.data.tracks[name], out = [];
    for (let i = 0; track && i < track.t.length; ++i) {
      if (!Plumb.data.isWrong(this.data, track, i)) continue;
      const next = i + 1 < track.t.length && track.t[i + 1] - track.t[i] <= 1.0 ? track.t[i + 1] : Math.min(this.data.end, track.t[i] + 0.1);
      const last = out[out.length - 1], from = this.x(track.t[i]), to = this.x(next);
      if (last && from <= last[1] + 0.01) last[1] = to;
      else out.push([from, to]);
    }
    return out;
  }

  /** Vermilion with pale strokes: told from LOST without colours, too. */
  hatch(g) {
    const tile = document.createElement("canvas"), t = tile.getContext("2d");
    tile.width = tile.height = 8;
    t.fillStyle = Plumb.colours.css(Plumb.colours.wrong);
    t.fillRect(0, 0, 8, 8);
    t.strokeStyle = Plumb.Timeline.pale;
    t.lineWidth = 2;
    for (const x of [-8, 0, 8]) {
      t.beginPath();
      t.moveTo(x - 1, 9);
      t.lineTo(x + 9, -1);
      t.stroke();
    }
    return g.createPattern(tile, "repeat");
  }

  /** Curves are cut off above four times what the median method reaches, so that a bad one does not flatten the rest; of each its
      99.5th percentile counts. As report.html has it. */
  scaleOf(tracks) {
    const extents = tracks.map((track) => track.e.filter((e, i) => track.lost[i] < 0.5).sort((a, b) => a - b)).filter((values) => values.length > 0)
      .map((values) => values[Math.floor(0.995 * (values.length - 1))]).sort((a, b) => a - b);
    if (extents.length === 0) return 0.01;
    const median = extents[(extents.length - 1) >> 1], most = extents[extents.length - 1];
    return Math.max(0.01, 1.1 * (median > 1e-3 ? Math.min(most, 4 * median) : most));
  }

  drawErrors(g) {
    const shown = Object.entries(this.data.tracks).filter(([name]) => name !== "truth" && !this.hidden.has(name));
    this.top = this.scaleOf(shown.map(([, track]) => track));
    const height = this.plotBottom - this.plotTop, y = (e) => this.plotBottom - height * Math.min(1, e / this.top);
    g.fillStyle = this.soft;
    g.strokeStyle = this.line;
    g.lineWidth = 1;
    g.textAlign = "right";
    const step = roundStep(this.top * 100, 4);
    for (let v = 0; v <= this.top * 100; v += step) {
      g.beginPath();
      g.moveTo(this.x0, y(v / 100));
      g.lineTo(this.x1, y(v / 100));
      g.stroke();
      g.fillText(String(+v.toFixed(2)), this.x0 - 6, y(v / 100) + 4);
    }
    g.save();
    g.translate(10, (this.plotTop + this.plotBottom) / 2);
    g.rotate(-Math.PI / 2);
    g.textAlign = "center";
    g.fillText("error, cm", 0, 0);
    g.restore();
    g.textAlign = "center";
    const seconds = roundStep(this.data.end, this.narrow ? 4 : 10);
    for (let t = 0; t <= this.data.end; t += seconds) g.fillText(+t.toFixed(2) + " s", this.x(t), this.plotBottom + 16);
    g.textAlign = "left";
    for (const [name, track] of shown) this.drawCurve(g, this.data.run.methods.find((m) => m.name === name), track, y);
  }

  drawCurve(g, method, track, y) {
    g.strokeStyle = method ? method.colour : this.ink;
    g.lineWidth = method && method.name === this.method ? 2.2 : 1.2;
    for (const lost of [false, true]) {
      g.setLineDash(lost ? [1, 3] : []);
      g.beginPath();
      let before = -1;
      for (let i = 0; i < track.t.length; ++i) {
        if (track.lost[i] > 0.5 !== lost) continue;
        const joined = before >= 0 && track.t[i] - track.t[before] <= 1.0;
        const px = this.x(track.t[i]), py = y(track.e[i]);
        if (joined) g.lineTo(px, py);
        else g.moveTo(px, py);
        before = i;
      }
      g.stroke();
    }
    g.setLineDash([]);
    g.fillStyle = g.strokeStyle;
    for (let i = 0, last = -1e9; i < track.t.length; ++i) { // where it leaves the scale
      const px = this.x(track.t[i]);
      if (track.e[i] <= this.top || px - last < 8) continue;
      last = px;
      g.beginPath();
      g.moveTo(px - 3, this.plotTop + 5);
      g.lineTo(px + 3, this.plotTop + 5);
      g.lineTo(px, this.plotTop);
      g.fill();
    }
  }

  drawScans(g) {
    g.fillStyle = this.soft;
    for (const t of this.data.scans.t) g.fillRect(this.x(t), this.plotBottom + 1, 0.8, 3);
  }

  /** Marks with the row that their label stands in: labels never lie over each other. One without a free row has its line alone. */
  placedMarks() {
    const g = this.store.getContext("2d"), ends = [];
    g.font = "11px system-ui, sans-serif";
    return this.data.run.marks.filter((m) => m.m === "" || !this.hidden.has(m.m)).map((mark) => {
      // What is cut off where there is no room is the end: when and which method stand first.
      const full = mark.t.toFixed(2) + " s" + (mark.m !== "" && this.data.run.methods.length > 1 ? " " + mark.m : "") + ": " + mark.label;
      let label = full;
      const x = this.x(mark.t), room = Math.max(this.x1 - x, x - 4) - 10;
      if (g.measureText(label).width > room) {
        while (label.length > 4 && g.measureText(label + "…").width > room) label = label.slice(0, -1);
        label += "…";
      }
      const width = g.measureText(label).width + 10, left = x + width > this.x1;
      const from = left ? x - width : x, to = left ? x : x + width;
      let row = 0;
      while (row < Plumb.Timeline.mostRows && (ends[row] || []).some(([a, b]) => from < b && to > a)) ++row;
      if (row === Plumb.Timeline.mostRows) return { ...mark, full, label: "", row: 0, left, from: x, to: x };
      (ends[row] = ends[row] || []).push([from, to]);
      return { ...mark, full, label, row, left, from, to };
    });
  }

  drawMarks(g, marks) {
    const bad = ["wrong", "lost", "failure", "gate", "far", "slip"];
    for (const mark of marks) {
      const x = this.x(mark.t), y = 15 * mark.row + 11;
      g.strokeStyle = g.fillStyle = bad.includes(mark.kind) ? getComputedStyle(this.canvas).getPropertyValue("--bad").trim() : this.ink;
      g.lineWidth = 1;
      g.beginPath();
      g.moveTo(x, y - 8);
      g.lineTo(x, this.plotBottom);
      g.globalAlpha = 0.5;
      g.stroke();
      g.globalAlpha = 1;
      g.textAlign = mark.left ? "right" : "left";
      g.fillText(mark.label, mark.left ? x - 4 : x + 4, y);
    }
    g.textAlign = "left";
  }

  draw(t) {
    this.t = t;
    if (!this.width) return;
    const g = this.canvas.getContext("2d"), ratio = this.canvas.width / this.width;
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, this.canvas.width, this.canvas.height);
    g.drawImage(this.store, 0, 0);
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.strokeStyle = this.ink;
    g.lineWidth = 2;
    g.beginPath();
    g.moveTo(this.x(t), 0);
    g.lineTo(this.x(t), this.plotBottom + 4);
    g.stroke();
    if (this.hoverX !== null && this.hoverX !== undefined) this.drawHover(g);
  }

  hover(x) {
    this.hoverX = x !== null && x >= this.x0 && x <= this.x1 ? x : null;
    this.draw(this.t);
  }

  /** Time and errors under the pointer. */
  drawHover(g) {
    const t = this.timeOf(this.hoverX), lines = [t.toFixed(1) + " s"];
    for (const [name, track] of Object.entries(this.data.tracks)) {
      if (name === "truth" || this.hidden.has(name)) continue;
      const now = Plumb.data.known(track, t);
      lines.push(name + ": " + (now ? (100 * now.e).toFixed(1) + " cm" + (now.lost ? ", says LOST" : "") : "no answer"));
    }
    g.font = "11px system-ui, sans-serif";
    const width = Math.max(...lines.map((l) => g.measureText(l).width)) + 12, height = 14 * lines.length + 6;
    const x = this.hoverX + width + 10 > this.width ? this.hoverX - width - 8 : this.hoverX + 8, y = Math.max(0, this.plotBottom - height);
    g.fillStyle = this.paper;
    g.strokeStyle = this.line;
    g.lineWidth = 1;
    g.fillRect(x, y, width, height);
    g.strokeRect(x, y, width, height);
    g.fillStyle = this.ink;
    lines.forEach((line, i) => g.fillText(line, x + 6, y + 14 * (i + 1)));
  }
};

/** A step of 1, 2 or 5 times a power of ten that divides a span into at most `count` parts. */
function roundStep(span, count) {
  if (!(span > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(span / count));
  for (const factor of [1, 2, 5]) if (factor * power >= (span / count) * (1 - 1e-9)) return factor * power;
  return 10 * power;
}
