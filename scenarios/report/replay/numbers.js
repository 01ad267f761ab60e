// SPDX-License-Identifier: Apache-2.0
// What the page says in words and numbers of the moment that it shows.
"use strict";

Object.assign(Plumb.App.prototype, {
  writeNumbers(moment) {
    const body = document.body.dataset;
    body.t = this.t.toFixed(3);
    body.scan = String(moment.scan);
    body.storey = String(moment.storey);
    this.slider.value = String(this.t);
    this.clock.textContent = this.t.toFixed(2) + " s";
    for (const cell of document.querySelectorAll("[data-now]")) {
      const pose = moment.poses[cell.dataset.now];
      cell.textContent = cell.dataset.now === "truth" ? "" : Plumb.offText(pose);
      const method = this.data.run.methods.find((m) => m.name === cell.dataset.now);
      cell.classList.toggle("bad", !!pose && !!method && Plumb.data.isWrong(this.data, this.data.tracks[method.name], pose.i));
    }
    const parts = [];
    const scans = this.data.scans;
    if (moment.state) {
      parts.push(this.m + ": " + Plumb.data.states[moment.state.state] + ", " + moment.state.hypotheses + (moment.state.hypotheses === 1 ? " hypothesis" : " hypotheses"));
      body.state = Plumb.data.states[moment.state.state];
      if (moment.set && moment.set.hypotheses[0] && moment.set.hypotheses[0].walls.length) {
        const walls = moment.set.hypotheses[0].walls, right = walls.filter((w) => w.right).length;
        body.walls = right + "/" + walls.length;
        parts.push(right + " of the " + walls.length + (walls.length === 1 ? " wall" : " walls") + " that the first one names matched rightly");
      } else delete body.walls;
      if (moment.set && moment.set.all > moment.set.hypotheses.length) parts.push("and " + (moment.set.all - moment.set.hypotheses.length) + " more hypotheses");
    } else delete body.state;
    if (moment.poses[this.m] && moment.poses.truth) {
      const [at, truly] = [moment.poses[this.m], moment.poses.truth].map((pose) => this.storeyOf(pose));
      if (at !== truly) parts.push("WRONG STOREY: " + this.data.storeys[at].name + ", truly " + this.data.storeys[truly].name);
    }
    if (!this.off.has("graph") && !this.data.graphs[this.m]) parts.push(this.m + " keeps no situational graph");
    if (moment.scan >= 0) {
      const off = Math.round(1000 * (scans.t[moment.scan] - this.t));
      parts.push("scan " + (moment.scan + 1) + " of the " + scans.count + " on this page" + (scans.count < scans.all ? " (the run has " + scans.all + ")" : "")
        + (off ? ", taken " + Math.abs(off) + " ms " + (off < 0 ? "before" : "after") + " this time" : ""));
    }
    const text = parts.join(" · ");
    if (this.status.textContent !== text) this.status.textContent = text;
    this.caption.textContent = this.beside.title() + this.m + (moment.poses[this.m] ? ": " + Plumb.offText(moment.poses[this.m]) : "") + (moment.state ? ", " + Plumb.data.states[moment.state.state] : "");
    this.writeLegend();
    this.writeSelection(moment);
    this.writeWrong(moment);
    this.beside.send();
    this.command.textContent = "plumbline replay " + this.folder() + " --until " + Math.max(0.1, Math.ceil(10 * this.t) / 10).toFixed(1);
  },

  writeLegend() {
    if (this.legend.dataset.how === this.colouring) return;
    this.legend.dataset.how = this.colouring;
    if (this.colouring === "element") {
      const grey = Plumb.colours.elsewhere, swatch = (c) => Plumb.make("i", { class: "swatch", style: { background: Plumb.colours.css(c) } });
      this.legend.replaceChildren(Plumb.make("small", {}, "a colour for each wall and object of the plan; ", swatch(grey[0]), "floor, ceiling; ", swatch(grey[1]), "nothing within 20 cm"));
      return;
    }
    const ends = { height: ["floor", "2.8 m"], ring: ["lowest", "highest"], residual: ["0 cm", "20 cm and more"] }[this.colouring];
    const scale = this.colouring === "residual" ? Plumb.colours.far : Plumb.colours.even;
    const bar = Plumb.make("span", { class: "scale", style: { background: "linear-gradient(90deg," + scale.map(Plumb.colours.css).join(",") + ")" } });
    this.legend.replaceChildren(Plumb.make("small", {}, ends[0]), bar, Plumb.make("small", {}, ends[1]));
  },
});
