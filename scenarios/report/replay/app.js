// SPDX-License-Identifier: Apache-2.0
// The page itself: controls, the moment that is shown, links, keys. Names reach it as text only.
"use strict";

/** An element with attributes and children; text is never markup. */
Plumb.make = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "on") for (const [event, handler] of Object.entries(value)) element.addEventListener(event, handler);
    else if (key === "style") for (const [name, text] of Object.entries(value)) element.style.setProperty(name, text);
    else if (value === true) element.setAttribute(key, "");
    else if (value !== false && value !== null) element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
};

/** A name that may break behind its underscores. */
Plumb.breakable = (name) => name.split(/(?<=_)/).flatMap((part, i) => (i ? [document.createElement("wbr"), part] : [part]));

/** How far off an answer is. */
Plumb.offText = (pose) => !pose ? "no answer" : pose.lost ? "says LOST" : (pose.e < 1 ? (100 * pose.e).toFixed(1) + " cm" : pose.e.toFixed(2) + " m") + " off";

/** Names of rooms, hypotheses and robots over the picture, none over another. */
Plumb.placeLabels = (layer, moment, project) => {
  const placed = [], half = (text) => 3.6 * text.length + 4; // px
  let used = 0;
  const put = (text, p, kind) => {
    const at = project(p), { clientWidth: width, clientHeight: height } = layer;
    if (!at || at[0] < 0 || at[1] < 0 || at[0] > width || at[1] > height) return;
    const side = Math.min(half(text) + 0.4 * text.length, width / 2); // what is near the edge stays whole
    at[0] = Math.min(width - side, Math.max(side, at[0]));
    at[1] = Math.min(height - 9, Math.max(9, at[1]));
    if ( placed.some(([x, y, other]) => Math.abs(y - at[1]) < 16 && Math.abs(x - at[0]) < half(text) + half(other))) return;
    placed.push([...at, text]);
    let span = layer.children[used];
    if (!span) layer.append((span = document.createElement("span")));
    ++used;
    if (span.textContent !== text) span.textContent = text;
    span.className = "label " + kind;
    span.style.transform = "translate(" + at[0].toFixed(1) + "px," + at[1].toFixed(1) + "px) translate(-50%,-50%)";
    span.style.display = "";
  };
  if (!moment.off.has("labels")) {
    if (moment.set && !moment.off.has("hypotheses"))
      moment.set.hypotheses.forEach((h, i) =>
        put("#" + (i + 1) + " " + Math.round(100 * h.share) + " %" + (h.room ? " " + h.room : ""), [h.p[0], h.p[1], h.p[2] + 0.4], "hypothesis"));
    for (const room of moment.rooms) put(room.name, room.middle, "room");
  }
  for (let i = used; i < layer.children.length; ++i) layer.children[i].style.display = "none";
};

Plumb.App = class {
  constructor(data) {
    this.data = data;
    this.t = data.scans.count ? data.scans.t[0] : 0; // before the first scan there is nothing to see
    this.m = "";
    this.at = "truth"; // whose pose the scan is drawn at: truth, or the chosen method
    this.colouring = "height";
    this.storey = "auto";
    this.lift = 1;
    this.off = new Set(["graph", "plangraph", "map"]);
    this.hidden = new Set();
    this.selected = null;
    this.playing = 0;
    this.residuals = new Plumb.Residuals(data.faces, data.storeys);
    if (Plumb.colours.dark()) for (const method of data.run.methods) method.colour = method.dark;
    this.beside = new Plumb.Beside(this);
    this.preferMethod();
    this.addMarks();
  }

  /** Where a wrong answer began to slide, of methods that name no walls, and where an answer was on another storey. */
  addMarks() {
    const { data } = this, { marks } = data.run;
    for (const [name, track] of Object.entries(data.tracks)) {
      const wrong = marks.find((m) => m.m === name && m.kind === "wrong");
      if (name === "truth" || !wrong) continue;
      let i = Plumb.data.lastAt(track.t, wrong.t);
      if (!this.namesWalls(name)) {
        while (i > 0 && track.e[i - 1] >= this.wrongFrom && track.lost[i - 1] < 0.5) --i;
        if (i >= 0 && wrong.t - track.t[i] > 0.05) marks.push({ t: track.t[i], label: "off by more than " + this.wrongFrom + " m", kind: "wrong", m: name });
      }
      for (let k = 0; k < track.t.length; ++k) {
        const truth = Plumb.data.isWrong(data, track, k) ? Plumb.data.known(data.tracks.truth, track.t[k]) : null;
        if (!truth || this.storeyOf(Plumb.data.poseAt(track, k)) === this.storeyOf(truth)) continue;
        marks.push({ t: track.t[k], label: "on the wrong storey", kind: "wrong", m: name });
        break;
      }
    }
    marks.sort((a, b) => a.t - b.t);
  }

  get wrongFrom() { return 0.2; } // m; twice what points may lie off a wall

  preferMethod() {
    const methods = this.data.run.methods;
    const chosen = methods.find((m) => this.data.beliefs[m.name]) || methods[methods.length - 1];
    this.m = chosen ? chosen.name : "";
  }

  get method() { return this.data.run.methods.find((m) => m.name === this.m); }

  // ---- the page

  build(root) {
    const make = Plumb.make, run = this.data.run;
    document.title = run.name + " · replay";
    const failed = run.gates.filter((g) => !g.passed);
    const badge = run.gates.length === 0 ? ["no gates", ""] : failed.length ? ["FAIL", "bad"] : ["PASS, " + run.gates.length + (run.gates.length === 1 ? " gate" : " gates"), "good"];
    this.canvas = make("canvas", { id: "view", tabindex: "0", role: "img",
      "aria-label": "The building and the robot at the chosen time. Arrow keys step through the scans; ? lists all keys." });
    this.labels = make("div", { id: "labels", "aria-hidden": "true" });
    this.line = make("canvas", { id: "line", role: "img", "aria-label": "States, marks and position errors over time" });
    this.status = make("p", { id: "status", role: "status", "aria-live": "polite", "aria-label": "what is shown" });
    this.wrong = make("div", { id: "wrong" });
    this.caption = make("p", { id: "caption" });
    this.picture = make("div", { id: "picture" }, this.canvas, this.labels, this.caption);
    this.pictures = make("div", { id: "pictures" }, this.picture);
    root.append(
      make("header", {}, make("h1", {}, run.name), make("span", { class: "badge " + badge[1] }, badge[0]),
        make("span", { class: "facts" }, "seed " + run.seed + " · " + this.data.end.toFixed(1) + " s · digest " + run.digest),
        ...failed.slice(0, 3).map((gate) => make("span", { class: "bad" }, this.gateLink(gate))),
        ...(failed.length > 3 ? [make("span", { class: "bad" }, "and " + (failed.length - 3) + " more under Gates")] : []),
        ...run.unjudged.map((one) => make("a", { class: "badge bad", href: "#m=" + encodeURIComponent(one.m) }, one.text)),
        make("a", { href: "report.html" }, "report")),
      make("main", {}, make("div", { id: "left" }, this.pictures, this.bar(), make("div", { id: "linebox" }, this.line)), this.panel()),
      this.help());
    if (run.failure) root.querySelector("header").append(make("span", { class: "badge bad" }, "the scenario failed: " + run.failure));
  }

  /** What a gate says, as a link to the moment at which its method failed. */
  gateLink(gate) { return gate.link ? Plumb.make("a", { href: gate.link }, gate.text) : gate.text; }

  bar() {
    const make = Plumb.make;
    this.playButton = make("button", { type: "button", id: "play", on: { click: () => this.togglePlay() } }, "Play");
    this.slider = make("input", { type: "range", id: "time", min: "0", max: String(this.data.end), step: "any", "aria-label": "time, seconds",
      on: { input: () => this.seek(+this.slider.value) } });
    this.clock = make("output", { id: "clock" });
    this.speed = make("select", { id: "speed", "aria-label": "speed" }, ...[0.5, 1, 2, 5, 10].map((v) => make("option", { value: v, selected: v === 1 }, "× " + v)));
    const step = (text, label, by) => make("button", { type: "button", "aria-label": label, title: label, on: { click: () => this.step(by) } }, text);
    const keys = make("button", { type: "button", id: "keys", "aria-label": "keys", title: "keys (?)", on: { click: () => this.helpBox.showModal() } }, "?");
    return make("div", { id: "bar" }, this.playButton, step("◀", "scan before", -1), step("▶", "next scan", 1), this.slider, this.clock, this.speed, keys);
  }

  start(root) {
    this.build(root);
    try {
      if (Plumb.without3d) throw new Error("switched off");
      this.view = new Plumb.View3d(this.canvas, this.data, this.labels);
      document.body.dataset.view = "3d";
      this.canvas.addEventListener("webglcontextlost", (event) => {
        event.preventDefault();
        this.fall("The graphics card dropped the picture; this is the plan from above.");
      });
    } catch {
      this.fall("This browser shows no WebGL; this is the plan from above.");
    }
    this.bind();
    this.line2 = new Plumb.Timeline(this.line, this.data, (t) => this.seek(t));
    this.resize();
    this.readLink();
    this.beside.start();
    this.line2.layout();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.line2.layout(); this.update(); });
    new ResizeObserver(() => this.resize()).observe(this.picture);
    return this.update();
  }

  /** Without WebGL, or when it is lost: a new canvas, since one that had a context of another kind gives none. */
  fall(why) {
    const canvas = this.canvas.cloneNode(false);
    this.canvas.replaceWith(canvas);
    this.canvas = canvas;
    this.view = new Plumb.View2d(canvas, this.data, this.labels);
    document.body.dataset.view = "2d";
    this.picture.prepend(Plumb.make("p", { class: "note" }, why));
    if (this.line2) {
      this.bindPicture();
      this.resize();
      this.update();
    }
  }

  bind() {
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("hashchange", () => { if (location.hash !== this.address) { this.readLink(); this.update(); } });
    this.bindPicture();
  }

  bindPicture() {
    let down = null;
    this.canvas.addEventListener("pointerdown", (e) => { down = [e.clientX, e.clientY]; });
    this.canvas.addEventListener("pointerup", (e) => {
      if (!down || Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return;
      const box = this.canvas.getBoundingClientRect();
      this.select(this.view.pick(e.clientX - box.left, e.clientY - box.top, this.moment) || "");
    });
    this.view.onMove(() => { this.dirty(); this.beside.moved(); });
  }

  resize() {
    const box = this.picture.getBoundingClientRect();
    if (box.width < 10 || box.height < 10) return;
    if (this.sized && this.sized[0] === box.width && this.sized[1] === box.height) return;
    this.sized = [box.width, box.height];
    this.view.resize(box.width, box.height);
    if (!this.view.placed) this.view.home(this.moment ? this.moment.storey : 0); // until someone moves it
    this.line2.layout();
    this.dirty();
  }

  // ---- what is shown

  seek(t) {
    this.t = Math.min(this.data.end, Math.max(0, t));
    return this.update();
  }

  step(by) {
    const scans = this.data.scans, i = scans.nearest(this.t);
    if (i < 0) return this.seek(this.t + 0.1 * by);
    return this.seek(scans.t[Math.min(scans.count - 1, Math.max(0, i + by))]);
  }

  choose(name) {
    this.m = name;
    this.beside.chosen();
    this.line2.method = name;
    this.line2.layout();
    for (const box of document.querySelectorAll("input[name=method]")) box.checked = box.value === name;
    return this.update();
  }

  show(name, visible) {
    if (visible) this.hidden.delete(name);
    else this.hidden.add(name);
    this.line2.hidden = this.hidden;
    this.line2.layout();
    return this.update();
  }

  layer(key, visible) {
    if (visible) this.off.delete(key);
    else this.off.add(key);
    for (const box of document.querySelectorAll("input[data-layer]")) if (box.dataset.layer === key) box.checked = visible;
    return this.update();
  }

  select(id) {
    this.selected = id || null;
    this.search.value = id || "";
    return this.update();
  }

  /** Storey of the true pose, of the method's, or the one chosen. */
  storeyNow(poses) {
    if (this.storey === "method" && poses[this.m]) return this.storeyOf(poses[this.m]);
    if (this.storey !== "auto" && this.storey !== "method") return Math.min(+this.storey, this.data.storeys.length - 1);
    return this.storeyOf(poses.truth || Plumb.data.poseAt(this.data.tracks.truth, 0));
  }

  storeyOf(pose) {
    const floor = pose.p[2] - this.data.run.base * 1e-3;
    let best = 0;
    this.data.storeys.forEach((s, i) => { if (Math.abs(s.z - floor) < Math.abs(this.data.storeys[best].z - floor)) best = i; });
    return best;
  }

  /** Everything about time t but the scan. */
  momentAt(t) {
    const { data } = this, poses = {}, known = {};
    for (const [name, track] of Object.entries(data.tracks)) {
      poses[name] = Plumb.data.known(track, t);
      known[name] = Plumb.data.lastAt(track.t, t);
    }
    const storey = this.storeyNow(poses), belief = this.hidden.has(this.m) ? null : data.beliefs[this.m];
    const floor = data.storeys[storey] ? data.storeys[storey].z : 0;
    const rooms = data.rooms.filter((r) => r.s === storey && r.at.length).map((r) => {
      const sum = r.at.reduce((a, p) => [a[0] + p[0], a[1] + p[1]], [0, 0]);
      return { name: r.name, middle: [sum[0] / r.at.length, sum[1] / r.at.length, floor + 0.1] };
    });
    const set = belief ? Plumb.data.setAt(belief, t) : null;
    const displaced = [], middle = (p) => [(p[0] + p[2]) / 2, (p[1] + p[3]) / 2]; // what is taken for something else: from, to
    const truth = set && Plumb.data.known(data.tracks.truth, set.t);
    if (truth && set.hypotheses[0])
      for (const w of set.hypotheses[0].walls) if (!w.right) displaced.push([middle(Plumb.data.patchFrom(w.patch, set.hypotheses[0], truth)), middle(w.patch)]);
    return {
      t, poses, known, storey, displaced, floor, rooms, off: this.off, hidden: this.hidden, dark: Plumb.colours.dark(), lift: this.lift,
      colour: this.method ? this.method.colour : "#0072B2",
      state: belief ? Plumb.data.stateAt(belief, t) : null,
      set,
      particles: belief ? Plumb.data.particlesAt(belief, t) : null,
      graph: this.off.has("graph") ? null : data.graphs[this.m] || null,
      plangraph: this.off.has("plangraph") ? null : data.plangraph,
      selected: this.selected ? { id: this.selected, faces: data.faces.filter((f) => f.wall === this.selected) } : null,
    };
  }

  /** The kept scan nearest to t, at the pose of the truth or of the method. */
  async cloudAt(t) {
    const { data } = this, i = data.scans.nearest(t);
    if (i < 0) return null;
    const ranges = await data.scans.ranges(i);
    const track = this.at === "method" && data.tracks[this.m] ? data.tracks[this.m] : data.tracks.truth;
    const poses = Plumb.data.sweepPoses(track, data.scans.t[i], data.scans.span);
    if (!poses) return { index: i, cloud: null };
    return { index: i, cloud: data.scans.points(i, ranges, ...poses) };
  }

  /** Shows the state as it is now; a later call overtakes an earlier one. */
  async update() {
    const turn = (this.turn = (this.turn || 0) + 1), moment = this.momentAt(this.t);
    const scan = await this.cloudAt(this.t);
    if (turn !== this.turn) return;
    moment.map = this.off.has("map") ? null : await Plumb.data.mapOf(this.data, this.m);
    if (turn !== this.turn) return;
    moment.scan = scan ? scan.index : -1;
    moment.cloud = scan ? scan.cloud : null;
    moment.confused = await this.confusedAt(moment);
    if (turn !== this.turn) return;
    if (moment.confused) moment.displaced = moment.confused.rows.map((row) => [row.from, row.to]);
    if (moment.cloud) {
      moment.residuals = this.colouring === "residual" || this.selected ? this.residuals.of(moment.cloud.points, moment.cloud.count) : null;
      moment.colours = this.colouring === "element" ? Plumb.colours.ofElements(this.residuals.owners(moment.cloud.points, moment.cloud.count))
        : Plumb.colours.ofPoints(this.colouring, moment.cloud, moment.floor, this.data.scans.rings, moment.residuals);
    }
    this.moment = moment;
    this.changed = true;
    this.writeNumbers(moment);
    this.line2.draw(this.t);
    this.writeLink();
    return new Promise((done) => {
      (this.waiting = this.waiting || []).push(done);
      this.dirty();
    });
  }

  dirty() {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      if (!this.moment) return;
      if (this.follow && this.moment.poses.truth) this.followRobot(this.moment.poses.truth);
      if (!this.view.placed && this.homeOf !== this.moment.storey) this.view.home((this.homeOf = this.moment.storey));
      this.view.draw(this.moment, this.changed);
      if (this.changed) this.writeLink();
      this.changed = false;
      document.body.dataset.ready = "1";
      (this.waiting || []).forEach((done) => done());
      this.waiting = [];
    });
  }

  followRobot(pose) {
    const now = this.view.camera6();
    if (this.view.controls)
      this.view.setCamera6([now[0] + pose.p[0] - now[3], now[1] + pose.p[1] - now[4], now[2] + pose.p[2] - now[5], ...pose.p]);
    else this.view.centre = pose.p.slice(0, 2);
  }

  cycle(id) {
    const list = document.getElementById(id);
    list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
    list.dispatchEvent(new Event("change"));
  }

  nextMethod() {
    const names = this.data.run.methods.map((m) => m.name);
    if (names.length) this.choose(names[(names.indexOf(this.m) + 1) % names.length]);
  }

  changeStorey(by) {
    const now = this.moment.storey, next = Math.min(this.data.storeys.length - 1, Math.max(0, now + by));
    document.getElementById("storey").value = this.storey = String(next);
    this.update();
  }

  togglePlay() {
    this.playing = this.playing ? 0 : performance.now();
    this.playButton.textContent = this.playing ? "Pause" : "Play";
    if (!this.playing) return;
    if (this.t >= this.data.end - 0.05) this.t = 0;
    const begin = { t: this.t, at: performance.now() };
    const tick = async () => {
      if (!this.playing) return;
      begin.t += ((performance.now() - begin.at) / 1000) * +this.speed.value;
      begin.at = performance.now();
      await this.seek(begin.t);
      if (this.t >= this.data.end) this.togglePlay();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
};
