// SPDX-License-Identifier: Apache-2.0
// What the page says of a chosen element: its id, who matched it, how far the scans are from it over the run.
"use strict";

Object.assign(Plumb.App.prototype, {
  /** What is taken for what now: by the first hypothesis' own matches, or, where a method names none, by the scan. */
  writeWrong(moment) {
    const pairs = moment.confused || this.wrongMatches(moment), key = JSON.stringify(pairs);
    if (this.wrongKey === key) return;
    this.wrongKey = key;
    document.body.dataset.wrong = pairs ? pairs.rows.map((row) => row.taken).join(" ") : "";
    if (!pairs || pairs.rows.length === 0) return this.wrong.replaceChildren();
    const make = Plumb.make, link = (id) => make("button", { type: "button", class: "link", on: { click: () => this.select(id) } }, id);
    this.wrong.replaceChildren(make("p", {}, pairs.title), make("table", { "aria-label": "walls that are taken for others" },
      make("thead", {}, make("tr", {}, make("th", {}, "taken for"), make("th", {}, "truly"))),
      make("tbody", {}, ...pairs.rows.map((row) => make("tr", {}, make("td", {}, link(row.taken), row.patches > 1 ? " (" + row.patches + " patches)" : ""),
        make("td", {}, row.built ? link(row.truly) : row.truly === row.taken ? "the same, elsewhere on it" : row.truly ? link(row.truly) : "no wall of the plan", row.built ? ", built otherwise" : ""))))));
  },

  /** Whether a method ever says which walls it matched. */
  namesWalls(name) {
    const belief = this.data.beliefs[name];
    return !!belief && belief.sets.some((set) => set[2].some((h) => h[7].length > 0));
  },

  wrongMatches(moment) {
    const hypothesis = moment.set && moment.set.hypotheses[0];
    if (!hypothesis || hypothesis.walls.length === 0) return null;
    const byId = new Map(this.data.faces.map((f) => [f.id, f.wall])), rows = [];
    for (const w of hypothesis.walls) {
      const taken = w.right ? null : w.faces.map((id) => byId.get(id)).find(Boolean);
      const same = rows.find((row) => row.taken === taken && row.truly === w.seen);
      if (same) ++same.patches;
      else if (taken) rows.push({ taken, truly: w.seen, patches: 1 });
    }
    return { title: "Matched wrongly at " + moment.set.t.toFixed(2) + " s:", rows };
  },

  /** For a method that names no walls: what the scan lies on at its pose, and what at the true one. Most points first. */
  async confusedAt(moment) {
    const pose = moment.poses[this.m];
    if (this.namesWalls(this.m) || this.hidden.has(this.m) || !pose || pose.lost || pose.e < this.wrongFrom || moment.scan < 0) return null;
    const { scans, tracks } = this.data, ranges = await scans.ranges(moment.scan);
    const clouds = [tracks[this.m], tracks.truth].map((track) => Plumb.data.sweepPoses(track, scans.t[moment.scan], scans.span))
      .map((poses) => poses && scans.points(moment.scan, ranges, ...poses));
    if (!clouds[0] || !clouds[1]) return null;
    const [at, truly] = clouds.map((cloud) => this.residuals.owners(cloud.points, cloud.count)), pairs = new Map();
    let walls = 0;
    truly.forEach((owner, i) => {
      const built = owner === -2 ? this.builtAt(clouds[1].points[3 * i], clouds[1].points[3 * i + 1], moment.storey) : null;
      if (owner < 0 && !built) return;
      ++walls;
      if (at[i] < 0 || at[i] === owner) return;
      const seen = built ? built.id : this.residuals.names[owner], key = at[i] + " " + owner + " " + seen;
      const pair = pairs.get(key) || { n: 0, taken: this.residuals.names[at[i]], truly: seen, built: !!built, from: [0, 0], to: [0, 0] };
      pairs.set(key, pair);
      ++pair.n;
      for (const k of [0, 1]) {
        pair.from[k] += clouds[1].points[3 * i + k];
        pair.to[k] += clouds[0].points[3 * i + k];
      }
    });
    const rows = [...pairs.values()].filter((pair) => pair.n >= 0.03 * walls).sort((a, b) => b.n - a.n).slice(0, 5);
    for (const row of rows) for (const end of [row.from, row.to]) end.forEach((sum, k) => { end[k] = sum / row.n; });
    return { title: this.m + " names no walls. At its pose the scan of " + scans.t[moment.scan].toFixed(2) + " s lies on others; most points first:", rows };
  },

  /** The deviation as built that a point of a storey lies on, in the plane, or null. */
  builtAt(x, y, storey) {
    const reach = Plumb.Residuals.most;
    return this.data.scene.deviations.find((d) => d.s === storey && d.id && d.built.some((p, k) => {
      const [a, b] = [p, d.built[(k + 1) % d.built.length]].map((corner) => corner.map((v) => v * 1e-3));
      return this.residuals.toFace({ p: a, q: b }, x, y) < reach;
    })) || null;
  },

  /** What is known of the chosen element now. */
  writeSelection(moment) {
    const make = Plumb.make;
    if (!moment.selected) {
      this.about.replaceChildren(make("p", { class: "soft" }, "Click a wall: its id, what matched it, how far the scan is from it."));
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
        .forEach((w) => lines.push("matched by hypothesis #" + (i + 1) + " of " + this.m + ", "
          + (w.right ? "rightly" : "wrongly: truly " + (w.seen || "no wall of the plan")))));
    for (const row of moment.confused ? moment.confused.rows : []) {
      if (row.taken === id) lines.push("at the pose of " + this.m + " what is seen of " + row.truly + " lies on it");
      if (row.truly === id) lines.push("at the pose of " + this.m + " what is seen of it lies on " + row.taken);
    }
    for (const d of this.data.scene.deviations) if (d.id === id) lines.push(d.text);
    this.about.replaceChildren(...[...new Set(lines)].map((text) => make("p", {}, text)));
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
