// SPDX-License-Identifier: Apache-2.0
// Commands of a sweep's page, and buttons that copy them. The page knows its folder, which is the sweep's -o, only where it is opened.
(function () {
  "use strict";
  function shell(word) { return /^[\w\-./=+,:@%]+$/.test(word) ? word : "'" + word.replace(/'/g, "'\\''") + "'"; }
  function whole(command) {
    var at = command.lastIndexOf(" --page ");
    if (location.protocol !== "file:" || at < 0) return command;
    var folder = decodeURIComponent(location.pathname.replace(/\/[^/]*$/, "")) || "/";
    return command.slice(0, at) + " -o " + shell(folder) + command.slice(at);
  }
  document.querySelectorAll("code.command").forEach(function (code) { code.textContent = whole(code.textContent); });
  document.querySelectorAll("[data-copy]").forEach(function (button) {
    button.dataset.copy = whole(button.dataset.copy);
    button.addEventListener("click", function () {
      function select() {
        var range = document.createRange(), text = button.parentNode.querySelector("code");
        if (!text) return;
        range.selectNodeContents(text);
        getSelection().removeAllRanges();
        getSelection().addRange(range);
        button.textContent = "Selected";
      }
      try {
        navigator.clipboard.writeText(button.dataset.copy).then(function () { button.textContent = "Copied"; }, select);
      } catch (error) { select(); }
    });
  });
})();
