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
.maps{display:grid;grid-template-columns:repeat(auto-fit,minmax(380px,1fr));gap:12px}
.storey{margin:0 0 4px;font-weight:600}
.map text{font-size:.36px;fill:#6b7889;paint-order:stroke;stroke:#f8fafc;stroke-width:.12px}
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
.verdict{font-weight:700}.verdict.good{color:var(--good)}.verdict.bad{color:var(--bad)}
.controls{display:flex;align-items:center;gap:12px;margin-top:10px}
.controls input[type=range]{flex:1}
button{font:inherit;border:1px solid var(--line);background:#fff;border-radius:8px;padding:4px 14px;cursor:pointer}
.clock{font-variant-numeric:tabular-nums;min-width:64px;text-align:right}
.plot text{font-size:11px;fill:var(--soft)}
.plot .grid{stroke:var(--line);stroke-width:1}
.plot .curve{fill:none;stroke-width:1.6}
.plot .mark{stroke:#5d6b7c;stroke-width:1}
.plot .marked{fill:#1c2430}
.plot .inband{fill:#fff;font-weight:600}
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
details summary{cursor:pointer;color:var(--soft)}
code{font:12.5px ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
.key{display:flex;flex-wrap:wrap;gap:4px 18px;color:var(--soft);margin:8px 0 0;font-size:13px}
.swatch{display:inline-block;width:14px;height:10px;border-radius:2px;margin-right:6px}
.key svg{width:34px;height:10px;display:inline-block;vertical-align:middle;margin-right:6px}
)css";
}

std::string_view page_script() {
  return R"js(
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("data").textContent);
  var slider = document.getElementById("time"), clock = document.getElementById("clock");
  var play = document.getElementById("play"), timer = null;
  var cursors = document.querySelectorAll(".cursor"), plot = document.getElementById("errors");

  function at(track, t) {
    var lo = 0, hi = track.t.length - 1;
    if (hi < 0 || t < track.t[0] - 0.2) return null;
    while (lo < hi) {
      var mid = (lo + hi + 1) >> 1;
      if (track.t[mid] <= t) lo = mid; else hi = mid - 1;
    }
    return { x: track.x[lo], y: track.y[lo], yaw: track.yaw[lo], s: track.s[lo], e: track.e ? track.e[lo] : 0 };
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
      if (now) now.textContent = p ? "now " + (p.e * 100).toFixed(1) + " cm off" : "no single answer yet";
    });
    var x = data.plot.x0 + (data.plot.x1 - data.plot.x0) * (data.end > 0 ? t / data.end : 0);
    cursors.forEach(function (c) { c.setAttribute("x1", x); c.setAttribute("x2", x); });
  }
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
  if (plot) plot.addEventListener("click", function (event) {
    var box = plot.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * data.plot.w;
    show((x - data.plot.x0) / (data.plot.x1 - data.plot.x0) * data.end);
  });
  var link = /t=([0-9.]+)/.exec(location.hash);
  show(link ? +link[1] : data.end);
})();
)js";
}

}  // namespace plumbline::scenarios
