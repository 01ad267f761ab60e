// SPDX-License-Identifier: Apache-2.0
// Chromium over its debugging pipe: what the tests of pages need of it, without any package.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** The browser's program, or null where there is none. */
export function chromium() {
  const named = process.env.PLUMBLINE_CHROMIUM;
  if (named) return named;
  const found = (process.env.PATH || "").split(":").flatMap((folder) => ["chromium", "chromium-browser", "google-chrome"].map((name) => join(folder, name)));
  return found.find(existsSync) || null;
}

export class Browser {
  /** flags: more of Chromium's. Drawing is by software, so that every machine can. */
  static async start(flags = []) {
    const browser = new Browser();
    browser.folder = mkdtempSync(join(tmpdir(), "plumbline-browser-"));
    browser.process = spawn(chromium(), ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader", "--hide-scrollbars", "--no-first-run", "--disable-extensions", "--mute-audio", "--remote-debugging-pipe",
      "--user-data-dir=" + browser.folder, ...flags, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    browser.waiting = new Map();
    browser.listeners = [];
    browser.id = 0;
    let rest = "";
    browser.process.stdio[4].setEncoding("utf8");
    browser.process.stdio[4].on("data", (text) => {
      const parts = (rest + text).split("\0");
      rest = parts.pop();
      for (const part of parts) browser.receive(JSON.parse(part));
    });
    return browser;
  }

  receive(message) {
    const pending = this.waiting.get(message.id);
    if (!pending) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    this.waiting.delete(message.id);
    if (message.error) pending.reject(new Error(pending.method + ": " + message.error.message));
    else pending.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.id;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject, method }));
  }

  async page(width = 1100, height = 760, more = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId);
    for (const domain of ["Page", "Runtime", "Network", "Log"]) await page.send(domain + ".enable");
    await page.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: more.mobile === true });
    const features = [{ name: "prefers-color-scheme", value: more.dark ? "dark" : "light" }];
    await page.send("Emulation.setEmulatedMedia", { features });
    if (more.before) await page.send("Page.addScriptToEvaluateOnNewDocument", { source: more.before });
    return page;
  }

  async close() {
    const gone = new Promise((done) => this.process.on("exit", done));
    try { await this.send("Browser.close"); } catch { this.process.kill(); }
    await gone;
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Page {
  constructor(browser, session) {
    this.browser = browser;
    this.session = session;
    this.requests = [];
    this.errors = [];
    browser.listeners.push((message) => {
      if (message.sessionId !== session) return;
      if (message.method === "Network.requestWillBeSent") this.requests.push(message.params.request.url);
      if (message.method === "Runtime.exceptionThrown") this.errors.push(message.params.exceptionDetails.exception?.description || "exception");
      if (message.method === "Log.entryAdded" && message.params.entry.level === "error") this.errors.push(message.params.entry.text);
      if (message.method === "Runtime.consoleAPICalled" && message.params.type === "error")
        this.errors.push(message.params.args.map((a) => a.value || a.description).join(" "));
    });
  }

  send(method, params) { return this.browser.send(method, params, this.session); }

  /** Value of an expression; of a promise, what it gives. */
  async get(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true, userGesture: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }

  async open(url) {
    this.opened = performance.now();
    await this.send("Page.navigate", { url });
  }

  /** Waits until the expression is true. */
  async until(expression, seconds = 120) {
    const end = performance.now() + 1000 * seconds;
    while (!(await this.get(expression).catch(() => false))) {
      if (performance.now() > end) throw new Error("after " + seconds + " s still not: " + expression);
      await new Promise((done) => setTimeout(done, 25));
    }
  }

  async key(key, code = key, text = undefined) {
    await this.send("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", key, code, text });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", key, code });
  }

  async click(x, y) {
    for (const type of ["mousePressed", "mouseReleased"])
      await this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1 });
  }

  async picture(path, whole = false) {
    const { data } = await this.send("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole });
    writeFileSync(path, Buffer.from(data, "base64"));
  }
}
