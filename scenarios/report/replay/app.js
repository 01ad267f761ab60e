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

/** Names of rooms, hypotheses and robots over the picture, none nearer than 40 px to another. */
Plumb.placeLabels = (layer, moment, project) => {
  const placed = [];
  let used = 0;
  const put = (text, p, kind) => {
    const at = project(p);
    if (!at || placed.some(([x, y]) => Math.abs(x - at[0]) < 64 && Math.abs(y - at[1]) < 16)) return;
    placed.push(at);
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
    this.t = 0;
    this.m = "";
    this.at = "truth"; // whose pose the scan is drawn at: truth, or the chosen method
    this.colouring = "height";
    this.storey = "auto";
    this.lift = 1;
    this.off = new Set(["graph", "labels3d"]);
    this.hidden = new Set();
    this.selected = null;
    this.playing = 0;
    this.residuals = new Plumb.Residuals(data.faces, data.storeys);
    if (Plumb.colours.dark()) for (const method of data.run.methods) method.colour = method.dark;
    this.preferMethod();
  }

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
    const badge = run.gates.length === 0 ? ["no gates", ""] : failed.length ? ["FAIL", "bad"] : ["PASS", "good"];
    this.canvas = make("canvas", { id: "view", tabindex: "0", role: "img",
      "aria-label": "The building and the robot at the chosen time. Arrow keys step through the scans; ? lists all keys." });
    this.labels = make("div", { id: "labels", "aria-hidden": "true" });
    this.line = make("canvas", { id: "line", role: "img", "aria-label": "States, marks and position errors over time" });
    this.status = make("p", { id: "status", role: "status", "aria-live": "polite" });
    this.picture = make("div", { id: "picture" }, this.canvas, this.labels);
    root.append(
      make("header", {}, make("h1", {}, run.name), make("span", { class: "badge " + badge[1] }, badge[0]),
        make("span", { class: "facts" }, "seed " + run.seed + " · " + this.data.end.toFixed(1) + " s · digest " + run.digest),
        make("a", { href: "report.html" }, "report")),
      make("main", {}, make("div", { id: "left" }, this.picture, this.bar(), make("div", { id: "linebox" }, this.line)), this.panel()),
      this.help());
    if (run.failure) root.querySelector("header").append(make("span", { class: "badge bad" }, "the scenario failed: " + run.failure));
  }

  bar() {
    const make = Plumb.make;
    this.playButton = make("button", { type: "button", id: "play", on: { click: () => this.togglePlay() } }, "Play");
    this.slider = make("input", { type: "range", id: "time", min: "0", max: String(this.data.end), step: "any", "aria-label": "time, seconds",
      on: { input: () => this.seek(+this.slider.value) } });
    this.clock = make("output", { id: "clock" });
    this.speed = make("select", { id: "speed", "aria-label": "speed" }, ...[0.5, 1, 2, 5, 10].map((v) => make("option", { value: v, selected: v === 1 }, "× " + v)));
    const step = (text, label, by) => make("button", { type: "button", "aria-label": label, title: label, on: { click: () => this.step(by) } }, text);
    return make("div", { id: "bar" }, this.playButton, step("◀", "scan before", -1), step("▶", "next scan", 1), this.slider, this.clock, this.speed);
  }

  panel() {
    const make = Plumb.make, run = this.data.run;
    const rows = [["truth", "#111111", ""], ...run.methods.map((m) => [m.name, m.colour, m.verdict])].map(([name, colour, verdict]) => {
      const box = make("input", { type: "checkbox", checked: true, "data-method": name, "aria-label": "show " + name,
        on: { change: () => this.show(name, box.checked) } });
      const now = make("span", { class: "now", "data-now": name });
      const pick = name === "truth" ? make("span") : make("input", { type: "radio", name: "method", value: name, checked: name === this.m,
        "aria-label": "look at " + name, on: { change: () => this.choose(name) } });
      return make("tr", { class: verdict ? "" : "truth" }, make("td", {}, box), make("td", {}, pick),
        make("td", {}, make("i", { class: "swatch", style: { background: name === "truth" ? "var(--ink)" : colour } }), name,
          verdict ? make("small", {}, " " + verdict) : ""), make("td", {}, now));
    });
    const select = (id, label, options, value, change) => {
      const list = make("select", { id, on: { change: () => change(list.value) } },
        ...options.map(([v, text]) => make("option", { value: v, selected: v === value }, text)));
      return make("label", {}, label + " ", list);
    };
    this.layers = [["building", "building"], ["scan", "scan"], ["paths", "paths"], ["robots", "robots"], ["particles", "particles"],
      ["hypotheses", "hypotheses"], ["walls", "matched walls"], ["graph", "situational graph"], ["deviations", "deviations"], ["labels", "names"]];
    const layers = this.layers.map(([key, text], i) => make("label", { class: "layer" }, make("input", { type: "checkbox", "data-layer": key,
      checked: !this.off.has(key), on: { change: (e) => this.layer(key, e.target.checked) } }), (i + 1) % 10 + " " + text));
    this.about = make("div", { id: "about" });
    this.legend = make("div", { id: "legend" });
    this.command = make("code", { id: "command" });
    const gates = run.gates.map((g) => make("li", { class: g.passed ? "good" : "bad" }, (g.passed ? "passed: " : "FAILED: ") + g.text + " ",
      g.link ? make("a", { href: g.link }, "look") : ""));
    return make("aside", {},
      make("section", {}, make("h2", {}, "Methods"), make("table", {}, make("thead", {}, make("tr", {}, make("th", {}, "show"), make("th", {}, "look at"),
        make("th", {}, "name"), make("th", {}, "now"))), make("tbody", {}, ...rows)), this.status),
      make("section", {}, make("h2", {}, "Scan"),
        select("pose", "drawn at the pose of", [["truth", "the truth"], ["method", "the method looked at"]], this.at, (v) => { this.at = v; this.update(); }),
        select("colouring", "coloured by", [["height", "height"], ["ring", "ring"], ["residual", "distance to the plan"]], this.colouring,
          (v) => { this.colouring = v; this.update(); }), this.legend),
      make("section", {}, make("h2", {}, "Layers"), make("div", { class: "layers" }, ...layers),
        select("storey", "storey", [["auto", "follow the robot"], ...this.data.storeys.map((s, i) => [String(i), s.name])], this.storey,
          (v) => { this.storey = v; this.update(); }),
        make("label", {}, "height of the graph ", make("input", { type: "range", id: "lift", min: "0", max: "2", step: "0.1", value: "1",
          on: { input: (e) => { this.lift = +e.target.value; this.update(); } } }))),
      make("section", {}, make("h2", {}, "Chosen"), make("label", {}, "id ", this.search = make("input", { id: "sel", type: "search", list: "ids",
        placeholder: "click a wall, or type its id", on: { change: () => this.select(this.search.value) } })),
        make("datalist", { id: "ids" }, ...this.data.scene.elements.slice(0, 2000).map((e) => make("option", { value: e[0] }))), this.about),
      this.data.scene.deviations.length ? make("section", {}, make("h2", {}, "Built otherwise than planned"),
        make("ul", {}, ...this.data.scene.deviations.map((d) => make("li", {}, make("button", { type: "button", class: "link",
          on: { click: () => this.select(d.id) } }, d.text))))) : "",
      gates.length ? make("section", {}, make("h2", {}, "Gates"), make("ul", { class: "gates" }, ...gates)) : "",
      make("section", {}, make("h2", {}, "Run it again up to here"), this.command,
        make("button", { type: "button", id: "copy", on: { click: () => this.copy() } }, "Copy")));
  }

  help() {
    const keys = [["space", "play, pause"], ["← →", "scan before, next; with shift ten"], ["Home End", "start, end"], ["n p", "next mark, mark before"],
      ["1 to 0", "layers"], ["PageUp PageDown", "storey"], ["c", "colour of the scan"], ["m", "next method"], ["r", "camera as at first"],
      ["f", "follow the robot"], ["/", "find an id"], ["?", "these keys"]];
    this.helpBox = Plumb.make("dialog", { id: "help", "aria-label": "keys" }, Plumb.make("h2", {}, "Keys"),
      Plumb.make("table", {}, ...keys.map(([k, t]) => Plumb.make("tr", {}, Plumb.make("th", {}, k), Plumb.make("td", {}, t)))),
      Plumb.make("form", { method: "dialog" }, Plumb.make("button", {}, "Close")));
    return this.helpBox;
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
    this.view.onMove(() => this.dirty());
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

  /** Storey of the true pose, or the one chosen. */
  storeyNow(truth) {
    if (this.storey !== "auto") return Math.min(+this.storey, this.data.storeys.length - 1);
    if (!truth) return 0;
    const floor = truth.p[2] - this.data.run.base * 1e-3;
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
    const storey = this.storeyNow(poses.truth), belief = this.hidden.has(this.m) ? null : data.beliefs[this.m];
    const floor = data.storeys[storey] ? data.storeys[storey].z : 0;
    const rooms = data.rooms.filter((r) => r.s === storey && r.at.length).map((r) => {
      const sum = r.at.reduce((a, p) => [a[0] + p[0], a[1] + p[1]], [0, 0]);
      return { name: r.name, middle: [sum[0] / r.at.length, sum[1] / r.at.length, floor + 0.1] };
    });
    return {
      t, poses, known, storey, floor, rooms, off: this.off, hidden: this.hidden, dark: Plumb.colours.dark(), lift: this.lift,
      colour: this.method ? this.method.colour : "#0072B2",
      state: belief ? Plumb.data.stateAt(belief, t) : null,
      set: belief ? Plumb.data.setAt(belief, t) : null,
      particles: belief ? Plumb.data.particlesAt(belief, t) : null,
      graph: this.off.has("graph") ? null : data.graphs[this.m] || null,
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
    moment.scan = scan ? scan.index : -1;
    moment.cloud = scan ? scan.cloud : null;
    if (moment.cloud) {
      moment.residuals = this.colouring === "residual" || this.selected ? this.residuals.of(moment.cloud.points, moment.cloud.count) : null;
      moment.colours = Plumb.colours.ofPoints(this.colouring, moment.cloud, moment.floor, this.data.scans.rings, moment.residuals);
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

  writeNumbers(moment) {
    const body = document.body.dataset;
    body.t = this.t.toFixed(3);
    body.scan = String(moment.scan);
    body.storey = String(moment.storey);
    this.slider.value = String(this.t);
    this.clock.textContent = this.t.toFixed(2) + " s";
    for (const cell of document.querySelectorAll("[data-now]")) {
      const pose = moment.poses[cell.dataset.now];
      cell.textContent = cell.dataset.now === "truth" ? "" : !pose ? "no answer" : pose.lost ? "says LOST" : (pose.e < 1 ? (100 * pose.e).toFixed(1) + " cm" : pose.e.toFixed(2) + " m") + " off";
    }
    const parts = [];
    const scans = this.data.scans;
    if (moment.state) {
      parts.push(this.m + ": " + Plumb.data.states[moment.state.state] + ", " + moment.state.hypotheses + (moment.state.hypotheses === 1 ? " hypothesis" : " hypotheses"));
      body.state = Plumb.data.states[moment.state.state];
      if (moment.set && moment.set.hypotheses[0] && moment.set.hypotheses[0].walls.length) {
        const walls = moment.set.hypotheses[0].walls, right = walls.filter((w) => w.right).length;
        body.walls = right + "/" + walls.length;
        parts.push(right + " of " + walls.length + (walls.length === 1 ? " wall" : " walls") + " of the first matched rightly");
      } else delete body.walls;
      if (moment.set && moment.set.all > moment.set.hypotheses.length) parts.push("and " + (moment.set.all - moment.set.hypotheses.length) + " more hypotheses");
    } else delete body.state;
    if (moment.scan >= 0) {
      const off = Math.round(1000 * (scans.t[moment.scan] - this.t));
      parts.push("scan " + (moment.scan + 1) + " of " + scans.count + " kept" + (scans.count < scans.all ? " (of " + scans.all + ")" : "") + (off ? ", " + Math.abs(off) + " ms " + (off < 0 ? "before" : "after") : ""));
    }
    const text = parts.join(" · ");
    if (this.status.textContent !== text) this.status.textContent = text;
    this.writeLegend();
    this.writeSelection(moment);
    this.command.textContent = "plumbline replay " + this.folder() + " --until " + Math.max(0.1, Math.ceil(10 * this.t) / 10).toFixed(1);
  }

  writeLegend() {
    if (this.legend.dataset.how === this.colouring) return;
    this.legend.dataset.how = this.colouring;
    const ends = { height: ["floor", "2.8 m"], ring: ["lowest", "highest"], residual: ["0 cm", "20 cm and more"] }[this.colouring];
    const scale = this.colouring === "residual" ? Plumb.colours.far : Plumb.colours.even;
    const bar = Plumb.make("span", { class: "scale", style: { background: "linear-gradient(90deg," + scale.map(Plumb.colours.css).join(",") + ")" } });
    this.legend.replaceChildren(Plumb.make("small", {}, ends[0]), bar, Plumb.make("small", {}, ends[1]));
  }

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
  }

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
  }

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
  }

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
  }

  /** The folder that the page lies in, as a word for a shell. */
  folder() {
    if (location.protocol !== "file:") return ".";
    const path = decodeURIComponent(location.pathname.replace(/\/[^/]*$/, "")) || "/";
    return /^[\w\-./=+,:@%]+$/.test(path) ? path : "'" + path.replace(/'/g, "'\\''") + "'";
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.command.textContent);
      document.getElementById("copy").textContent = "Copied";
      setTimeout(() => { document.getElementById("copy").textContent = "Copy"; }, 1500);
    } catch {
      getSelection().selectAllChildren(this.command);
    }
  }

  // ---- links and keys

  readLink() {
    this.address = location.hash;
    const link = new URLSearchParams(location.hash.slice(1)), t = parseFloat(link.get("t"));
    this.t = Number.isFinite(t) ? Math.min(this.data.end, Math.max(0, t)) : this.t;
    const m = link.get("m");
    if (this.data.run.methods.some((method) => method.name === m)) {
      this.m = m;
      for (const box of document.querySelectorAll("input[name=method]")) box.checked = box.value === m;
    }
    this.line2.method = this.m;
    if (["height", "ring", "residual"].includes(link.get("c"))) document.getElementById("colouring").value = this.colouring = link.get("c");
    if (["truth", "method"].includes(link.get("pose"))) document.getElementById("pose").value = this.at = link.get("pose");
    const s = this.data.storeys.findIndex((storey) => storey.name === link.get("s"));
    if (s >= 0) document.getElementById("storey").value = this.storey = String(s);
    if (link.has("sel")) this.search.value = this.selected = link.get("sel");
    if (link.has("off")) {
      this.off = new Set(link.get("off").split(",").filter((key) => this.layers.some(([k]) => k === key)));
      for (const box of document.querySelectorAll("input[data-layer]")) box.checked = !this.off.has(box.dataset.layer);
    }
    const cam = (link.get("cam") || "").split(",").map(Number);
    if (cam.length === 6 && cam.every(Number.isFinite)) this.view.setCamera6(cam);
  }

  writeLink() {
    clearTimeout(this.linkTimer);
    this.linkTimer = setTimeout(() => {
      if (location.hash !== this.address) return;  // another link was opened and is not read yet
      const link = new URLSearchParams();
      link.set("t", this.t.toFixed(2));
      if (this.m) link.set("m", this.m);
      if (this.selected) link.set("sel", this.selected);
      if (this.colouring !== "height") link.set("c", this.colouring);
      if (this.at !== "truth") link.set("pose", this.at);
      if (this.storey !== "auto" && this.data.storeys[+this.storey]) link.set("s", this.data.storeys[+this.storey].name);
      link.set("off", this.layers.map(([k]) => k).filter((k) => this.off.has(k)).join(","));
      link.set("cam", this.view.camera6().join(","));
      try { history.replaceState(null, "", "#" + link.toString()); } catch { /* where a viewer forbids it */ }
      this.address = location.hash;
    }, 150);
  }

  key(event) {
    if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName) && event.target.type !== "checkbox" && event.target.type !== "radio") return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const by = event.shiftKey ? 10 : 1, { key } = event;
    const jump = (forward) => {
      const times = this.data.run.marks.map((m) => m.t).filter((t) => (forward ? t > this.t + 0.01 : t < this.t - 0.01));
      if (times.length) this.seek(forward ? Math.min(...times) : Math.max(...times));
    };
    const actions = {
      " ": () => this.togglePlay(), ArrowRight: () => this.step(by), ArrowLeft: () => this.step(-by), Home: () => this.seek(0),
      End: () => this.seek(this.data.end), n: () => jump(true), p: () => jump(false), r: () => { this.follow = false; this.view.placed = false; this.view.home(this.moment.storey); this.dirty(); },
      f: () => { this.follow = !this.follow; this.dirty(); }, "/": () => this.search.focus(), "?": () => this.helpBox.showModal(),
      c: () => this.cycle("colouring"), m: () => this.nextMethod(), PageUp: () => this.changeStorey(1), PageDown: () => this.changeStorey(-1),
    };
    if (/^[0-9]$/.test(key)) {
      const layer = this.layers[(+key + 9) % 10];
      if (layer) this.layer(layer[0], this.off.has(layer[0]));
    } else if (actions[key] && !(key === " " && event.target.tagName === "BUTTON")) actions[key]();
    else return;
    event.preventDefault();
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

(async () => {
  const root = document.getElementById("app");
  try {
    const app = new Plumb.App(await Plumb.data.load());
    Plumb.app = app;
    await app.start(root);
  } catch (error) {
    document.body.dataset.error = String(error.message || error);
    root.append(Plumb.make("p", { class: "note bad" }, "The page cannot be shown: " + (error.message || error)));
  }
})();
