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
    const make = Plumb.make, names = this.app.data.run.methods.map((m) => m.name);
    this.list = make("select", { id: "beside", on: { change: () => this.open(this.list.value, null, false) } },
      make("option", { value: "" }, "nothing"), ...names.map((name) => make("option", { value: name }, name)));
    this.note = make("p", { class: "soft", id: "apart", role: "status" });
    return make("div", {}, make("label", {}, "side by side with ", this.list), this.note);
  }

  start() {
    if (this.embedded) {
      document.body.classList.add("embed");
      addEventListener("message", (event) => { if (event.source === parent) this.follow(event.data); });
      parent.postMessage({ plumb: "ready" }, "*");
    } else {
      addEventListener("message", (event) => {
        if (!this.frame || event.source !== this.frame.contentWindow || !event.data) return;
        if (event.data.plumb === "ready") this.ready = true;
        if (event.data.plumb === "camera" && this.six(event.data.cam)) this.app.view.setCamera6(event.data.cam);
        this.send();
        this.app.dirty();
      });
    }
  }

  six(cam) { return Array.isArray(cam) && cam.length === 6 && cam.every(Number.isFinite); }

  /** name: a method of this run; path: the page of another run, relative to this one. stay: at the time that is shown. */
  open(name, path, stay) {
    const known = this.app.data.run.methods.some((m) => m.name === name), page = path && /^[^:?#]*replay\.html$/.test(path) ? path : "";
    const wanted = known ? name : page;
    if (wanted === this.name) return;
    if (this.frame) this.frame.remove();
    this.frame = null;
    this.ready = false;
    this.name = wanted;
    this.path = !known && page !== "";
    this.list.value = known ? name : "";
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
    const t = this.firstApart(this.app.m, name);
    this.note.textContent = t === null ? this.app.m + " and " + name + " are never more than 0.5 m or 10° apart."
      : this.app.m + " and " + name + " are first apart by more than 0.5 m or 10°, or one has lost its answer, at " + t.toFixed(2) + " s.";
    document.body.dataset.apart = t === null ? "" : t.toFixed(3);
    if (t !== null && !stay) this.app.seek(t);
  }

  next() {
    const names = ["", ...this.app.data.run.methods.map((m) => m.name).filter((name) => name !== this.app.m)];
    this.open(names[(names.indexOf(this.path ? "" : this.name) + 1) % names.length], null, false);
  }

  /** First time at which two methods say different things, or null; before both have an answer nothing is compared. */
  firstApart(a, b) {
    const { tracks } = this.app.data, { known, yawOf } = Plumb.data;
    let both = false;
    for (const t of tracks.truth.t) {
      const p = known(tracks[a], t), q = known(tracks[b], t);
      if (!p || !q) {
        if (both && !p !== !q) return t;
        continue;
      }
      both = true;
      const turned = Math.abs(Math.atan2(Math.sin(yawOf(p.q) - yawOf(q.q)), Math.cos(yawOf(p.q) - yawOf(q.q))));
      if (p.lost !== q.lost || Math.hypot(...p.p.map((v, k) => v - q.p[k])) > 0.5 || turned > Math.PI / 18) return t;
    }
    return null;
  }

  /** What the second picture follows. */
  send() {
    if (this.embedded || !this.frame || !this.ready) return;
    const { app } = this;
    this.frame.contentWindow.postMessage({ plumb: "show", t: app.t, cam: app.view.camera6(), off: [...app.off], c: app.colouring, at: app.at,
      storey: app.storey, lift: app.lift, selected: app.selected }, "*");
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
    app.lift = Number.isFinite(shown.lift) ? shown.lift : 1;
    app.selected = typeof shown.selected === "string" ? shown.selected : null;
    app.seek(shown.t);
  }
};
