// Pictures of the studio for book and README: `node studio/picture.mjs PAGE.html FOLDER` writes frames of a lever that is dragged,
// and one of the whole page. `img2webp -loop 0 -lossy -q 60 -m 6 -d 90 FOLDER/frame-*.png -o book/src/figures/studio.webp` makes the
// picture of them.
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [page_file, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
// Drawn at three quarters: 1024 by 576 px.
const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, deviceScaleFactor: 0.75 });
await page.goto(pathToFileURL(resolve(page_file)).href);
await page.waitForFunction(() => window.__ready === true);
await page.evaluate(() => {
  const point = { state: "3", engaged: null, speeds: { input: "2000 rpm" }, torques: { input: "300 N m" }, powers: {}, fixed: [], more: {} };
  window.__studio.open(window.__studio.doc, point);
});
await page.waitForTimeout(1500);
await page.screenshot({ path: join(folder, "page.png") });
const dot = await page.locator('#levers [id^="levers-speed-member-c1r4-mesh-P1"]').boundingBox();
const [x, y] = [dot.x + dot.width / 2, dot.y + dot.height / 2];
await page.mouse.move(x, y);
await page.mouse.down();
const steps = 30;
for (let k = 0; k < steps; k++) {
  await page.mouse.move(x - 15 * Math.sin((2 * Math.PI * k) / steps) ** 2 * Math.sign(Math.sin((2 * Math.PI * k) / steps)), y);
  await page.waitForTimeout(60);
  await page.screenshot({ path: join(folder, `frame-${String(k).padStart(2, "0")}.png`) });
}
await page.mouse.up();
await browser.close();
