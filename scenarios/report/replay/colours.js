// SPDX-License-Identifier: Apache-2.0
// Colours that stay apart for colour-blind readers (Okabe and Ito), and scales for points. sRGB, 0 to 255.
"use strict";

Plumb.colours = (() => {
  const right = [0, 158, 115], wrong = [213, 94, 0];
  const states = ["#E69F00", "#F0E442", "#009E73", "#D55E00"]; // SEARCHING, AMBIGUOUS, CONVERGED, LOST
  const dark = () => matchMedia("(prefers-color-scheme: dark)").matches;
  // Dark violet over teal to yellow: even steps of lightness.
  const even = [[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81], [253, 231, 37]];
  // Residuals: blue where they are small, over pale, to vermilion.
  const far = [[0, 114, 178], [86, 180, 233], [240, 228, 66], [230, 159, 0], [213, 94, 0]];
  function along(scale, share) {
    const s = Math.min(1, Math.max(0, share)) * (scale.length - 1), k = Math.min(scale.length - 2, Math.floor(s)), f = s - k;
    return scale[k].map((v, i) => v + f * (scale[k + 1][i] - v));
  }
  /** Colours of points, three bytes each. how: height, ring or residual. */
  function ofPoints(how, cloud, floor, rings, residuals) {
    const out = new Uint8Array(3 * cloud.count), tables = { height: even, ring: even, residual: far };
    const table = [];
    for (let k = 0; k < 64; ++k) table.push(along(tables[how], k / 63));
    for (let i = 0; i < cloud.count; ++i) {
      const share = how === "ring" ? cloud.ring[i] / Math.max(1, rings - 1)
        : how === "residual" ? residuals[i] / Plumb.Residuals.most : (cloud.points[3 * i + 2] - floor) / 2.8;
      const c = table[Math.round(63 * Math.min(1, Math.max(0, share)))];
      out[3 * i] = c[0];
      out[3 * i + 1] = c[1];
      out[3 * i + 2] = c[2];
    }
    return out;
  }
  // Walls and objects: colours of Okabe and Ito and their darker kin, without vermilion and grey, which stand for none.
  const kinds = [[0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [150, 130, 0], [106, 61, 154],
    [0, 84, 130], [0, 104, 80], [150, 80, 120]];
  const elsewhere = [[150, 156, 164], [213, 94, 0]]; // floors and ceilings; nothing of the plan
  /** By what each point lies on: index of an element, -1: a floor or ceiling, -2: nothing. */
  function ofElements(owners) {
    const out = new Uint8Array(3 * owners.length);
    owners.forEach((owner, i) => out.set(owner >= 0 ? kinds[owner % kinds.length] : elsewhere[-1 - owner], 3 * i));
    return out;
  }
  const css = (c) => "rgb(" + c.map((v) => Math.round(v)).join(",") + ")";
  return { right, wrong, states, dark, ofPoints, ofElements, elsewhere, css, along, even, far };
})();
