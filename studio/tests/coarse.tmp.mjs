import { browser, open, studio } from "./studio.mjs";
const at = await browser();
const page = await studio(at);
await page.evaluate(() => {
  window.__log = [];
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (m, ...r) {
    if (m?.question) { window.__log.push([performance.now(), "post " + m.question + (m.request.coarse ? " coarse" : "")]);
      if (!this.__heard) { this.__heard = true; this.addEventListener("message", (e) => e.data.done && window.__log.push([performance.now(), "done"])); } }
    return post.call(this, m, ...r);
  };
});
const [how, ...trains] = process.argv.slice(2);
for (const name of trains) {
  await open(page, name + ".toml");
  for (const tab of ["Map", "Band"]) {
    const found = page.locator("[role=tab]", { hasText: tab }).first();
    if ((await found.getAttribute("aria-selected")) !== "true" || (await page.locator("#drawer-view").isHidden())) await found.click();
    const m = await page.evaluate(async (how) => {
      const s = window.__studio;
      const all = [];
      await new Promise((d) => setTimeout(d, 4000));
      const original = s.doc.text;
      let log = "";
      for (let k = 0; k < 9; k++) {
        window.__log.length = 0;
        const began = performance.now();
        if (how === "type") s.type(original + "\n# " + k + "\n");
        else { const loads = s.point.torques; const m = Object.keys(loads)[0] ; const p = { ...s.point, torques: { ...loads } };
          if (m) p.torques[m] = parseFloat(loads[m]) * (1 + 3e-3 * (k + 1)) + " N m"; else { const pw = {...s.point.powers}; const q = Object.keys(pw)[0]; pw[q] = parseFloat(pw[q]) * (1 + 3e-3*(k+1)) + " " + String(pw[q]).split(" ")[1]; p.powers = pw; }
          s.move(p, "x"); s.refresh(); }
        const sync = performance.now() - began;
        let coarse = null;
        while (performance.now() - began < 4000) {
          await new Promise((d) => { const c = new MessageChannel(); c.port1.onmessage = d; c.port2.postMessage(0); });
          const texts = [...document.querySelectorAll(".picture .busy")].map((e) => e.textContent);
          if (texts.some((t) => t.startsWith("coarse"))) { coarse = performance.now() - began; break; }
          if (performance.now() - began > 300 && !window.__log.length) break;
        }
        all.push(coarse === null ? -1 : Math.round(coarse));
        log = `sync ${sync.toFixed(0)} ` + window.__log.map(([t, w]) => `${w} ${(t - began).toFixed(0)}`).join(", ");
        await new Promise((d) => setTimeout(d, 1200));
      }
      s.type(original);
      return all.join(" ") + " | " + log;
    }, how);
    console.log(name, tab, m);
  }
}
await at.close();
