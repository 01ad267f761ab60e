// SPDX-License-Identifier: Apache-2.0
document.querySelectorAll("[data-copy]").forEach(function (button) {
  "use strict";
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
