// SPDX-License-Identifier: Apache-2.0
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
      text.removeAttribute("transform");
      var r = text.getBBox(), beyond = r.x + r.width + 2 * px - map.whole.x - map.whole.width;
      if (beyond > 0) {  // the map would cut it off
        text.setAttribute("transform", "translate(" + -beyond + " 0)");
        r.x -= beyond;
      }
      var over = taken.some(function (o) {
        return r.x < o.x + o.width && o.x < r.x + r.width && r.y < o.y + o.height && o.y < r.y + r.height;
      });
      if (over || (text.dataset.room && r.width > +text.dataset.room)) text.style.display = "none";
      else taken.push(r);
    });
  }
  function fitAll() { document.querySelectorAll(".map").forEach(fit); }
  window.addEventListener("resize", fitAll);
  document.querySelectorAll("details.fold").forEach(function (fold) {
    fold.open = innerWidth > 780;  // as the style has it: a phone
    fold.addEventListener("toggle", fitAll);
  });
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
    // Where the pointer is, and what is there.
    var said = document.createElement("p");
    said.className = "at";
    said.textContent = "\u00a0";
    map.parentNode.insertBefore(said, map.nextSibling);
    function tell(event) {
      var p = place(map, event), shape = event.target, title = shape.querySelector(":scope > title");
      if (!title && shape.parentNode.tagName === "g") title = shape.parentNode.querySelector(":scope > title");
      said.textContent = "x " + p[0].toFixed(2) + " m, y " + (-p[1]).toFixed(2) + " m" + (title ? ": " + title.textContent : "");
    }
    map.addEventListener("pointermove", tell);
    map.addEventListener("pointerdown", tell);
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
