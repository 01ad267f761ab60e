// SPDX-License-Identifier: Apache-2.0
// The replay page in a real browser: node replay_test.mjs RUN NAME, of a run with its recording whose scenario has that name.
// Prints a line a check; exit code 1 when one fails. Times are printed and not judged: they are the machine's.
import { readFileSync, writeFileSync } from "node:fs";
import { createHash } from "node:crypto";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [run, name] = [resolve(process.argv[2]), process.argv[3]];
const page_file = join(run, "replay.html"), url = pathToFileURL(page_file).href;
const results = JSON.parse(readFileSync(join(run, "results.json")));
let failures = 0;
function check(what, passed, seen) {
  console.log((passed ? "passed: " : "FAILED: ") + what + (passed ? "" : "; seen: " + JSON.stringify(seen)));
  if (!passed) ++failures;
}
const equal = (what, seen, expected) => check(what + " is " + JSON.stringify(expected), JSON.stringify(seen) === JSON.stringify(expected), seen);

/** Poses of a TUM file: [t, x, y, z] a line. */
const tum = (file) => readFileSync(join(run, file), "utf8").trim().split("\n").map((line) => line.split(" ").map(Number));

/** Distances in mm of message i of the recording, column by column, from its packets alone. */
function message(i) {
  const bytes = readFileSync(join(run, "recording/lidar.pcap")), packets = 76, columns = [];
  const rings = [0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15]; // of a VLP-16's lasers, in firing order
  let at = 24, n = 0;
  while (at < bytes.length) {
    const size = bytes.readUInt32LE(at + 8), payload = at + 16 + size - 1206;
    at += 16 + size;
    if (size < 1206 || Math.floor(n++ / packets) !== i) continue;
    for (let block = 0; block < 12; ++block)
      for (let half = 0; half < 2; ++half) {
        const column = new Array(16);
        for (let k = 0; k < 16; ++k) column[rings[k]] = 2 * bytes.readUInt16LE(payload + 100 * block + 4 + 48 * half + 3 * k);
        columns.push(column);
      }
  }
  return columns;
}

/** Colours of the picture: how many, share of the commonest, and a hash. */
const picture = `(() => {
  const c = document.getElementById("view"), d = document.createElement("canvas");
  d.width = c.width; d.height = c.height;
  const g = d.getContext("2d", { willReadFrequently: true });
  g.drawImage(c, 0, 0);
  const p = new Uint32Array(g.getImageData(0, 0, d.width, d.height).data.buffer), counts = new Map();
  let hash = 0;
  for (const v of p) { counts.set(v, (counts.get(v) || 0) + 1); hash = (Math.imul(hash, 31) + v) | 0; }
  return { colours: counts.size, most: Math.max(...counts.values()) / p.length, hash };
})()`;
const ready = 'document.body.dataset.ready === "1" || document.body.dataset.error';
const testing = "globalThis.Plumb = { testing: true };";

async function whole(browser) {
  const page = await browser.page(1100, 760, { before: testing });
  await page.open(url);
  await page.until(ready);
  const first_ms = performance.now() - page.opened;
  equal("error of the page", await page.get("document.body.dataset.error || ''"), "");
  equal("heading", await page.get("document.querySelector('h1').textContent"), name);
  equal("title", await page.get("document.title"), name + " · replay");
  check("a hostile name makes no element", await page.get("document.querySelectorAll('b, img').length === 0"), "b or img");
  equal("the view", await page.get("document.body.dataset.view"), "3d");
  equal("requests", page.requests.length, 1);
  equal("fetching is forbidden", await page.get("fetch('https://example.org').then(() => 'went', () => 'forbidden')"), "forbidden");

  check("it opens where there is a scan to see", (await page.get("+document.body.dataset.t")) >= (await page.get("Plumb.app.data.scans.t[0]")) - 0.001,
    await page.get("document.body.dataset.t"));

  // Time: a link, and the error as the trajectories say.
  const truth = tum("truth.tum"), loc = tum("s_graph_localization.tum"), end = results.duration_s, last = loc[loc.length - 1];
  await page.get(`Plumb.app.seek(${last[0] + 0.001})`);
  equal("data-t at the last pose", +(await page.get("document.body.dataset.t")), Math.min(+end.toFixed(3), +(last[0] + 0.001).toFixed(3)));
  const at = truth.reduce((a, b) => (Math.abs(b[0] - last[0]) < Math.abs(a[0] - last[0]) ? b : a));
  const off_cm = 100 * Math.hypot(last[1] - at[1], last[2] - at[2], last[3] - at[3]);
  const shown = parseFloat(await page.get("document.querySelector('[data-now=s_graph_localization]').textContent"));
  check("the error shown is that of the trajectories, to 0.1 cm", Math.abs(shown - off_cm) <= 0.1, [shown, off_cm]);
  const lines = readFileSync(join(run, "s_graph_localization.hypotheses.jsonl"), "utf8").trim().split("\n").map((line) => JSON.parse(line));
  for (const line of [lines[0], lines[lines.length >> 1], lines[lines.length - 1]]) {
    await page.get(`Plumb.app.choose("s_graph_localization"); Plumb.app.seek(${line.stamp_ns * 1e-9})`);
    equal("state at " + (line.stamp_ns * 1e-9).toFixed(2) + " s", await page.get("document.body.dataset.state"), line.state);
  }

  // Scans: the ranges of the packets, and points that lie on the plan at the true pose only.
  const count = await page.get("Plumb.app.data.scans.count");
  check("there are scans", count > 10, count);
  let worst = 0, compared = 0;
  for (let k = 0; k < 20; ++k) {
    const i = Math.floor((k * (count - 1)) / 19);
    const [t, ranges] = await page.get(`Plumb.app.data.scans.ranges(${i}).then((r) => [Plumb.app.data.scans.t[${i}], [...r]])`);
    const sent = message(lines.findIndex((line) => Math.abs(line.stamp_ns * 1e-9 - t) < 0.002)), columns = ranges.length / 16;
    ranges.forEach((range, k2) => {
      const mm = sent[4 * (k2 % columns)]?.[Math.floor(k2 / columns)] ?? 0;
      worst = Math.max(worst, Math.abs(10 * range - mm));
      ++compared;
    });
  }
  check("ranges are those of the packets to half a centimetre", worst <= 5 && compared > 1000, [worst, compared]);
  const residual = (move) => page.get(`(async () => {
    const app = Plumb.app, i = app.data.scans.nearest(${end / 2}), ranges = await app.data.scans.ranges(i);
    const poses = Plumb.data.sweepPoses(app.data.tracks.truth, app.data.scans.t[i], app.data.scans.span);
    for (const pose of poses) pose.p = [pose.p[0] + ${move}, pose.p[1] + ${move}, pose.p[2]];
    const cloud = app.data.scans.points(i, ranges, ...poses);
    return Plumb.median(app.residuals.of(cloud.points, cloud.count));
  })()`);
  const near = await residual(0), far = await residual(1);
  check("the scan lies on the plan at the true pose, median at most 3 cm", near <= 0.03, near);
  check("and does not a metre beside it, three times as far", far > 3 * near && far > 0.05, far);

  // Picture: it shows something, the same thing again, and something else without the scan.
  await page.get(`Plumb.app.seek(${end / 2})`);
  const a = await page.get(picture);
  check("the picture has more than 500 colours", a.colours > 500, a);
  check("the commonest colour covers 10 to 90 % of it", a.most > 0.1 && a.most < 0.9, a);
  await page.get("Plumb.app.seek(1)");
  const b = await page.get(picture);
  check("another time looks otherwise", a.hash !== b.hash, b.hash);
  await page.get(`Plumb.app.seek(${end / 2})`);
  equal("the same time looks the same", (await page.get(picture)).hash, a.hash);
  await page.get("Plumb.app.layer('scan', false)");
  check("the scan is seen", (await page.get(picture)).hash !== a.hash, "the same picture without it");
  await page.get("Plumb.app.layer('scan', true)");

  // Walls that are cut have a solid top, from straight above, where none of their sides is seen.
  const top = await page.get(`(async () => {
    const app = Plumb.app, { faces, storeys } = app.data, middle = (f) => [0, 1].map((k) => (f.p[k] + f.q[k]) / 2), off = [...app.off];
    const whole = (f) => f.s === 0 && f.holes.length === 0, length = (f) => Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1]);
    let best = null;
    for (const f of faces) for (const g of faces) {
      if (f === g || f.wall !== g.wall || !whole(f) || !whole(g) || length(f) < 1) continue;
      const [a, b] = [middle(f), middle(g)], apart = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (apart > 0.05 && apart < 0.5 && !best) best = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    }
    if (!best) return null;
    for (const [key] of app.layers) app.off.add(key);
    app.off.delete("building");
    const z = storeys[0].z + 1.2, camera = app.view.camera6();
    app.view.setCamera6([best[0], best[1] - 0.01, z + 2, best[0], best[1], z]);
    await app.update();
    const gl = document.getElementById("view").getContext("webgl2"), pixel = new Uint8Array(4);
    gl.readPixels(gl.drawingBufferWidth >> 1, gl.drawingBufferHeight >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    app.off = new Set(off);
    app.view.setCamera6(camera);
    await app.update();
    return [...pixel].slice(0, 3);
  })()`);
  check("a wall that is cut has a solid top", !!top && top.every((v, k) => Math.abs(v - [0x38, 0x42, 0x4f][k]) <= 2), top);

  // By element: points on the walls of the plan have their colours, and the legend says so.
  const owners = await page.get(`(async () => { const app = Plumb.app, { cloud } = await app.cloudAt(${end / 2});
    const all = app.residuals.owners(cloud.points, cloud.count), count = (f) => [...all].filter(f).length / all.length;
    return [count((v) => v >= 0), count((v) => v === -1), count((v) => v === -2), new Set(all).size]; })()`);
  check("most points lie on walls, floor or ceiling, and on more than three elements", owners[0] > 0.2 && owners[2] < 0.4 && owners[3] > 4, owners);
  await page.get("document.getElementById('colouring').value = 'element'; document.getElementById('colouring').dispatchEvent(new Event('change')); Plumb.app.update()");
  check("by element it looks otherwise", (await page.get(picture)).hash !== a.hash, "the same picture");
  check("the legend speaks of elements", (await page.get("document.getElementById('legend').textContent")).includes("nothing within 20 cm"), "");
  await page.get("document.getElementById('colouring').value = 'height'; document.getElementById('colouring').dispatchEvent(new Event('change')); Plumb.app.update()");

  // The map cloud: its points lie on the plan. The graph of the plan.
  const before = (await page.get(picture)).hash;
  await page.get("Plumb.app.choose('s_graphs_plus').then(() => Plumb.app.layer('map', true))");
  const mapped = await page.get(`Plumb.data.mapOf(Plumb.app.data, "s_graphs_plus").then((at) => [at.length / 3, Plumb.median(Plumb.app.residuals.of(at, at.length / 3))])`);
  check("the map cloud lies on the plan, median at most 4 cm", mapped[0] > 500 && mapped[1] < 0.04, mapped);
  check("and is seen", (await page.get(picture)).hash !== before, "the same picture");
  await page.get("Plumb.app.layer('map', false)");
  const without = (await page.get(picture)).hash;
  await page.get("Plumb.app.layer('plangraph', true)");
  check("the graph of the plan is seen", (await page.get(picture)).hash !== without, "the same picture");
  const plangraph = await page.get("[Plumb.app.data.plangraph.rooms.length, Plumb.app.data.plangraph.faces.length / 2, Plumb.app.data.plangraph.doors.length / 2]");
  check("it has rooms, faces that bound them and doors", plangraph[0] === 4 && plangraph[1] >= 16 && plangraph[2] === 3, plangraph);
  await page.get("Plumb.app.layer('plangraph', false); Plumb.app.choose('s_graph_localization')");

  // A wall.
  const wall = await page.get("Plumb.app.data.faces[0].wall");
  await page.get(`Plumb.app.select(${JSON.stringify(wall)})`);
  check("a chosen wall is named with its distance", /wall .*points within|no point within/s.test(await page.get("document.getElementById('about').innerText")), wall);
  await page.get("Plumb.app.select('no such <i>')");
  check("an unknown id gives a sentence", (await page.get("document.getElementById('about').textContent")).includes("'no such <i>' is no element"), "");
  await page.get("Plumb.app.select('')");

  // What is taken for what: a match that is made wrong, and a method without matches whose poses are moved.
  const taken = await page.get(`(async () => {
    const app = Plumb.app, set = app.data.beliefs.s_graph_localization.sets.findLast((s) => s[2].length && s[2][0][7].length > 1);
    const [first, second] = set[2][0][7], name = (id) => app.data.faces.find((f) => f.id === id).wall;
    Object.assign(first, { 2: 0, 3: name(second[1][0]) });
    await app.seek(set[0] * 1e-3);
    const seen = { text: app.wrong.innerText, lines: app.moment.displaced.length, taken: name(first[1][0]), truly: first[3] };
    app.wrong.querySelectorAll("button")[1].click();
    await app.update();
    seen.selected = document.body.dataset.selected;
    first[2] = 1;
    return seen;
  })()`);
  check("a wrong match says what it is taken for and what it is", taken.text.includes(taken.taken) && taken.text.includes(taken.truly) && taken.lines === 1, taken);
  equal("its link chooses the true wall", taken.selected, taken.truly);
  const mixed = await page.get(`(async () => {
    const app = Plumb.app, track = app.data.tracks.vgicp, { residuals, faces } = app;
    const move = (d, e) => { for (const k of [0, 1]) for (let i = 0; i < track.t.length; ++i) track.p[k][i] += d[k]; track.e.fill(e); };
    await app.choose("vgicp");
    await app.seek(app.data.end / 2);
    const { cloud } = await app.cloudAt(app.t), seen = new Map();
    for (const owner of residuals.owners(cloud.points, cloud.count)) if (owner >= 0) seen.set(owner, (seen.get(owner) || 0) + 1);
    const most = residuals.names[[...seen].sort((x, y) => y[1] - x[1])[0][0]], f = app.data.faces.find((face) => face.wall === most);
    const e = [f.q[0] - f.p[0], f.q[1] - f.p[1]].map((v) => v / Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1])), n = [-e[1], e[0]];
    // By as much as a parallel wall is away, what lies on the wall seen most comes to lie on that one.
    let out = { rows: 0 };
    for (const g of app.data.faces) {
      const d = n[0] * (g.p[0] - f.p[0]) + n[1] * (g.p[1] - f.p[1]), aside = n[0] * (g.q[0] - g.p[0]) + n[1] * (g.q[1] - g.p[1]);
      if (g.wall === most || out.rows > 0 || Math.abs(aside) > 0.01 || Math.abs(d) < 1) continue;
      move([d * n[0], d * n[1]], Math.abs(d));
      await app.update();
      const { confused, displaced } = app.moment;
      if (confused && confused.rows.some((r) => r.truly === most && r.taken === g.wall))
        out = { rows: confused.rows.length, apart: confused.rows.every((r) => r.taken !== r.truly), lines: displaced.length, text: app.wrong.innerText,
          far: Math.abs(Math.hypot(displaced[0][1][0] - displaced[0][0][0], displaced[0][1][1] - displaced[0][0][1]) - Math.abs(d)) };
      move([-d * n[0], -d * n[1]], 0);
    }
    await app.update();
    out.after = app.wrong.innerText;
    await app.choose("s_graph_localization");
    return out;
  })()`);
  check("a method that names no walls has them by its scan", mixed.rows > 0 && mixed.apart && mixed.lines === mixed.rows && mixed.far < 0.05 && mixed.text.includes("names no walls"), mixed);
  equal("and none where it is right", mixed.after, "");

  // What was built otherwise is named, too: half of the walls that are seen, as if the plan had not had them there.
  const otherwise = await page.get(`(async () => {
    const app = Plumb.app, track = app.data.tracks.vgicp, { scene, faces, storeys, scans } = app.data, whole = app.residuals;
    await app.choose("vgicp");
    await app.seek(app.data.end / 2);
    const { cloud } = await app.cloudAt(app.t), seen = new Map();
    for (const owner of whole.owners(cloud.points, cloud.count)) if (owner >= 0) seen.set(owner, (seen.get(owner) || 0) + 1);
    const wall = whole.names[[...seen].sort((x, y) => y[1] - x[1])[0][0]], f = faces.find((face) => face.wall === wall);
    const length = Math.hypot(f.q[0] - f.p[0], f.q[1] - f.p[1]), n = [-(f.q[1] - f.p[1]) / length, (f.q[0] - f.p[0]) / length];
    const move = (d) => { for (const k of [0, 1]) for (let i = 0; i < track.t.length; ++i) track.p[k][i] += d * n[k]; track.e.fill(Math.abs(d)); };
    const put = (p) => p.map((v, k) => v + 0.6 * n[k % 2]);
    app.residuals = new Plumb.Residuals(faces.map((face) => (face.wall === wall ? { ...face, p: put(face.p), q: put(face.q) } : face)), storeys);
    scene.deviations.push({ text: "moved", id: wall, s: app.moment.storey, planned: [], built: [f.p, f.q].map((p) => p.slice(0, 2).map((v) => 1e3 * v)) });
    move(0.6);
    await app.update();
    const row = app.moment.confused.rows.find((r) => r.truly === wall), out = { row: row && [row.taken === wall, row.built], text: app.wrong.innerText };
    move(-0.6);
    track.e.fill(0);
    scene.deviations.pop();
    app.residuals = whole;
    await app.choose("s_graph_localization");
    return out;
  })()`);
  check("a wall that stands elsewhere than planned is named", JSON.stringify(otherwise.row) === "[true,true]" && otherwise.text.includes("built otherwise"), otherwise);

  // A method that names no walls has a mark where its wrong answer began to slide.
  const slid = await page.get(`(() => {
    const app = Plumb.app, { marks } = app.data.run, before = marks.length, track = app.data.tracks.vgicp, n = track.t.length, from = n >> 2, to = n >> 1;
    for (let i = from; i < to; ++i) track.e[i] = 0.1 + (0.5 * (i - from)) / (to - from);
    marks.push({ t: track.t[to - 1], label: "wrong by more than 0.5 m", kind: "wrong", m: "vgicp" });
    app.addMarks();
    const mark = marks.find((m) => m.label.startsWith("off by more than"));
    const found = mark && { e: track.e[Plumb.data.lastAt(track.t, mark.t)], before: track.e[Plumb.data.lastAt(track.t, mark.t) - 1] };
    app.data.run.marks = marks.filter((m) => m.m !== "vgicp");
    track.e.fill(0);
    return { found, left: app.data.run.marks.length - before };
  })()`);
  check("a mark stands where the error first passes 0.2 m", slid.found && slid.found.e >= 0.2 && slid.found.before < 0.2, slid);
  check("the time line is seen", (await page.get("document.getElementById('linebox').offsetHeight")) > 100, "");

  // Marks: a click on a label goes to its moment.
  const marked = await page.get(`(() => { const app = Plumb.app, line = app.line2; line.layout(); return line.marks.map((m) =>
    [m.t, line.markAt((m.from + m.to) / 2, 15 * m.row + 8).t, m.label.startsWith(m.t.toFixed(2) + " s" + (m.m && app.data.run.methods.length > 1 ? " " + m.m : ""))]); })()`);
  check("labels of marks lead to their moments and give them", marked.length > 0 && marked.every(([t, at, said]) => t === at && said), marked);

  const crowded = await page.get(`(() => { const app = Plumb.app, line = app.line2, { marks } = app.data.run;
    for (let k = 0; k < 30; ++k) marks.push({ t: 0.5 * app.data.end, label: "one of thirty at once", kind: "run", m: "" });
    line.layout();
    const shown = line.marks.filter((m) => m.label !== ""), over = shown.filter((a, i) => shown.some((b, j) => j < i && a.row === b.row && a.from < b.to && a.to > b.from));
    marks.length -= 30;
    line.layout();
    return { over: over.length, shown: shown.length }; })()`);
  check("labels of marks never lie over each other", crowded.over === 0 && crowded.shown >= 5, crowded);

  // A method that has one answer, and a wrong one, shows it: in the time line, beside its name.
  const wrongly = await page.get(`(async () => { const app = Plumb.app, line = app.line2, name = "s_graph_localization", track = app.data.tracks[name];
    const e = track.e.slice(), last = track.t[track.t.length - 1], cell = document.querySelector("[data-now=" + name + "]"), before = line.wrongStretches(name).length;
    for (let i = 0; i < track.t.length; ++i) track.e[i] = i >= track.t.length - 3 ? 3 : 0.01;
    await app.seek(last);
    line.layout();
    const out = { before, stretches: line.wrongStretches(name).map(([a, b]) => Math.round(a - line.x(track.t[track.t.length - 3]))), bad: cell.className };
    track.e.set(e);
    await app.seek(last);
    line.layout();
    return { ...out, after: cell.className }; })()`);
  check("a wrong answer is marked in the time line and beside its name", wrongly.before === 0 && JSON.stringify(wrongly.stretches) === "[0]" && /bad/.test(wrongly.bad) && !/bad/.test(wrongly.after), wrongly);

  // A header that says what failed, a button for the keys, names of tables.
  const header = await page.get("document.querySelector('header').innerText");
  const gate = results.gates.find((g) => !g.passed);
  check("the header names the first gate that failed", header.includes(gate.metric + " of " + gate.method), header);
  const text = await page.get("document.querySelector('header .bad a').textContent");
  check("its value has four digits", /is [0-9.]{1,8}(e-?[0-9]+)?,/.test(text), text);
  check("and links its moment", (await page.get("document.querySelector('header .bad a').getAttribute('href')")) === gate.see.replace("replay.html", ""), gate.see);
  await page.get("document.getElementById('keys').click()");
  equal("a button shows the keys", await page.get("document.getElementById('help').open"), true);
  await page.get("document.getElementById('help').close()");
  equal("tables and status lines without a name", await page.get("[...document.querySelectorAll('table, [role=status]')].filter((e) => !e.getAttribute('aria-label')).length"), 0);

  // Keys, links, the command.
  await page.get("document.getElementById('view').focus()");
  await page.key("Home");
  await page.until("document.body.dataset.t === '0.000'", 60);
  await page.key("ArrowRight");
  await page.until("document.body.dataset.scan === '1'", 60);
  await page.until("location.hash.includes('t=')", 60);
  check("the address says the time", /#t=\d/.test(await page.get("location.hash")), await page.get("location.hash"));
  const command = await page.get("document.getElementById('command').textContent");
  check("the command replays this folder", command.startsWith("plumbline replay ") && command.includes(run.split("/").pop()), command);

  // How long a seek takes: the data alone, and with the picture, behind a read of one pixel.
  const times = await page.get(`(async () => {
    const app = Plumb.app, all = [], data = [], canvas = document.getElementById("view"), gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4);
    let seed = 12345;
    for (let k = 0; k < 40; ++k) {
      seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
      const t = (seed / 2 ** 32) * app.data.end;
      app.data.scans.cache.clear();
      let begin = performance.now();
      await app.cloudAt(t);
      data.push(performance.now() - begin);
      app.data.scans.cache.clear();
      begin = performance.now();
      await app.seek(t);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      all.push(performance.now() - begin);
    }
    return { all: Plumb.median(all), data: Plumb.median(data) };
  })()`);
  console.log("seek: median " + times.all.toFixed(0) + " ms, of it data " + times.data.toFixed(1) + " ms; first picture " + first_ms.toFixed(0) + " ms");
  equal("errors on the console", page.errors.filter((text) => !text.includes("example.org")), []);
}

async function linked(browser) {
  const page = await browser.page(1100, 760);
  await page.open(url + "#t=3.21&m=vgicp&c=residual&off=graph,particles,nonsense&sel=north&unknown=1");
  await page.until(ready);
  equal("time of a link", await page.get("document.body.dataset.t"), "3.210");
  equal("method of a link", await page.get("Plumb.app.m"), "vgicp");
  equal("colour of a link", await page.get("document.getElementById('colouring').value"), "residual");
  equal("layers of a link", await page.get("[...Plumb.app.off].sort().join()"), "graph,particles");
  equal("wall of a link", await page.get("document.body.dataset.selected"), "north");
  await page.get("location.hash = '#t=9999'");
  await page.until("+document.body.dataset.t > 5", 60);
  equal("a time beyond the end is the end", await page.get("+document.body.dataset.t"), await page.get("Plumb.app.data.end"));
  equal("errors on the console", page.errors, []);
}

/** Two methods side by side: the second picture is a frame that follows the time and the camera. */
async function beside(browser) {
  const page = await browser.page(1300, 760, { before: testing });
  await page.open(url + "#t=2&m=vgicp");
  await page.until(ready);
  await page.get("document.getElementById('beside').value = 's_graph_localization'; document.getElementById('beside').dispatchEvent(new Event('change'))");
  await page.until("Plumb.app.beside.ready", 120);
  const apart = await page.get("[document.body.dataset.apart, document.getElementById('apart').textContent]");
  check("it says where the two are first apart", apart[0] === "" ? /never more|cannot be compared/.test(apart[1]) : apart[1].includes(parseFloat(apart[0]).toFixed(2)), apart);
  const said = await page.get(`(() => { const app = Plumb.app, { tracks } = app.data, kept = tracks.vgicp, says = (t, change) => {
      const some = [...kept.t.keys()].filter((i) => kept.t[i] >= t), cut = (a) => Float64Array.from(some, (i) => a[i]);
      tracks.one = { ...kept, t: cut(kept.t), e: cut(kept.e), lost: cut(kept.lost).fill(change), p: kept.p.map(cut), q: kept.q.map(cut) };
      return app.beside.firstApart("vgicp", "one"); };
    const all = [says(1e9, 0), says(kept.t[0], 1), says(kept.t[0], 0)];
    delete tracks.one;
    return all; })()`);
  equal("without a pose of one method nothing is compared", [said[0].t, said[0].text], [null, "vgicp and one cannot be compared: one gives no single pose."]);
  check("which of the two is lost is said", said[1].t !== null && said[1].text.includes("one says that it is LOST and vgicp does not"), said[1]);
  check("what is the same is never apart", said[2].t === null && said[2].text.includes("never more"), said[2]);
  equal("the list offers other methods alone", await page.get("[...document.getElementById('beside').options].map((o) => o.value).includes(Plumb.app.m)"), false);
  const frames = (await page.send("Page.getFrameTree", {})).frameTree.childFrames || [];
  equal("frames beside it", frames.length, 1);
  const { executionContextId } = await page.send("Page.createIsolatedWorld", { frameId: frames[0].frame.id });
  const inside = async (expression) => (await page.send("Runtime.evaluate", { expression, contextId: executionContextId, returnByValue: true })).result.value;
  await page.get("Plumb.app.seek(3.5).then(() => { Plumb.app.view.setCamera6([1, -9, 9, 2, 2, 0]); Plumb.app.dirty(); Plumb.app.beside.send(); })");
  let seen = null;
  for (let k = 0; k < 200; ++k) {
    seen = [await inside("document.body.dataset.t"), await inside("document.body.className"), await inside("document.getElementById('caption').textContent.split(':')[0]")];
    if (seen[0] === "3.500") break;
    await new Promise((done) => setTimeout(done, 50));
  }
  equal("the frame shows the same time, its picture alone, and the other method", seen, ["3.500", "embed", "s_graph_localization"]);
  equal("requests", new Set(page.requests.map((r) => r.replace(/[?#].*/, ""))).size, 1);
  await page.get("Plumb.app.choose('s_graph_localization')");
  equal("no method stands beside itself", await page.get("[Plumb.app.beside.name, document.getElementById('beside').value]"), ["", ""]);
  await page.get("Plumb.app.beside.open(null, '../' + encodeURIComponent(decodeURIComponent(location.pathname).split('/').at(-2)) + '/replay.html', true)");
  await page.until("Plumb.app.beside.ready && Plumb.app.beside.run", 120);
  await page.get("Plumb.app.update()");
  const of = name + ", seed " + results.seed;
  check("the other run is named in the list and above the picture", await page.get(`document.getElementById('beside').selectedOptions[0].textContent === ${JSON.stringify("run " + of)}
    && document.getElementById('caption').textContent.startsWith(${JSON.stringify(of + ": ")})`), await page.get("[document.getElementById('beside').selectedOptions[0].textContent, document.getElementById('caption').textContent]"));
  const other = (await page.send("Page.getFrameTree", {})).frameTree.childFrames[0].frame.id, world = await page.send("Page.createIsolatedWorld", { frameId: other });
  const above = async () => (await page.send("Runtime.evaluate", { expression: "document.getElementById('caption').textContent", contextId: world.executionContextId, returnByValue: true })).result.value;
  for (let k = 0; k < 200 && !(await above()).startsWith(of); ++k) await new Promise((done) => setTimeout(done, 50));
  check("and above the other picture", (await above()).startsWith(of), await above());
  equal("a page of elsewhere is no run", await page.get("Plumb.app.beside.open(null, 'https://example.org/replay.html', true) || Plumb.app.beside.name"), "");
  equal("errors on the console", page.errors, []);
}

async function narrow(browser) {
  const page = await browser.page(390, 844, { mobile: true, dark: true, before: testing });
  await page.open(url);
  await page.until(ready);
  const widths = await page.get("[document.documentElement.scrollWidth, innerWidth]");
  check("390 px need no scrolling sideways", widths[0] <= 390, widths);
  const small = await page.get("[...document.querySelectorAll('#bar button, #copy')].map((b) => b.getBoundingClientRect().height).filter((h) => h < 44).length");
  equal("buttons lower than 44 px", small, 0);
  check("dark is dark", (await page.get("getComputedStyle(document.body).backgroundColor")) === "rgb(20, 24, 30)", "");
  const edges = await page.get(`(() => { const layer = Plumb.app.labels, { clientWidth: w, clientHeight: h } = layer, box = layer.getBoundingClientRect();
    const places = [[1, 1], [w - 1, h / 3], [2, h - 1], [w / 2, h / 2]], rooms = places.map((middle, i) => ({ name: "a room with a long name " + i, middle }));
    Plumb.placeLabels(layer, { off: new Set(), rooms: [...rooms, { name: "outside", middle: [-40, 30] }] }, (p) => [...p]);
    const seen = [...layer.children].filter((s) => s.style.display !== "none").map((s) => s.getBoundingClientRect());
    return [seen.length, seen.filter((r) => r.left < box.left || r.right > box.right || r.top < box.top || r.bottom > box.bottom).length]; })()`);
  equal("labels at the edge, and those that it cuts", edges, [4, 0]);
  check("the phone's picture shows something", (await page.get(picture)).colours > 200, "");
}

async function without(browser) {
  const flat = await browser.page(900, 700, { before: testing });
  await flat.open(url);
  await flat.until(ready);
  equal("without WebGL the view", await flat.get("document.body.dataset.view"), "2d");
  equal("error of the page", await flat.get("document.body.dataset.error || ''"), "");
  await flat.get(`Plumb.app.seek(${results.duration_s / 2})`);
  check("the plan from above shows something", (await flat.get(picture)).colours > 20, "");
  equal("errors on the console", flat.errors.filter((text) => !/webgl/i.test(text)), []);
}

async function damaged(browser) {
  const old = await browser.page(900, 700, { before: "delete globalThis.DecompressionStream;" });
  await old.open(url);
  await old.until(ready);
  check("a browser that cannot unpack says so", (await old.get("document.body.innerText")).includes("cannot unpack"), "");
  const cut = join(run, "cut.html"), text = readFileSync(page_file, "utf8");
  writeFileSync(cut, text.replace(/(id="tracks">.{40}).*?</, "$1<"));
  const page = await browser.page(900, 700);
  await page.open(pathToFileURL(cut).href);
  await page.until(ready);
  check("a damaged block is named", (await page.get("document.body.innerText")).includes("'tracks'"), await page.get("document.body.innerText"));
}

/** The same canvas in two browsers. */
async function hashOf() {
  const browser = await Browser.start();
  try {
    const page = await browser.page(700, 500, { before: testing });
    await page.open(url + "#t=4");
    await page.until(ready);
    return createHash("sha256").update(await page.get("document.getElementById('view').toDataURL()")).digest("hex");
  } finally {
    await browser.close();
  }
}

for (const [flags, parts] of [[[], [whole, linked, beside, narrow, damaged]], [["--disable-3d-apis"], [without]]]) {
  const browser = await Browser.start(flags);
  try {
    for (const part of parts) await part(browser);
  } catch (error) {
    check(error.stack, false, "an exception");
  } finally {
    await browser.close();
  }
}
equal("the picture of another browser", await hashOf(), await hashOf());
console.log(failures ? failures + " checks failed" : "all checks passed");
process.exit(failures ? 1 : 0);
