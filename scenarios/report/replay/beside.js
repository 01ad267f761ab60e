// SPDX-License-Identifier: Apache-2.0
// A second picture beside the first: another method of this run, or another run. It is this page, or the other run's, in a frame that
// shows its picture alone and follows the time, the camera and the layers of this one. Messages hold nothing but these.
"use strict";

Plumb.Beside = class {
  constructor(app) {
    this.app = app;
    this.name = "";
    this.path = false; // the name is that of another run's page
    this.embedded = new URLSearchParams(location.hash.slice(1)).get("embed") === "1" && parent !== window;
  }

  control() {
    const make = Plumb.make;
    this.list = make("select", { id: "beside", on: { change: () => this.open(this.list.value, this.path ? this.list.value : null, false) } });
    this.offer();
    this.note = make("p", { class: "soft", id: "apart", role: "status", "aria-label": "how the two differ" });
    return make("div", {}, make("label", {}, "side by side with ", this.list), this.note);
  }

  /** What may stand beside: the other methods, and the other run where one does. */
  offer() {
    const option = (value, text) => Plumb.make("option", { value, selected: value === this.name }, text);
    this.list.replaceChildren(option("", "nothing"), ...this.others().map((name) => option(name, name)),
      ...(this.path ? [option(this.name, "run " + (this.run || this.name))] : []));
  }

  others() { return this.app.data.run.methods.map((m) => m.name).filter((name) => name !== this.app.m); }

  /** Another method is looked at: it is not compared with itself. */
  chosen() {
    if (this.embedded || !this.list) return;
    if (this.name && !this.path) {
      if (this.name === this.app.m) this.open("", null, true);
      else this.compare(true);
    }
    this.offer();
  }

  start() {
    if (this.embedded) {
      document.body.classList.add("embed");
      addEventListener("message", (event) => { if (event.source === parent) this.follow(event.data); });
      parent.postMessage({ plumb: "ready", run: this.runName() }, "*");
    } else {
      addEventListener("message", (event) => {
        if (!this.frame || event.source !== this.frame.contentWindow || !event.data) return;
        if (event.data.plumb === "ready") {
          this.ready = true;
          this.run = String(event.data.run || "");
          this.offer();
        }
        if (event.data.plumb === "camera" && this.six(event.data.cam)) this.app.view.setCamera6(event.data.cam);
        this.send();
        this.app.dirty();
      });
    }
  }

  runName() { return this.app.data.run.name + ", seed " + this.app.data.run.seed; }

  /** What stands before the method above a picture: the run, where the other picture is of another one. */
  title() { return this.path || this.ofRun ? this.runName() + ": " : ""; }

  six(cam) { return Array.isArray(cam) && cam.length === 6 && cam.every(Number.isFinite); }

  /** name: a method of this run; path: the page of another run, relative to this one. stay: at the time that is shown. */
  open(name, path, stay) {
    const known = this.others().includes(name), page = path && /^[^:?#]*replay\.html$/.test(path) ? path : "";
    const wanted = known ? name : page;
    if (wanted === this.name) return;
    if (this.frame) this.frame.remove();
    this.frame = null;
    this.ready = false;
    this.name = wanted;
    this.path = !known && page !== "";
    this.run = "";
    this.offer();
    this.app.pictures.classList.toggle("pair", wanted !== "");
    this.note.textContent = "";
    if (!wanted) return;
    const link = new URLSearchParams({ embed: "1", t: this.app.t.toFixed(2), m: this.path ? this.app.m : name });
    // Another address than this page's own, which a browser would not load into itself.
    this.frame = Plumb.make("iframe", { title: "the same time, " + (this.path ? "of " + path : name), tabindex: "-1" });
    this.frame.src = (this.path ? page : location.pathname.replace(/^.*\//, "")) + "?beside#" + link;
    this.app.pictures.append(this.frame);
    if (this.path) {
      this.note.textContent = "Beside it: " + path;
      return;
    }
    this.compare(stay);
  }

  /** Says where the two methods are first apart, and goes there. */
  compare(stay) {
    const { t, text } = this.firstApart(this.app.m, this.name);
    this.note.textContent = text;
    document.body.dataset.apart = t === null ? "" : t.toFixed(3);
    if (t !== null && !stay) this.app.seek(t);
  }

  next() {
    const names = ["", ...this.others()];
    this.open(names[(names.indexOf(this.path ? "" : this.name) + 1) % names.length], null, false);
  }

  /** First time at which two methods say different things, null where there is none, and that as text. Before both have an answer nothing
      is compared. */
  firstApart(a, b) {
    const { tracks } = this.app.data, { known, yawOf } = Plumb.data, says = (t, text) => ({ t, text });
    let both = false;
    for (const t of tracks.truth.t) {
      const p = known(tracks[a], t), q = known(tracks[b], t), at = t.toFixed(2) + " s";
      if (!p || !q) {
        if (both && !p !== !q) return says(t, "From " + at + " on " + (p ? b : a) + " gives no single pose and " + (p ? a : b) + " does.");
        continue;
      }
      both = true;
      if (p.lost !== q.lost) return says(t, "From " + at + " on " + (p.lost ? a : b) + " says that it is LOST and " + (p.lost ? b : a) + " does not.");
      const turned = Math.abs(Math.atan2(Math.sin(yawOf(p.q) - yawOf(q.q)), Math.cos(yawOf(p.q) - yawOf(q.q))));
      if (Math.hypot(...p.p.map((v, k) => v - q.p[k])) > 0.5 || turned > Math.PI / 18)
        return says(t, a + " and " + b + " are first apart by more than 0.5 m or 10° at " + at + ".");
    }
    if (both) return says(null, a + " and " + b + " are never more than 0.5 m or 10° apart while both give a pose.");
    const silent = [a, b].filter((name) => tracks[name].t.length === 0);
    return says(null, a + " and " + b + " cannot be compared: " + (silent.length === 2 ? "neither gives a single pose." : silent.length === 1
      ? silent[0] + " gives no single pose." : "they never give one at the same time."));
  }

  /** What the second picture follows. */
  send() {
    if (this.embedded || !this.frame || !this.ready) return;
    const { app } = this;
    this.frame.contentWindow.postMessage({ plumb: "show", t: app.t, cam: app.view.camera6(), off: [...app.off], c: app.colouring, at: app.at,
      storey: app.storey, lift: app.lift, selected: app.selected, ofRun: this.path }, "*");
  }

  moved() {
    if (this.embedded) {
      if (!this.told) parent.postMessage({ plumb: "camera", cam: this.app.view.camera6() }, "*");
    } else {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.send(), 30);
    }
  }

  follow(shown) {
    if (!shown || shown.plumb !== "show" || !Number.isFinite(shown.t)) return;
    const { app } = this;
    this.told = true; // a camera that was set is not a camera that was moved
    if (this.six(shown.cam)) app.view.setCamera6(shown.cam);
    this.told = false;
    app.off = new Set(Array.isArray(shown.off) ? shown.off.map(String) : []);
    if (["height", "ring", "residual", "element"].includes(shown.c)) app.colouring = shown.c;
    app.at = shown.at === "method" ? "method" : "truth";
    app.storey = typeof shown.storey === "string" ? shown.storey : "auto";
    this.ofRun = shown.ofRun === true;
    app.lift = Number.isFinite(shown.lift) ? shown.lift : 1;
    app.selected = typeof shown.selected === "string" ? shown.selected : null;
    app.seek(shown.t);
  }
};
