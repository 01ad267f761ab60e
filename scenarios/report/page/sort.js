// SPDX-License-Identifier: Apache-2.0
// Where columns are out of view, a line says so.
document.querySelectorAll(".scroll").forEach(function (box) {
  "use strict";
  var more = document.createElement("p");
  more.className = "more";
  more.textContent = "The table goes on to the right: scroll it sideways. →";
  box.parentNode.insertBefore(more, box);
  function look() { more.hidden = box.scrollWidth <= box.clientWidth + 1; }
  window.addEventListener("resize", look);
  look();
});
document.querySelectorAll("table.sorted").forEach(function (table) {
  "use strict";
  var heads = table.rows[0].cells;
  function value(row, k) {
    var cell = row.cells[k], text = !cell ? "" : cell.dataset.sort !== undefined ? cell.dataset.sort : cell.textContent.trim(), number = parseFloat(text);
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
