// SPDX-License-Identifier: Apache-2.0
// What every page but the replay keeps to, in a real browser: node pages_test.mjs PAGE... Contrast of all text in both schemes, a phone's
// width without scrolling sideways, every control by keyboard, one request, no error; of a report also its plots and its time line.
// Prints a line a check; exit code 1 when one fails.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

let failures = 0;
function check(what, passed, seen) {
  console.log((passed ? "passed: " : "FAILED: ") + what + (passed ? "" : "; seen: " + JSON.stringify(seen)));
  if (!passed) ++failures;
}

/** Of every text that is shown: its colour against what lies under it [WCAG 2.2, 1.4.3]; the ones below 4.5. */
const faint = `(() => {
  const parse = (c) => { const v = c.match(/[\\d.]+/g).map(Number); return v.length < 4 ? [...v, 1] : v; };
  const light = (c) => { const l = (v) => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    return 0.2126 * l(c[0]) + 0.7152 * l(c[1]) + 0.0722 * l(c[2]); };
  const room = (() => { const probe = document.createElement("i"); probe.style.color = "var(--room)"; document.body.append(probe);
    const c = parse(getComputedStyle(probe).color); probe.remove(); return c; })();
  function under(element) {
    for (let e = element; e; e = e.parentElement) {
      if (e.classList && e.classList.contains("map")) return room;
      const c = parse(getComputedStyle(e).backgroundColor);
      if (c[3] === 1) return c;
    }
    return [255, 255, 255, 1];
  }
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), found = [];
  let texts = 0;
  while (walker.nextNode()) {
    const text = walker.currentNode.textContent.trim(), e = walker.currentNode.parentElement;
    if (!text || /^(SCRIPT|STYLE|title)$/.test(e.tagName) || e.closest(".over") || e.getClientRects().length === 0) continue;
    ++texts;
    const style = getComputedStyle(e), ink = parse(e.namespaceURI.endsWith("svg") ? style.fill : style.color);
    const [a, b] = [light(ink), light(under(e))].sort((x, y) => x - y), ratio = (b + 0.05) / (a + 0.05);
    if (ratio < 4.5) found.push(text.slice(0, 40) + ": " + ratio.toFixed(2));
  }
  return { texts, found: found.slice(0, 8) };
})()`;
const sideways = `(() => {
  const wide = [];
  if (document.documentElement.scrollWidth > 390) wide.push("the page: " + document.documentElement.scrollWidth);
  document.querySelectorAll("*").forEach((e) => {
    if (/auto|scroll/.test(getComputedStyle(e).overflowX) && e.clientWidth > 0 && e.scrollWidth > e.clientWidth + 1)
      wide.push(e.tagName + "." + e.className + ": " + e.scrollWidth + " in " + e.clientWidth);
  });
  return wide.slice(0, 5);
})()`;

async function everyPage(browser, url, name) {
  for (const dark of [false, true]) {
    const page = await browser.page(1200, 900, { dark });
    await page.open(url);
    await page.until("document.readyState === 'complete'");
    await page.get("document.querySelectorAll('details').forEach((d) => { d.open = true; })");
    const seen = await page.get(faint);
    check(name + ": text has a contrast of 4.5 in the " + (dark ? "dark" : "light") + " scheme", seen.texts > 5 && seen.found.length === 0, seen);
    check(name + ": one request, no error", page.requests.length === 1 && page.errors.length === 0, [page.requests, page.errors]);
    const wanted = await page.get(`document.querySelectorAll("button, input, select, summary, a[href], .map, table.sorted th").length`);
    const reached = new Set();
    for (let i = 0; i < 2 * wanted + 20; ++i) {
      await page.key("Tab");
      const at = await page.get(`(() => { const all = [...document.querySelectorAll("button, input, select, summary, a[href], .map, table.sorted th")];
        return all.indexOf(document.activeElement); })()`);
      if (at >= 0) reached.add(at);
      if (reached.size === wanted) break;
    }
    check(name + ": Tab reaches all of its " + wanted + " controls", reached.size === wanted, reached.size);
  }
  const commands = await browser.page(1200, 900);
  await commands.open(url);
  await commands.until("document.readyState === 'complete'");
  const cut = await commands.get("[...document.querySelectorAll('[data-copy]')].map((b) => b.dataset.copy).filter((c) => c.includes(' --page ') && !c.includes(' -o '))");
  check(name + ": commands of a sweep name its folder", cut.length === 0, cut);
  const hidden = await commands.get(`(() => { document.querySelectorAll("details").forEach((d) => { d.open = true; });
    return [...document.querySelectorAll(".scroll")].filter((s) => s.scrollWidth > s.clientWidth + 1 && !(s.previousElementSibling && s.previousElementSibling.classList.contains("more"))).length; })()`);
  check(name + ": where columns are out of view a hint says so", hidden === 0, hidden);
  const phone = await browser.page(390, 844, { mobile: true });
  await phone.open(url);
  await phone.until("document.readyState === 'complete'");
  await phone.get("document.querySelectorAll('details').forEach((d) => { d.open = true; })");
  const cutOff = await phone.get(`[...document.querySelectorAll(".map text")].filter((t) => { if (t.getClientRects().length === 0) return false;
    const r = t.getBoundingClientRect(), m = t.closest(".map").getBoundingClientRect(); return r.left < m.left - 1 || r.right > m.right + 1; }).map((t) => t.textContent)`);
  check(name + ": no text of a map is cut off at 390 px", cutOff.length === 0, cutOff);
  const empty = await phone.get(`[...document.querySelectorAll("table.stacked td")].filter((d) => d.getClientRects().length && /^[-–]?$/.test(d.textContent.trim()) && !d.children.length).length`);
  check(name + ": a phone shows no empty values", empty === 0, empty);
  const heading = await phone.get(`[...document.querySelectorAll("table.stacked td:first-child:not([data-head])")].filter((d) => d.getClientRects().length).every((d) => {
    const range = document.createRange(); range.selectNodeContents(d); return range.getBoundingClientRect().left - d.getBoundingClientRect().left < 2; })`);
  check(name + ": headings of rows stand left on a phone", heading, heading);
  const nameless = await phone.get(`[...document.querySelectorAll("table, [role=status]")].filter((e) => !e.getAttribute("aria-label")).length`);
  check(name + ": tables have names", nameless === 0, nameless);
  const wide = await phone.get(sideways);
  check(name + ": nothing scrolls sideways at 390 px", wide.length === 0, wide);
}

async function report(browser, url, name) {
  const ended = await browser.page(1200, 900);
  await ended.open(url);
  await ended.until("document.readyState === 'complete'");
  const late = await ended.get(`(() => { const d = JSON.parse(document.getElementById("data").textContent), wrong = [];
    for (const [m, track] of Object.entries(d.tracks)) {
      const k = track.t.length - 1, now = document.getElementById("now-" + m);
      if (!now || k < 0 || d.end - track.t[k] > 0.01) continue;
      const cm = 100 * track.e[k], said = track.lost[k] ? "LOST" : cm < 100 ? cm.toFixed(1) + " cm" : track.e[k].toFixed(2) + " m";
      if (!now.textContent.includes(said)) wrong.push(m + ": " + now.textContent + " for " + said);
    }
    return wrong; })()`);
  check(name + ": opens at the end with the last answer of each method", late.length === 0, late);
  const page = await browser.page(1200, 900);
  await page.open(url + "#t=2.00");
  await page.until("document.readyState === 'complete'");
  const clock = () => page.get("document.getElementById('clock').textContent");
  check(name + ": opens at the time of its link", (await clock()) === "2.0 s", await clock());
  await page.key("ArrowRight");
  check(name + ": an arrow key steps", (await clock()) === "2.5 s", await clock());
  const data = await page.get("JSON.parse(document.getElementById('data').textContent)");
  const methods = Object.keys(data.tracks).filter((m) => m !== "truth"), track = data.tracks[methods[0]];
  await page.get("document.getElementById('errors').scrollIntoView()");
  const box = await page.get("(() => { const b = document.querySelector('#errors .frame').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()");
  const t = 0.5 * data.end, x = box[0] + 0.5 * box[2], y = box[1] + 0.5 * box[3];
  await page.send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y });
  const k = track.t.filter((v) => v <= t).length - 1, expected = methods[0] + ": " + (100 * track.e[k]).toFixed(1) + " cm";
  const tip = await page.get("document.querySelector('.tip').textContent");
  check(name + ": the tip over a plot names the error there", tip.includes(expected), [tip, expected]);
  await page.click(x, y);
  check(name + ": a click on a plot goes there", Math.abs(parseFloat(await clock()) - t) < 0.15, await clock());
  const legend = await page.get("document.querySelector('#errors-x [data-series]').textContent");
  check(name + ": the legend holds the value of now", legend === (100 * track.ex[k]).toFixed(1) + " cm", [legend, track.ex[k]]);
  await page.get("document.getElementById('byerror').click()");
  const shown = await page.get("['.errorpath', '.path'].map((s) => getComputedStyle(document.querySelector(s)).display)");
  check(name + ": paths by error in place of paths by method", shown[0] !== "none" && shown[1] === "none", shown);
}

const browser = await Browser.start();
for (const file of process.argv.slice(2)) {
  const url = pathToFileURL(resolve(file)).href, name = file.replace(/.*\//, "");
  await everyPage(browser, url, name);
  if (name === "report.html") await report(browser, url, name);
}
await browser.close();
process.exit(failures > 0 ? 1 : 0);
