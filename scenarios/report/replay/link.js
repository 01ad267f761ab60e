// SPDX-License-Identifier: Apache-2.0
// The address of a moment, and keys.
"use strict";

Object.assign(Plumb.App.prototype, {
  readLink() {
    this.address = location.hash;
    const link = new URLSearchParams(location.hash.slice(1)), t = parseFloat(link.get("t"));
    const m = link.get("m"), known = this.data.run.methods.some((method) => method.name === m);
    const failure = Number.isFinite(t) ? null : this.firstFailure(known ? m : "");
    this.t = Math.min(this.data.end, Math.max(0, failure ? failure.t : Number.isFinite(t) ? t : this.t));
    if (known || (failure && failure.m)) {
      this.m = known ? m : failure.m;
      for (const box of document.querySelectorAll("input[name=method]")) box.checked = box.value === this.m;
    }
    this.line2.method = this.m;
    this.beside.chosen();
    if (["height", "ring", "residual", "element"].includes(link.get("c"))) document.getElementById("colouring").value = this.colouring = link.get("c");
    if (["truth", "method"].includes(link.get("pose"))) document.getElementById("pose").value = this.at = link.get("pose");
    const s = this.data.storeys.findIndex((storey) => storey.name === link.get("s"));
    if (s >= 0) document.getElementById("storey").value = this.storey = String(s);
    if (link.has("sel")) this.search.value = this.selected = link.get("sel");
    if (link.has("off")) {
      this.off = new Set(link.get("off").split(",").filter((key) => this.layers.some(([k]) => k === key)));
      for (const box of document.querySelectorAll("input[data-layer]")) box.checked = !this.off.has(box.dataset.layer);
    }
    if (!this.beside.embedded) this.beside.open(link.get("beside"), link.get("with"), Number.isFinite(t));
    const cam = (link.get("cam") || "").split(",").map(Number);
    if (cam.length === 6 && cam.every(Number.isFinite)) this.view.setCamera6(cam);
  },

  /** The mark where a failure begins to show, of one method or of the one that fails first; or none. */
  firstFailure(name) {
    const first = (kinds) => this.data.run.marks.find((m) => kinds.includes(m.kind) && (name === "" || m.m === name));
    return first(["wrong"]) || first(["lost", "failure", "gate"]) || first(["slip"]) || first(["far"]);
  },

  writeLink() {
    clearTimeout(this.linkTimer);
    this.linkTimer = setTimeout(() => {
      if (location.hash !== this.address) return;  // another link was opened and is not read yet
      const link = new URLSearchParams();
      link.set("t", this.t.toFixed(2));
      if (this.m) link.set("m", this.m);
      if (this.selected) link.set("sel", this.selected);
      if (this.beside.name) link.set(this.beside.path ? "with" : "beside", this.beside.name);
      if (this.colouring !== "height") link.set("c", this.colouring);
      if (this.at !== "truth") link.set("pose", this.at);
      if (this.storey !== "auto" && this.data.storeys[+this.storey]) link.set("s", this.data.storeys[+this.storey].name);
      link.set("off", this.layers.map(([k]) => k).filter((k) => this.off.has(k)).join(","));
      link.set("cam", this.view.camera6().join(","));
      try { history.replaceState(null, "", "#" + link.toString()); } catch { /* where a viewer forbids it */ }
      this.address = location.hash;
    }, 150);
  },

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
      c: () => this.cycle("colouring"), b: () => this.beside.next(), m: () => this.nextMethod(), PageUp: () => this.changeStorey(1), PageDown: () => this.changeStorey(-1),
    };
    if (/^[0-9]$/.test(key)) {
      const layer = this.layers[(+key + 9) % 10];
      if (layer) this.layer(layer[0], this.off.has(layer[0]));
    } else if (actions[key] && !(key === " " && event.target.tagName === "BUTTON")) actions[key]();
    else return;
    event.preventDefault();
  },
});
