// SPDX-License-Identifier: Apache-2.0
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("data").textContent);
  var slider = document.getElementById("time"), clock = document.getElementById("clock");
  var play = document.getElementById("play"), timer = null;
  var cursors = document.querySelectorAll(".cursor");

  var half = 0.006; // times are whole hundredths of a second, the end is not

  function at(track, t) {
    var lo = 0, hi = track.t.length - 1;
    if (hi < 0 || t < track.t[0] - 0.2) return null;
    while (lo < hi) {
      var mid = (lo + hi + 1) >> 1;
      if (track.t[mid] <= t + half) lo = mid; else hi = mid - 1;
    }
    return { k: lo, x: track.x[lo], y: track.y[lo], yaw: track.yaw[lo], s: track.s[lo], e: track.e ? track.e[lo] : 0,
             lost: track.lost ? track.lost[lo] === 1 : false };
  }
  // Whether the sample before t is so old that curves are drawn open.
  function isOver(track, p, t) { return t - track.t[p.k] >= track.gap; }
  function stateAt(name, t) {
    var list = data.states[name] || [], found = "";
    list.forEach(function (change) { if (change[0] <= t + half) found = change[1]; });
    return found;
  }
  function said(name, t) {
    var p = at(data.tracks[name], t), state = stateAt(name, t);
    if (!p) return "no single answer yet" + (state ? ", " + state : "");
    if (p.lost) return "says that it is LOST";
    if (isOver(data.tracks[name], p, t)) return "no pose since " + data.tracks[name].t[p.k].toFixed(1) + " s" + (state ? ", " + state : "");
    return (p.e < 1 ? (p.e * 100).toFixed(1) + " cm" : p.e.toFixed(2) + " m") + " off" + (state ? ", " + state : "");
  }
  // What a curve of a plot is at t, as text; "" where it is nothing.
  function value(plot, series, t) {
    var v = null;
    if (series.column) {
      var p = at(data.tracks[series.name], t);
      if (p && p.lost) return "LOST";
      if (p && !isOver(data.tracks[series.name], p, t)) v = data.tracks[series.name][series.column][p.k];
    } else {
      series.steps.forEach(function (step) { if (step[0] <= t + half) v = step[1]; });
    }
    return v === null ? "" : (plot.scale * v).toFixed(plot.decimals) + (plot.unit ? " " + plot.unit : "");
  }
  function legends(t) {
    Object.keys(data.plots).forEach(function (id) {
      var plot = data.plots[id], figure = document.getElementById(id);
      if (!figure) return;
      figure.querySelectorAll("[data-series]").forEach(function (b) {
        b.textContent = value(plot, plot.series[+b.dataset.series], t);
      });
    });
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
    var x = 1000 * (data.end > 0 ? t / data.end : 0);
    legends(t);
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
    var frame = one.querySelector(".frame"), plot = data.plots[one.id];
    function timeAt(event) {
      var box = frame.getBoundingClientRect();
      return (event.clientX - box.left) / box.width * data.end;
    }
    one.addEventListener("pointermove", function (event) {
      var t = timeAt(event), lines = [t.toFixed(1) + " s"];
      tip.style.display = t >= 0 && t <= data.end ? "" : "none";
      if (plot) plot.series.forEach(function (series) {
        var text = value(plot, series, t);
        if (text) lines.push(series.name + ": " + text);
      });
      Object.keys(data.states).forEach(function (name) { lines.push(name + ": " + stateAt(name, t)); });
      tip.textContent = lines.join("\n");
      tip.style.left = Math.max(0, Math.min(event.clientX + 12, innerWidth - tip.offsetWidth - 8)) + "px";
      tip.style.top = Math.min(event.clientY + 12, innerHeight - tip.offsetHeight - 8) + "px";
    });
    one.addEventListener("pointerleave", function () { tip.style.display = "none"; });
    one.addEventListener("click", function (event) { if (timeAt(event) >= 0) show(timeAt(event)); });
  });
  var byError = document.getElementById("byerror");
  byError.addEventListener("change", function () { document.body.classList.toggle("byerror", byError.checked); });
  document.addEventListener("keydown", function (event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|BUTTON|SELECT|SUMMARY|TH|svg)$/.test(event.target.tagName)) return;
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
