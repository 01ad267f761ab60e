// SPDX-License-Identifier: Apache-2.0
// A picture of a page: node shot.mjs PAGE[#LINK] OUT.png WIDTH HEIGHT [dark]. Exit code 1 where the page reports an error.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const [page_and_link, out, width, height, dark] = process.argv.slice(2);
const [file, ...link] = page_and_link.split("#");
const browser = await Browser.start();
const page = await browser.page(+width, +height, { dark: dark === "dark" });
await page.open(pathToFileURL(resolve(file)).href + (link.length ? "#" + link.join("#") : ""));
await page.until("document.readyState === 'complete' && (!document.getElementById('app') || document.body.dataset.ready || document.body.dataset.error)", 300);
await new Promise((done) => setTimeout(done, 300));
await page.picture(out);
const error = (await page.get("document.body.dataset.error || ''")) || page.errors.join("; ");
await browser.close();
if (error) console.error(page_and_link + ": " + error);
process.exit(error ? 1 : 0);
