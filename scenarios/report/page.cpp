// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/page.h"

namespace plumbline::scenarios {

std::string_view page_style() {
  return R"css(
:root{--ink:#1c2430;--soft:#5d6b7c;--line:#d9dfe7;--paper:#fff;--ground:#f3f5f8;--good:#0a7d4f;--bad:#c02f1d;--wall:#39424e}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.45 system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main{max-width:1280px;margin:0 auto;padding:20px 24px 60px}
header{display:flex;flex-wrap:wrap;align-items:baseline;gap:6px 16px;margin-bottom:14px}
h1{font-size:24px;margin:0}
h2{font-size:16px;margin:0 0 10px}
.badge{font-weight:700;padding:3px 12px;border-radius:999px;color:#fff;background:var(--soft)}
.badge.good{background:var(--good)}.badge.bad{background:var(--bad)}
.facts{color:var(--soft)}
.card{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:16px;margin-bottom:16px}
.top{display:grid;grid-template-columns:minmax(0,1fr) 330px;gap:16px}
@media(max-width:980px){.top{grid-template-columns:1fr}}
svg{display:block;width:100%;height:auto}
.map{max-height:82vh}
.maps{display:grid;gap:12px}
.switch{display:flex;flex-wrap:wrap;gap:6px 10px;margin-bottom:8px;align-items:center}
.switch [aria-pressed=true]{background:var(--ink);color:#fff}
.storey{margin:0 0 4px;font-weight:600}
.map{--px:.03;touch-action:pan-y;cursor:grab}
.map text{font-size:calc(12px*var(--px));fill:#6b7889;paint-order:stroke;stroke:#f8fafc;stroke-width:calc(3px*var(--px))}
.plotbox{overflow-x:auto;position:relative}
@media(max-width:780px){.plotbox .plot{min-width:680px}main{padding:12px 8px 40px}}
.tip{position:fixed;pointer-events:none;background:var(--paper);border:1px solid var(--line);border-radius:6px;padding:3px 8px;font-size:12px;white-space:pre;z-index:2}
.only{padding:0 8px;font-size:12px}
.scale{stroke:#6b7889;stroke-width:.08}
.room{fill:#f8fafc;stroke:none}
.asbuilt{fill:#e8871e;fill-opacity:.55;stroke:#e8871e;stroke-width:.05}
.planned{fill:none;stroke:#7a4a9e;stroke-width:.05;stroke-dasharray:.14 .1}
.wall{stroke:var(--wall);stroke-width:.07;stroke-linecap:square}
.thing{fill:#c3cbd6;fill-opacity:.7;stroke:var(--wall);stroke-width:.03}
.thing.hull{fill-opacity:.25;stroke-dasharray:.1 .08}
.wall.high{stroke-opacity:.2}
.truth{fill:none;stroke:#111;stroke-width:.05;stroke-dasharray:.16 .12}
.path{fill:none;stroke-width:.06;stroke-linejoin:round;stroke-opacity:.9}
.found{stroke-width:.09;stroke-linecap:round;stroke-opacity:.85}
.foundroom{fill-opacity:.10;stroke-width:.03;stroke-dasharray:.12 .08}
.invented{fill:#c02f1d;fill-opacity:.18;stroke:#c02f1d}
.method{border-left:5px solid;padding:2px 0 2px 12px;margin-bottom:14px}
.method h3{margin:0;font-size:15px}
.method p{margin:2px 0;color:var(--soft)}
.method label{cursor:pointer}
.verdict{font-weight:700}.verdict.good{color:var(--good)}.verdict.bad{color:var(--bad)}.verdict.open{color:var(--soft)}
.controls{display:flex;align-items:center;gap:12px;margin-top:10px}
.controls input[type=range]{flex:1}
button{font:inherit;border:1px solid var(--line);background:#fff;border-radius:8px;padding:4px 14px;cursor:pointer}
.clock{font-variant-numeric:tabular-nums;min-width:64px;text-align:right}
.plot text{font-size:12px;fill:var(--soft)}
.plot .grid{stroke:var(--line);stroke-width:1}
.plot .curve{fill:none;stroke-width:1.6}
.plot .disclaimed{stroke-width:1;stroke-dasharray:1 4;stroke-opacity:.8}
.plot .mark{stroke:#5d6b7c;stroke-width:1}
.plot .marked{fill:#1c2430}
.plot .inband{fill:#111;font-weight:600}
.plot .cursor{stroke:#111;stroke-width:1;stroke-dasharray:3 3}
.plannedwall{stroke-width:.24;stroke-opacity:.3}
.seenwall{stroke-width:.13}
.heldplace{fill:#111;stroke:#fff;stroke-width:.05}
.beliefs{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:14px}
@media(max-width:780px){.beliefs{grid-template-columns:1fr}}
.beliefs p{margin:0 0 6px;color:var(--soft)}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:5px 10px 5px 0;border-bottom:1px solid var(--line);vertical-align:top}
td.num,th.num{text-align:right}
.scroll{overflow-x:auto}
table.sorted th{cursor:pointer}
table.sorted th[aria-sort=ascending]::after{content:" ▲"}
table.sorted th[aria-sort=descending]::after{content:" ▼"}
details summary{cursor:pointer;color:var(--soft)}
code{font:12.5px ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
.key{display:flex;flex-wrap:wrap;gap:4px 18px;color:var(--soft);margin:8px 0 0;font-size:13px}
.swatch{display:inline-block;width:14px;height:10px;border-radius:2px;margin-right:6px}
.key svg{width:34px;height:10px;display:inline-block;vertical-align:middle;margin-right:6px}
)css";
}

std::string_view map_script() {
  return R"js(
var fitMaps = (function () {
  "use strict";
  // Text of maps keeps its size on the screen; names that would lie over others or outside of their rooms are left out.
  function fit(map) {
    var box = map.getBoundingClientRect(), view = map.viewBox.baseVal;
    if (box.width === 0) return;
    var px = Math.max(view.width / box.width, view.height / box.height), taken = [];
    map.style.setProperty("--px", px);
    map.querySelectorAll("text").forEach(function (text) {
      text.style.display = "";
      var r = text.getBBox();
      var over = taken.some(function (o) {
        return r.x < o.x + o.width && o.x < r.x + r.width && r.y < o.y + o.height && o.y < r.y + r.height;
      });
      if (over || (text.dataset.room && r.width > +text.dataset.room)) text.style.display = "none";
      else taken.push(r);
    });
  }
  function fitAll() { document.querySelectorAll(".map").forEach(fit); }
  window.addEventListener("resize", fitAll);
  function zoom(map, by, x, y) {
    var view = map.viewBox.baseVal, whole = map.whole, width = Math.min(whole.width, Math.max(whole.width / 40, view.width / by));
    var share = width / view.width;
    set(map, x - (x - view.x) * share, y - (y - view.y) * share, width, view.height * share);
  }
  function set(map, x, y, width, height) {
    var whole = map.whole;
    x = Math.min(Math.max(x, whole.x), whole.x + whole.width - width);
    y = Math.min(Math.max(y, whole.y), whole.y + whole.height - height);
    map.setAttribute("viewBox", x + " " + y + " " + width + " " + height);
    fit(map);
  }
  function place(map, event) {
    var p = new DOMPoint(event.clientX, event.clientY).matrixTransform(map.getScreenCTM().inverse());
    return [p.x, p.y];
  }
  document.querySelectorAll(".map").forEach(function (map) {
    var v = map.viewBox.baseVal, drag = null;
    map.whole = { x: v.x, y: v.y, width: v.width, height: v.height };
    map.setAttribute("tabindex", "0");
    map.addEventListener("wheel", function (event) {
      if (!event.ctrlKey && document.activeElement !== map) return;  // the page scrolls
      event.preventDefault();
      var p = place(map, event);
      zoom(map, Math.exp(-0.002 * event.deltaY), p[0], p[1]);
    }, { passive: false });
    map.addEventListener("dblclick", function (event) { var p = place(map, event); zoom(map, 2, p[0], p[1]); });
    map.addEventListener("pointerdown", function (event) {
      if (map.viewBox.baseVal.width < map.whole.width) { drag = place(map, event); map.setPointerCapture(event.pointerId); }
    });
    map.addEventListener("pointermove", function (event) {
      if (!drag) return;
      var p = place(map, event), view = map.viewBox.baseVal;
      set(map, view.x + drag[0] - p[0], view.y + drag[1] - p[1], view.width, view.height);
    });
    map.addEventListener("pointerup", function () { drag = null; });
    map.addEventListener("keydown", function (event) {
      var view = map.viewBox.baseVal, x = view.x + view.width / 2, y = view.y + view.height / 2, step = view.width / 10;
      if (event.key === "+" || event.key === "=") zoom(map, 1.5, x, y);
      else if (event.key === "-") zoom(map, 1 / 1.5, x, y);
      else if (event.key === "0") set(map, map.whole.x, map.whole.y, map.whole.width, map.whole.height);
      else if (event.key === "ArrowLeft") set(map, view.x - step, view.y, view.width, view.height);
      else if (event.key === "ArrowRight") set(map, view.x + step, view.y, view.width, view.height);
      else if (event.key === "ArrowUp") set(map, view.x, view.y - step, view.width, view.height);
      else if (event.key === "ArrowDown") set(map, view.x, view.y + step, view.width, view.height);
      else return;
      event.preventDefault();
    });
  });
  fitAll();
  return fitAll;
})();
)js";
}

std::string_view sort_script() {
  return R"js(
document.querySelectorAll("table.sorted").forEach(function (table) {
  "use strict";
  var heads = table.rows[0].cells;
  function value(row, k) {
    var text = row.cells[k] ? row.cells[k].textContent.trim() : "", number = parseFloat(text);
    return isNaN(number) ? text : number;
  }
  Array.prototype.forEach.call(heads, function (head, k) {
    function sort() {
      var up = head.getAttribute("aria-sort") !== "ascending", rows = Array.prototype.slice.call(table.rows, 1);
      rows.sort(function (a, b) {
        var x = value(a, k), y = value(b, k);
        if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;  // what has no number stands last
        return (x < y ? -1 : x > y ? 1 : 0) * (up ? 1 : -1);
      });
      Array.prototype.forEach.call(heads, function (other) { other.removeAttribute("aria-sort"); });
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      rows.forEach(function (row) { row.parentNode.appendChild(row); });
    }
    head.tabIndex = 0;
    head.addEventListener("click", sort);
    head.addEventListener("keydown", function (event) { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); sort(); } });
  });
});
)js";
}

std::string_view page_script() {
  return R"js(
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("data").textContent);
  var slider = document.getElementById("time"), clock = document.getElementById("clock");
  var play = document.getElementById("play"), timer = null;
  var cursors = document.querySelectorAll(".cursor");

  function at(track, t) {
    var lo = 0, hi = track.t.length - 1;
    if (hi < 0 || t < track.t[0] - 0.2) return null;
    while (lo < hi) {
      var mid = (lo + hi + 1) >> 1;
      if (track.t[mid] <= t) lo = mid; else hi = mid - 1;
    }
    return { x: track.x[lo], y: track.y[lo], yaw: track.yaw[lo], s: track.s[lo], e: track.e ? track.e[lo] : 0,
             lost: track.lost ? track.lost[lo] === 1 : false };
  }
  function stateAt(name, t) {
    var list = data.states[name] || [], found = "";
    list.forEach(function (change) { if (change[0] <= t) found = change[1]; });
    return found;
  }
  function said(name, t) {
    var p = at(data.tracks[name], t), state = stateAt(name, t);
    if (!p) return "no single answer yet" + (state ? ", " + state : "");
    if (p.lost) return "says that it is LOST";
    return (p.e * 100).toFixed(1) + " cm off" + (state ? ", " + state : "");
  }
  function show(t) {
    t = Math.min(Math.max(t, 0), data.end);
    slider.value = t;
    clock.textContent = t.toFixed(1) + " s";
    Object.keys(data.tracks).forEach(function (name) {
      var p = at(data.tracks[name], t);
      document.querySelectorAll(".robot").forEach(function (mark) {
        if (mark.dataset.robot !== name) return;
        var here = p && p.s === +mark.dataset.storey;
        mark.style.display = here ? "" : "none";
        if (here) mark.setAttribute("transform", "translate(" + p.x + " " + -p.y + ") rotate(" + (-p.yaw * 180 / Math.PI) + ")");
      });
      var now = document.getElementById("now-" + name);
      if (now) now.textContent = "at " + t.toFixed(1) + " s: " + said(name, t);
    });
    var x = data.plot.x0 + (data.plot.x1 - data.plot.x0) * (data.end > 0 ? t / data.end : 0);
    cursors.forEach(function (c) { c.setAttribute("x1", x); c.setAttribute("x2", x); });
    var truth = at(data.tracks.truth, t), follow = document.getElementById("follow");
    if (truth && follow && follow.checked) showFloor(truth.s);
  }
  var floors = document.querySelectorAll("[data-floor]"), switches = document.querySelectorAll("[data-switch]");
  function showFloor(index) {
    var known = Array.prototype.some.call(floors, function (f) { return +f.dataset.floor === index; });
    if (!known || switches.length === 0) return;
    floors.forEach(function (f) { f.style.display = +f.dataset.floor === index ? "" : "none"; });
    switches.forEach(function (b) { b.setAttribute("aria-pressed", +b.dataset.switch === index); });
    fitMaps();
  }
  switches.forEach(function (b) {
    b.addEventListener("click", function () {
      document.getElementById("follow").checked = false;
      showFloor(+b.dataset.switch);
    });
  });
  slider.max = data.end;
  slider.addEventListener("input", function () { show(+slider.value); });
  play.addEventListener("click", function () {
    if (timer) { clearInterval(timer); timer = null; play.textContent = "Play"; return; }
    play.textContent = "Pause";
    if (+slider.value >= data.end - 0.05) show(0);
    timer = setInterval(function () {
      var t = +slider.value + 0.4;
      if (t >= data.end) { clearInterval(timer); timer = null; play.textContent = "Play"; }
      show(t);
    }, 50);
  });
  document.querySelectorAll("input[data-layer]").forEach(function (box) {
    box.addEventListener("change", function () {
      document.querySelectorAll(".layer-" + CSS.escape(box.dataset.layer)).forEach(function (g) {
        g.style.display = box.checked ? "" : "none";
      });
    });
  });
  document.querySelectorAll("[data-only]").forEach(function (button) {
    button.addEventListener("click", function () {
      var alone = button.dataset.alone !== "1";
      document.querySelectorAll("[data-only]").forEach(function (other) { other.dataset.alone = ""; });
      button.dataset.alone = alone ? "1" : "";
      document.querySelectorAll("input[data-layer]").forEach(function (box) {
        box.checked = !alone || box.dataset.layer === button.dataset.only;
        box.dispatchEvent(new Event("change"));
      });
    });
  });
  var tip = document.createElement("div");
  tip.className = "tip";
  tip.style.display = "none";
  document.body.appendChild(tip);
  document.querySelectorAll(".plot").forEach(function (one) {
    function timeAt(event) {
      var p = new DOMPoint(event.clientX, event.clientY).matrixTransform(one.getScreenCTM().inverse());
      return (p.x - data.plot.x0) / (data.plot.x1 - data.plot.x0) * data.end;
    }
    one.addEventListener("pointermove", function (event) {
      var t = timeAt(event), lines = [t.toFixed(1) + " s"];
      tip.style.display = t >= 0 && t <= data.end ? "" : "none";
      Object.keys(data.tracks).forEach(function (name) { if (name !== "truth") lines.push(name + ": " + said(name, t)); });
      tip.textContent = lines.join("\n");
      tip.style.left = Math.min(event.clientX + 12, innerWidth - tip.offsetWidth - 8) + "px";
      tip.style.top = Math.min(event.clientY + 12, innerHeight - tip.offsetHeight - 8) + "px";
    });
    one.addEventListener("pointerleave", function () { tip.style.display = "none"; });
    one.addEventListener("click", function (event) { show(timeAt(event)); });
  });
  document.addEventListener("keydown", function (event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|BUTTON|svg)$/.test(event.target.tagName)) return;
    if (event.key === " ") play.click();
    else if (event.key === "ArrowRight") show(+slider.value + (event.shiftKey ? 5 : 0.5));
    else if (event.key === "ArrowLeft") show(+slider.value - (event.shiftKey ? 5 : 0.5));
    else return;
    event.preventDefault();
  });
  fitMaps();
  var link = /t=([0-9.]+)/.exec(location.hash);
  show(link ? +link[1] : data.end);
})();
)js";
}

}  // namespace plumbline::scenarios
