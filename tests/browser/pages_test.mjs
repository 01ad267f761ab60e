// SPDX-License-Identifier: Apache-2.0
// What every page keeps to, in a real browser: node pages_test.mjs PAGE... Contrast of all text in both schemes, a phone's width without
// scrolling sideways and not too many screens of it, every control by keyboard, one request, no error; of a report also its plots and its
// time line, of a replay the marks of SLAM that is far off and its scale of errors. replay_test.mjs has the rest of the replay.
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
    if (!text || /^(SCRIPT|STYLE|title)$/.test(e.tagName) || e.closest(".over, #labels") || e.getClientRects().length === 0) continue;
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

const loaded = "document.readyState === 'complete' && (!document.getElementById('app') || document.body.dataset.ready === '1')";
/** What Tab stops at: of radio buttons of one name at one; what is not shown, at none. */
const controls = `[...document.querySelectorAll("button, input, select, summary, a[href], .map, table.sorted th, #view")].filter((e) =>
  e.getClientRects().length > 0 && !e.disabled && (e.type !== "radio" || e.checked))`;
const screens = 9; // that a page is long on a phone, as it opens

async function everyPage(browser, url, name) {
  for (const dark of [false, true]) {
    const page = await browser.page(1200, 900, { dark });
    await page.open(url);
    await page.until(loaded);
    await page.get("document.querySelectorAll('details').forEach((d) => { d.open = true; })");
    const seen = await page.get(faint);
    check(name + ": text has a contrast of 4.5 in the " + (dark ? "dark" : "light") + " scheme", seen.texts > 5 && seen.found.length === 0, seen);
    check(name + ": one request, no error", page.requests.length === 1 && page.errors.length === 0, [page.requests, page.errors]);
    const wanted = await page.get(controls + ".length");
    const reached = new Set();
    for (let i = 0; i < 2 * wanted + 20; ++i) {
      await page.key("Tab");
      const at = await page.get(controls + ".indexOf(document.activeElement)");
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
  await phone.until(loaded);
  const long = (await phone.get("document.documentElement.scrollHeight")) / 844;
  check(name + ": is at most " + screens + " screens long on a phone", long <= screens, long);
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
  const methods = Object.keys(data.tracks).filter((m) => m !== "truth");
  const last = (m, t) => data.tracks[m].t.filter((v) => v <= t).length - 1;
  const has = (m, t) => last(m, t) >= 0 && t - data.tracks[m].t[last(m, t)] < 0.5;
  const share = [0.5, 0.6, 0.7, 0.8, 0.9].find((f) => methods.some((m) => has(m, f * data.end)));
  const t = share * data.end, at = (m) => last(m, t);
  const series = methods.findIndex((m) => has(m, t)), track = data.tracks[methods[series]];
  await page.get("document.getElementById('errors').scrollIntoView()");
  const box = await page.get("(() => { const b = document.querySelector('#errors .frame').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()");
  const x = box[0] + share * box[2], y = box[1] + 0.5 * box[3];
  await page.send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y });
  const k = at(methods[series]), expected = methods[series] + ": " + (100 * track.e[k]).toFixed(1) + " cm";
  const tip = await page.get("document.querySelector('.tip').textContent");
  check(name + ": the tip over a plot names the error there", tip.includes(expected), [tip, expected]);
  await page.click(x, y);
  check(name + ": a click on a plot goes there", Math.abs(parseFloat(await clock()) - t) < 0.15, await clock());
  const legend = await page.get("document.querySelector('#errors-x [data-series=\"" + series + "\"]').textContent");
  check(name + ": the legend holds the value of now", legend === (100 * track.ex[k]).toFixed(1) + " cm", [legend, track.ex[k]]);
  await page.get("document.getElementById('byerror').click()");
  const shown = await page.get("['.errorpath', '.path'].map((s) => getComputedStyle(document.querySelector(s)).display)");
  check(name + ": paths by error in place of paths by method", shown[0] !== "none" && shown[1] === "none", shown);
}

async function replay(browser, url, name) {
  const page = await browser.page(1200, 900, { before: "globalThis.Plumb = { testing: true };" });
  await page.open(url);
  await page.until(loaded);
  const opened = await page.get(`(() => { const of = (kinds) => Plumb.app.data.run.marks.find((m) => kinds.includes(m.kind));
    return { t: +document.body.dataset.t, slip: of(["wrong", "lost", "failure", "gate"]) ? undefined : (of(["slip"]) || {}).t }; })()`);
  check(name + ": opens where SLAM slipped, where nothing else failed", opened.slip === undefined || Math.abs(opened.t - opened.slip) < 0.2, opened);
  const far = await page.get(`(async () => { const app = Plumb.app, { run, tracks } = app.data, wrong = [];
    for (const method of run.methods.filter((m) => !m.localizes)) {
      const track = tracks[method.name], i = track.t.findIndex((t, k) => Plumb.data.isWrong(app.data, track, k));
      const of = (kind) => run.marks.find((m) => m.m === method.name && m.kind === kind), first = i < 0 ? undefined : track.t[i];
      if ((of("far") || {}).t !== first || Boolean(of("slip")) !== i >= 0) wrong.push([method.name, first, of("far"), of("slip")]);
      if (i < 0) continue;
      await app.seek(first + 0.001);
      if (!document.querySelector("[data-now=" + method.name + "]").classList.contains("bad")) wrong.push(method.name + " has no colour");
    }
    return wrong; })()`);
  check(name + ": SLAM has marks where it is first far off and where it slipped, and only then", far.length === 0, far);
  const scale = await page.get(`(() => { const app = Plumb.app, line = app.line2;
    const most = Object.entries(app.data.tracks).filter(([n]) => n !== "truth").map(([, t]) => Math.max(...t.e.filter((e, i) => t.lost[i] < 0.5))).filter(Number.isFinite).sort((a, b) => a - b);
    return { top: line.top, most }; })()`);
  const median = scale.most[(scale.most.length - 1) >> 1];
  check(name + ": the median method takes a fifth of the height of the errors or more", scale.top <= Math.max(0.01, 5 * median), scale);
}

const browser = await Browser.start();
for (const file of process.argv.slice(2)) {
  const url = pathToFileURL(resolve(file)).href, name = file.replace(/.*\//, "");
  await everyPage(browser, url, name);
  if (name === "report.html") await report(browser, url, name);
  if (name === "replay.html") await replay(browser, url, name);
}
await browser.close();
process.exit(failures > 0 ? 1 : 0);
