// SPDX-License-Identifier: Apache-2.0
// What the page says of a chosen element: its id, who matched it, how far the scans are from it over the run.
"use strict";

Object.assign(Plumb.App.prototype, {
  /** Walls that the first hypothesis matches wrongly now, to be clicked. */
  writeWrong(moment) {
    const walls = moment.set && moment.set.hypotheses[0] ? moment.set.hypotheses[0].walls.filter((w) => !w.right) : [];
    const byId = new Map(this.data.faces.map((f) => [f.id, f.wall]));
    const ids = [...new Set(walls.flatMap((w) => w.faces.map((id) => byId.get(id))).filter(Boolean))].sort(), key = ids.join("\n");
    if (this.wrongKey === key) return;
    this.wrongKey = key;
    document.body.dataset.wrong = ids.join(" ");
    if (ids.length === 0) return this.wrong.replaceChildren();
    this.wrong.replaceChildren("matched wrongly: ", ...ids.map((id) => Plumb.make("button", { type: "button", class: "link", on: { click: () => this.select(id) } }, id)));
  },

  /** What is known of the chosen element now. */
  writeSelection(moment) {
    const make = Plumb.make;
    if (!moment.selected) {
      this.about.replaceChildren(make("p", { class: "soft" }, "Click a wall to see its id, what matched it, and how far the scan is from it."));
      return;
    }
    const { id, faces } = moment.selected, element = this.data.scene.elements.find((e) => e[0] === id), lines = [];
    if (!element && faces.length === 0) lines.push("'" + id + "' is no element of this building.");
    else {
      const storey = element ? this.data.storeys[element[2]] : null;
      lines.push((element ? element[1] : "wall") + " " + id + (storey ? ", storey " + storey.name : ""));
    }
    if (faces.length && moment.cloud) {
      const near = this.residuals.ofFaces(faces, moment.cloud.points, moment.cloud.count);
      lines.push(near.count ? near.count + " points within 0.5 m, median " + (100 * near.median).toFixed(1) + " cm from it" : "no point within 0.5 m now");
    }
    const ids = new Set(faces.map((f) => f.id));
    if (moment.set)
      moment.set.hypotheses.forEach((h, i) => h.walls.filter((w) => w.faces.some((f) => ids.has(f)))
        .forEach((w) => lines.push("matched by hypothesis #" + (i + 1) + " of " + this.m + ", " + (w.right ? "rightly" : "wrongly"))));
    for (const d of this.data.scene.deviations) if (d.id === id) lines.push(d.text);
    this.about.replaceChildren(...lines.map((text) => make("p", {}, text)));
    if (faces.length) this.about.append(this.history(id, faces));
    document.body.dataset.selected = id;
  },

  /** Median distance of the scans to a wall over the run, from up to 80 of them; measured in the background. */
  history(id, faces) {
    const key = id + " " + this.at + " " + (this.at === "method" ? this.m : "");
    if (!this.past || this.past.key !== key) {
      const canvas = Plumb.make("canvas", { width: 290, height: 64, role: "img", "aria-label": "distance of the scan to " + id + " over time" });
      this.past = { key, canvas, points: [] };
      this.measure(this.past, faces);
    }
    this.drawHistory(this.past);
    return this.past.canvas;
  },

  async measure(past, faces) {
    const { scans, tracks } = this.data, n = Math.min(80, scans.count), track = this.at === "method" ? tracks[this.m] : tracks.truth;
    for (let k = 0; k < n && this.past === past; ++k) {
      const i = Math.floor(((k + 0.5) * scans.count) / n), poses = Plumb.data.sweepPoses(track, scans.t[i], scans.span);
      if (!poses) continue;
      const cloud = scans.points(i, await scans.ranges(i), ...poses), near = this.residuals.ofFaces(faces, cloud.points, cloud.count);
      if (near.count >= 5) past.points.push([scans.t[i], near.median]);
      if (k % 8 === 7 || k === n - 1) this.drawHistory(past);
      await new Promise((done) => setTimeout(done, 0));
    }
  },

  drawHistory(past) {
    const g = past.canvas.getContext("2d"), { width, height } = past.canvas, style = getComputedStyle(document.body), top = 0.2;
    g.clearRect(0, 0, width, height);
    g.font = "10px system-ui, sans-serif";
    g.fillStyle = style.getPropertyValue("--soft");
    g.fillText("20 cm", 0, 9);
    g.fillText("0", 18, height - 2);
    const x = (t) => 32 + (width - 34) * (this.data.end > 0 ? t / this.data.end : 0), y = (d) => height - 3 - (height - 8) * Math.min(1, d / top);
    g.fillStyle = style.getPropertyValue("--ink");
    for (const [t, d] of past.points) g.fillRect(x(t) - 1.5, y(d) - 1.5, 3, 3);
    g.fillRect(x(this.t), 0, 1, height);
  },
});
