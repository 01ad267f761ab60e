// SPDX-License-Identifier: Apache-2.0
// What a replay page costs: node measure.mjs PAGE prints megabytes, scans kept, scans of the run, and in ms the first picture, the median
// of 40 seeks with their picture (behind a read of one pixel), and of their data alone; separated by tabs. Drawing is by software.
import { statSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const file = resolve(process.argv[2]);
const browser = await Browser.start();
const page = await browser.page(1100, 760, { before: "globalThis.Plumb = { testing: true };" });
await page.open(pathToFileURL(file).href);
await page.until("document.body.dataset.ready === '1' || document.body.dataset.error");
const first = performance.now() - page.opened;
const error = await page.get("document.body.dataset.error || ''");
const cost = error ? null : await page.get(`(async () => {
  const app = Plumb.app, all = [], data = [], canvas = document.getElementById("view"), gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4);
  for (let k = 0, seed = 12345; k < 40; ++k) {
    seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
    const t = (seed / 2 ** 32) * app.data.end;
    for (const [list, work] of [[data, () => app.cloudAt(t)], [all, () => app.seek(t)]]) {
      app.data.scans.cache.clear();
      const begin = performance.now();
      await work();
      if (gl) gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      list.push(performance.now() - begin);
    }
  }
  return [app.data.scans.count, app.data.scans.all, Plumb.median(all), Plumb.median(data)];
})()`);
await browser.close();
if (error) console.error(process.argv[2] + ": " + error);
else console.log([(statSync(file).size / 1e6).toFixed(1), cost[0], cost[1], first.toFixed(0), cost[2].toFixed(0), cost[3].toFixed(1)].join("\t"));
process.exit(error ? 1 : 0);
