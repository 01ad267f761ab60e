// SPDX-License-Identifier: Apache-2.0
// The controls beside the picture, and the list of keys.
"use strict";

Object.assign(Plumb.App.prototype, {
  panel() {
    const make = Plumb.make, run = this.data.run;
    const rows = [["truth", "#111111", ""], ...run.methods.map((m) => [m.name, m.colour, m.verdict])].map(([name, colour, verdict]) => {
      const box = make("input", { type: "checkbox", checked: true, "data-method": name, "aria-label": "show " + name,
        on: { change: () => this.show(name, box.checked) } });
      const now = make("span", { class: "now", "data-now": name });
      const pick = name === "truth" ? make("span") : make("input", { type: "radio", name: "method", value: name, checked: name === this.m,
        "aria-label": "look at " + name, on: { change: () => this.choose(name) } });
      return make("tr", { class: verdict ? "" : "truth" }, make("td", {}, box), make("td", {}, pick),
        make("td", {}, make("i", { class: "swatch", style: { background: name === "truth" ? "var(--ink)" : colour } }), ...Plumb.breakable(name),
          verdict ? make("small", {}, " " + verdict) : ""), make("td", {}, now));
    });
    const select = (id, label, options, value, change) => {
      const list = make("select", { id, on: { change: () => change(list.value) } },
        ...options.map(([v, text]) => make("option", { value: v, selected: v === value }, text)));
      return make("label", {}, label + " ", list);
    };
    this.layers = [["building", "building"], ["scan", "scan"], ["paths", "paths"], ["robots", "robots"], ["particles", "particles"],
      ["hypotheses", "hypotheses"], ["walls", "matched walls"], ["graph", "situational graph"], ["deviations", "deviations"], ["labels", "names"],
      ["plangraph", "graph of the plan"], ["map", "map cloud"]];
    const layers = this.layers.map(([key, text], i) => make("label", { class: "layer" }, make("input", { type: "checkbox", "data-layer": key,
      checked: !this.off.has(key), on: { change: (e) => this.layer(key, e.target.checked) } }), (i < 10 ? (i + 1) % 10 + " " : "") + text));
    this.about = make("div", { id: "about" });
    this.legend = make("div", { id: "legend" });
    this.command = make("code", { id: "command" });
    const gates = run.gates.map((g) => make("li", { class: g.passed ? "good" : "bad" }, g.passed ? "passed: " : "FAILED: ", this.gateLink(g)));
    return make("aside", {},
      make("section", {}, make("h2", {}, "Methods"), make("table", { "aria-label": "methods" }, make("thead", {}, make("tr", {}, make("th", {}, "show"), make("th", {}, "look at"),
        make("th", {}, "name"), make("th", {}, "now"))), make("tbody", {}, ...rows)), this.status, this.wrong, this.beside.control()),
      make("section", {}, make("h2", {}, "Chosen"), make("label", {}, "id ", this.search = make("input", { id: "sel", type: "search", list: "ids",
        placeholder: "click a wall, or type its id", on: { change: () => this.select(this.search.value) } })),
        make("datalist", { id: "ids" }, ...this.data.scene.elements.slice(0, 2000).map((e) => make("option", { value: e[0] }))), this.about),
      make("section", {}, make("h2", {}, "Scan"),
        select("pose", "drawn at the pose of", [["truth", "the truth"], ["method", "the method looked at"]], this.at, (v) => { this.at = v; this.update(); }),
        select("colouring", "coloured by", [["height", "height"], ["ring", "ring"], ["residual", "distance to the plan"], ["element", "element of the plan"]], this.colouring,
          (v) => { this.colouring = v; this.update(); }), this.legend),
      make("section", {}, make("h2", {}, "Layers"), make("div", { class: "layers" }, ...layers),
        select("storey", "storey", [["auto", "follow the robot"], ["method", "follow the estimate"], ...this.data.storeys.map((s, i) => [String(i), s.name])], this.storey,
          (v) => { this.storey = v; this.update(); }),
        make("label", {}, "height of the graph ", make("input", { type: "range", id: "lift", min: "0", max: "2", step: "0.1", value: "1",
          on: { input: (e) => { this.lift = +e.target.value; this.update(); } } }))),
      this.data.scene.deviations.length ? make("section", {}, make("h2", {}, "Built otherwise than planned"),
        make("ul", {}, ...this.data.scene.deviations.map((d) => make("li", {}, make("button", { type: "button", class: "link",
          on: { click: () => this.select(d.id) } }, d.text))))) : "",
      gates.length ? make("section", {}, make("h2", {}, "Gates"), make("ul", { class: "gates" }, ...gates)) : "",
      make("section", {}, make("h2", {}, "Run it again up to here"), this.command,
        make("button", { type: "button", id: "copy", on: { click: () => this.copy() } }, "Copy")));
  },

  help() {
    const keys = [["space", "play, pause"], ["← →", "scan before, next; with shift ten"], ["Home End", "start, end"], ["n p", "next mark, mark before"],
      ["1 to 0", "layers"], ["PageUp PageDown", "storey"], ["c", "colour of the scan"], ["m", "next method"], ["b", "side by side with the next method; again for the one after"], ["r", "camera as at first"],
      ["f", "follow the robot"], ["/", "find an id"], ["?", "these keys"]];
    this.helpBox = Plumb.make("dialog", { id: "help", "aria-label": "keys" }, Plumb.make("h2", {}, "Keys"),
      Plumb.make("table", { "aria-label": "keys" }, ...keys.map(([k, t]) => Plumb.make("tr", {}, Plumb.make("th", {}, k), Plumb.make("td", {}, t)))),
      Plumb.make("form", { method: "dialog" }, Plumb.make("button", {}, "Close")));
    return this.helpBox;
  },

  /** The folder that the page lies in, as a word for a shell. */
  folder() {
    if (location.protocol !== "file:") return ".";
    const path = decodeURIComponent(location.pathname.replace(/\/[^/]*$/, "")) || "/";
    return /^[\w\-./=+,:@%]+$/.test(path) ? path : "'" + path.replace(/'/g, "'\\''") + "'";
  },

  async copy() {
    try {
      await navigator.clipboard.writeText(this.command.textContent);
      document.getElementById("copy").textContent = "Copied";
      setTimeout(() => { document.getElementById("copy").textContent = "Copy"; }, 1500);
    } catch {
      getSelection().selectAllChildren(this.command);
    }
  },
});
