// SPDX-License-Identifier: Apache-2.0
// Where the estimate is at the time shown; the clock tells when that changes.
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("data").textContent);
  var clock = document.getElementById("clock"), now = document.getElementById("now");
  var name = now.dataset.method, track = data.tracks[name], states = data.states[name] || [];
  function tell() {
    var t = parseFloat(clock.textContent), k = -1, state = "", half = 0.06;  // the clock shows tenths
    for (var i = 0; i < track.t.length && track.t[i] <= t + half; i++) k = i;
    states.forEach(function (change) { if (change[0] <= t + half) state = change[1]; });
    var text = "at " + t.toFixed(1) + " s: ";
    if (k < 0 || t - track.t[k] > track.gap) text += "no single pose";
    else {
      text += "x " + track.x[k].toFixed(2) + " m, y " + track.y[k].toFixed(2) + " m, heading " +
        (track.yaw[k] * 180 / Math.PI).toFixed(0) + "°";
      if (track.e && track.e[k] !== null) text += ", " + (100 * track.e[k]).toFixed(1) + " cm from the reference";
      if (track.lost[k] === 1 && state !== "LOST") state = "LOST";
    }
    now.textContent = text + (state ? ", " + state : "");
  }
  new MutationObserver(tell).observe(clock, { childList: true, characterData: true, subtree: true });
  tell();
})();
