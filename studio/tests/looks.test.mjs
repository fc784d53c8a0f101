// Sizes, alignment, colours, and what a machine can say about access for everyone.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { browser, file, open, root, shown, studio } from "./studio.mjs";

let at;
before(async () => {
  at = await browser();
});
after(() => at?.close());

const SIZES = [
  [375, 667],
  [768, 1024],
  [1366, 650],
  [1366, 768],
  [1920, 1080],
  [2560, 1440],
];

/** What is wrong with the page as it is shown. */
function wrong_with(page) {
  return page.evaluate(() => {
    const wrong = [];
    const [width, height] = [innerWidth, innerHeight];
    const top = document.scrollingElement;
    if (top.scrollWidth > width) wrong.push(`the page scrolls sideways: ${top.scrollWidth} of ${width}`);
    const visible = (e) => e.checkVisibility({ opacityProperty: true, visibilityProperty: true });
    const inside = (e) => {
      const r = e.getBoundingClientRect();
      return r.width > 0 && r.left >= -0.5 && r.right <= width + 0.5 && r.top >= -0.5 && r.bottom <= height + 0.5;
    };
    // On a phone the answer line says all three.
    const heads = width < 720 ? [".hero .big", ".hero .v"] : ["#verdict", "#efficiency", "#assumed"];
    for (const name of heads) {
      const e = document.querySelector(name);
      if (!e || !visible(e) || !inside(e)) wrong.push(`${name} is not in the viewport`);
    }
    const small = new Map();
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const e = walk.currentNode.parentElement;
      if (!walk.currentNode.data.trim() || !e || e.closest("script,style,.vh,title,desc") || !visible(e)) continue;
      const svg = e.closest("svg");
      const m = svg && e.getScreenCTM?.();
      const scale = m ? Math.hypot(m.b, m.d) : 1;
      const size = parseFloat(getComputedStyle(e).fontSize) * scale;
      if (size < 9.95) small.set(`${size.toFixed(1)} px: ${(svg?.closest("section")?.id ?? e.className) || e.tagName}`, walk.currentNode.data.trim().slice(0, 30));
    }
    for (const [what, text] of [...small].slice(0, 6)) wrong.push(`${what} "${text}"`);
    return wrong;
  });
}

/** x of each set on the screen, in the schematic and in the levers. */
function columns(page) {
  return page.evaluate(() => {
    const frame = window.__studio.view.frame;
    const x = (panel) => {
      const svg = document.querySelector(`${panel} svg.fig`);
      const r = svg.getBoundingClientRect();
      const box = svg.viewBox.baseVal;
      return { left: r.left, scale: r.width / (box?.width || r.width) };
    };
    const [stick, lever] = [x("#train"), x("#levers")];
    return frame.columns.map((c) => ({ name: c.name, stick: stick.left + c.x * stick.scale, lever: lever.left + c.x * lever.scale, aligned: frame.aligned }));
  });
}

for (const [width, height] of SIZES) {
  test(`${width} x ${height}`, { timeout: 60_000 }, async () => {
    const page = await studio(at, { width, height });
    const wrong = await wrong_with(page);
    for (const c of await columns(page)) {
      if (c.aligned && Math.abs(c.stick - c.lever) > 1) wrong.push(`${c.name}: x ${c.stick.toFixed(1)} in the schematic, ${c.lever.toFixed(1)} in the levers`);
    }
    // A pan of one is a pan of the other.
    const panned = await page.evaluate(async () => {
      const [a, b] = ["#train .pan", "#levers .pan"].map((s) => document.querySelector(s));
      if (a.scrollWidth <= a.clientWidth + 1) return null;
      a.scrollLeft = 40;
      await new Promise((done) => setTimeout(done, 200));
      return [a.scrollLeft, b.scrollLeft];
    });
    if (panned && Math.abs(panned[0] - panned[1]) > 1) wrong.push(`panned by ${panned[0]}, the levers by ${panned[1]}`);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/${width}x${height}.png` });
    await page.context().close();
    assert.deepEqual(wrong, []);
  });
}

test("every figure of the shelf fits at 1366 x 768", { timeout: 240_000 }, async () => {
  const page = await studio(at);
  const wrong = [];
  for (const name of ["simpson-ford-c4.toml", "prius-hybrid.toml", "wolfrom-236.toml", "two-mode-split.toml", "fva-planetary-stage.toml", "aisin-tl-80sn.toml"]) {
    await open(page, name);
    wrong.push(...(await wrong_with(page)).map((w) => `${name}: ${w}`));
  }
  await page.context().close();
  assert.deepEqual(wrong, []);
});

test("targets are large enough", async () => {
  for (const [hasTouch, least] of [[false, 24], [true, 24]]) {
    const page = await studio(at, hasTouch ? { hasTouch, width: 375, height: 667, isMobile: true } : {});
    const small = await page.evaluate((least) => {
      const all = [...document.querySelectorAll("button, [role=radio], [role=tab], [role=button], select, input:not([hidden])")];
      const seen = all.filter((e) => e.checkVisibility({ visibilityProperty: true }) && e.getClientRects().length > 0);
      const low = seen.filter((e) => {
        const r = (e.querySelector(".halo") ?? e).getBoundingClientRect();
        return Math.min(r.width, r.height) < least - 0.5;
      });
      return low.map((e) => `${e.id || e.getAttribute("aria-label") || e.textContent.trim().slice(0, 24)}: ${Math.round(e.getBoundingClientRect().width)} x ${Math.round(e.getBoundingClientRect().height)}`);
    }, least);
    await page.context().close();
    assert.deepEqual(small, []);
  }
});

for (const theme of ["light", "dark"]) {
  test(`axe finds nothing serious, ${theme}`, { timeout: 120_000 }, async () => {
    const page = await studio(at, { bypassCSP: true, colorScheme: theme });
    await page.evaluate(file("studio/node_modules/axe-core/axe.min.js"));
    const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
    const serious = found.violations.filter((v) => ["serious", "critical"].includes(v.impact));
    const told = serious.map((v) => `${v.id}: ${v.help}; ${v.nodes.length}: ${v.nodes.slice(0, 3).map((n) => n.target.join(" ")).join(" | ")}`);
    await page.context().close();
    assert.deepEqual(told, []);
  });
}

test("the focus is always seen", async () => {
  const page = await studio(at);
  const hidden = [];
  await page.evaluate(() => document.activeElement?.blur());
  for (let k = 0; k < 60; k++) {
    await page.keyboard.press("Tab");
    const told = await page.evaluate(() => {
      const e = document.activeElement;
      if (!e || e === document.body) return null;
      const r = e.getBoundingClientRect();
      const s = getComputedStyle(e);
      const ring = s.outlineStyle !== "none" && parseFloat(s.outlineWidth) > 0;
      // A mark of a figure has a halo, within it or beside it.
      const beside = [e.previousElementSibling, e.nextElementSibling].find((n) => n?.classList.contains("halo"));
      const halo = e.querySelector(".halo") ?? beside;
      const drawn = halo && !["none", "transparent", "rgba(0, 0, 0, 0)"].includes(getComputedStyle(halo).stroke);
      const outside = r.bottom < 0 || r.top > innerHeight || r.right < 0 || r.left > innerWidth;
      const name = e.id || e.getAttribute("aria-label") || e.textContent.trim().slice(0, 20);
      return outside || !(ring || drawn) ? `${name}${outside ? " is outside" : " has no ring"}` : null;
    });
    if (told) hidden.push(told);
  }
  await page.context().close();
  assert.deepEqual([...new Set(hidden)], []);
});

test("with reduced motion nothing animates", async () => {
  const page = await studio(at);
  await page.click('[data-gear="4"]');
  const running = await page.evaluate(() => document.getAnimations().filter((a) => a.playState === "running" && a.effect?.getComputedTiming().duration > 1).length);
  await shown(page);
  await page.context().close();
  assert.equal(running, 0);
});

test("paper: four panels and the table, light, within the sheet", { timeout: 60_000 }, async () => {
  const page = await studio(at, { colorScheme: "dark" });
  await page.click('[data-gear="3"]');
  await shown(page);
  // A4 landscape less its margins.
  await page.setViewportSize({ width: 1047, height: 718 });
  await page.emulateMedia({ media: "print" });
  await shown(page);
  const told = await page.evaluate(() => {
    const box = (e) => e.getBoundingClientRect();
    const seen = [...document.querySelectorAll("main > section, .paper")].map((e) => [e.id || e.className.split(" ")[0], box(e).width > 100 && box(e).height > 10]);
    const wide = [...document.querySelectorAll("main svg.fig, .paper table")].filter((e) => box(e).right > innerWidth + 1).length;
    return { seen, wide, rows: document.querySelectorAll(".paper table tr").length, theme: document.documentElement.dataset.theme, bar: box(document.querySelector("header.top")).height };
  });
  assert.deepEqual(told.seen.filter(([, is]) => !is), []);
  assert.equal(told.seen.length, 6);
  assert.deepEqual([told.wide, told.theme, told.bar], [0, "light", 0]);
  assert.ok(told.rows > 8);
  // Figures follow the size of the sheet a moment later than the sheet itself.
  await page.waitForFunction(() => document.documentElement.scrollHeight <= innerHeight, null, { timeout: 20_000 });
  const pdf = await page.pdf({ preferCSSPageSize: true, printBackground: true });
  if (process.env.PICTURES) writeFileSync(`${process.env.PICTURES}/paper.pdf`, pdf);
  assert.equal(pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length, 1, "pages");
  await page.context().close();
});

test("every loss is listed, and together they are all that is lost", { timeout: 120_000 }, async () => {
  const page = await studio(at);
  for (const name of ["two-mode-split.toml", "prius-hybrid.toml", "zf-8hp70.toml", "wang-herringbone-physical.toml"]) {
    await open(page, name);
    await shown(page);
    const told = await page.evaluate(() => {
      const rows = [...document.querySelectorAll(".paper table")].at(-1).querySelectorAll("tbody tr td:last-child");
      const s = window.__studio.solution;
      return { parts: [...rows].reduce((sum, td) => sum + parseFloat(td.textContent), 0), whole: (100 * s.loss_w) / s.input_power_w };
    });
    // Three figures each.
    assert.ok(Math.abs(told.parts - told.whole) < 0.01 * told.whole, `${name}: ${told.parts} of ${told.whole} %`);
  }
  await page.context().close();
});

for (const scheme of ["light", "dark"]) {
  test(`forced colours, ${scheme}: members are told apart and stand out`, { timeout: 60_000 }, async () => {
    const page = await studio(at, { forcedColors: "active", colorScheme: scheme });
    const { canvas, members, text } = await page.evaluate(() => {
      const hex = (c) => "#" + (c.match(/\d+/g) ?? []).slice(0, 3).map((x) => Number(x).toString(16).padStart(2, "0")).join("");
      const dots = [...document.querySelectorAll('#levers circle[id^="levers-speed-"]')].map((d) => [d.dataset.member, hex(getComputedStyle(d).fill)]);
      return { canvas: hex(getComputedStyle(document.querySelector("#train")).backgroundColor), members: [...new Map(dots)], text: hex(getComputedStyle(document.querySelector("#why dd")).color) };
    });
    assert.ok(members.length >= 7);
    const wrong = members.filter(([, c]) => contrast(c, canvas) < 3).map(([m, c]) => `${m}: ${c} on ${canvas}`);
    assert.equal(new Set(members.map(([, c]) => c)).size, members.length, "each member its own colour");
    assert.ok(contrast(text, canvas) > 7);
    if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/forced-${scheme}.png` });
    await page.context().close();
    assert.deepEqual(wrong, []);
  });
}

/** Blocks of a picture, 48 by 27 greys: faces and hinting of a machine make no difference to them, a lost panel does. */
async function blocks(page, png) {
  return page.evaluate(async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: 48, height: 27 });
    const draw = canvas.getContext("2d");
    draw.imageSmoothingQuality = "high";
    // Halving keeps every pixel in the mean.
    let from = await createImageBitmap(image);
    while (from.width > 96) from = await createImageBitmap(from, { resizeWidth: Math.ceil(from.width / 2), resizeHeight: Math.ceil(from.height / 2), resizeQuality: "medium" });
    draw.drawImage(from, 0, 0, 48, 27);
    const { data } = draw.getImageData(0, 0, 48, 27);
    return Array.from({ length: 48 * 27 }, (_, k) => Math.round((data[4 * k] + data[4 * k + 1] + data[4 * k + 2]) / 3));
  }, `data:image/png;base64,${png.toString("base64")}`);
}

test("the page looks as it did", { timeout: 120_000 }, async () => {
  const path = join(root, "studio/tests/looks.json");
  const known = existsSync(path) ? JSON.parse(readFileSync(path, "utf8")) : {};
  const now = {};
  const wrong = [];
  for (const [name, width, height, colorScheme] of [["laptop", 1366, 768, "light"], ["dark", 1366, 768, "dark"], ["phone", 375, 667, "light"], ["wide", 1920, 1080, "light"]]) {
    const page = await studio(at, { width, height, colorScheme });
    await page.evaluate(() => window.__studio.gear("3"));
    await shown(page);
    const boxes = await page.$$eval("header.top, main > section, .drawer, .ptabs", (all) =>
      Object.fromEntries(all.filter((e) => e.getClientRects().length > 0).map((e) => [e.id || e.className.split(" ")[0], ["x", "y", "width", "height"].map((k) => Math.round(e.getBoundingClientRect()[k]))])),
    );
    now[name] = { boxes, blocks: (await blocks(page, await page.screenshot())).map((x) => x.toString(16).padStart(2, "0")).join("") };
    await page.context().close();
    const was = known[name];
    if (!was) continue;
    for (const [panel, box] of Object.entries(was.boxes)) {
      const own = now[name].boxes[panel];
      if (!own || box.some((x, k) => Math.abs(x - own[k]) > 6)) wrong.push(`${name}: ${panel} at ${own}, not ${box}`);
    }
    const pixel = (text, k) => parseInt(text.slice(2 * k, 2 * k + 2), 16);
    const far = Array.from({ length: 48 * 27 }, (_, k) => Math.abs(pixel(was.blocks, k) - pixel(now[name].blocks, k))).sort((a, b) => a - b);
    const [mean, most] = [far.reduce((a, b) => a + b) / far.length, far[Math.floor(0.98 * far.length)]];
    console.log(`${name}: mean difference ${mean.toFixed(2)} of 255, 98 % below ${most}`);
    if (mean > 6 || most > 60) wrong.push(`${name}: mean difference ${mean.toFixed(2)}, 98 % below ${most}`);
  }
  if (process.env.LOOKS) writeFileSync(path, JSON.stringify(now, null, 1) + "\n");
  else assert.deepEqual(Object.keys(known), Object.keys(now), "LOOKS=1 writes studio/tests/looks.json");
  assert.deepEqual(wrong, []);
});

// Colours, from the tokens of the page's own style.

const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
const rgb = (hex) => [1, 3, 5].map((k) => linear(parseInt((hex.length === 4 ? hex.replace(/[^#]/g, "$&$&") : hex).slice(k, k + 2), 16) / 255));
const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const contrast = (a, b) => {
  const [x, y] = [luminance(rgb(a)), luminance(rgb(b))].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
};
const times = (m, v) => m.map((row) => row.reduce((sum, x, k) => sum + x * v[k], 0));
// Machado, Oliveira and Fernandes 2009, severity 1.
const SIGHT = {
  normal: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protan: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deutan: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritan: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};
function oklab(c) {
  const [l, m, s] = times([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566], [0.0883024619, 0.2817188376, 0.6299787005]], c.map((x) => Math.min(1, Math.max(0, x)))).map(Math.cbrt);
  return times([[0.2104542553, 0.793617785, -0.0040720468], [1.9779984951, -2.428592205, 0.4505937099], [0.0259040371, 0.7827717662, -0.808675766]], [l, m, s]);
}

test("colours of members are told apart, and text stands out, in both themes", async () => {
  const page = await studio(at);
  const wrong = [];
  for (const theme of ["light", "dark"]) {
    const tokens = await page.evaluate((theme) => {
      document.documentElement.dataset.theme = theme;
      const style = getComputedStyle(document.documentElement);
      const names = ["bg", "panel", "raise", "sunk", "fg", "fg-2", "fg-3", "act", "on-act", "good", "good-soft", "warn", "warn-soft", "bad", "bad-soft", "loss"];
      return Object.fromEntries([...names, ...Array.from({ length: 8 }, (_, k) => `m-${k}`)].map((n) => [n, style.getPropertyValue(`--${n}`).trim()]));
    }, theme);
    for (let a = 0; a < 8; a++) {
      const own = contrast(tokens[`m-${a}`], tokens.panel);
      if (own < 3) wrong.push(`${theme} m-${a}: ${own.toFixed(2)} on its ground`);
      for (let b = 0; b < a; b++) {
        for (const [sight, matrix] of Object.entries(SIGHT)) {
          const [p, q] = [a, b].map((k) => oklab(times(matrix, rgb(tokens[`m-${k}`]))));
          const far = Math.hypot(...p.map((x, k) => x - q[k]));
          if (far < 0.06) wrong.push(`${theme} m-${a} and m-${b}: ${far.toFixed(3)} apart, ${sight}`);
        }
      }
    }
    const pairs = [["fg", "panel"], ["fg", "bg"], ["fg-2", "panel"], ["fg-3", "panel"], ["fg-2", "sunk"], ["act", "panel"], ["on-act", "act"], ["good", "good-soft"], ["warn", "warn-soft"], ["bad", "bad-soft"]];
    for (const [text, ground] of pairs) {
      const own = contrast(tokens[text], tokens[ground]);
      if (own < 4.5) wrong.push(`${theme} ${text} on ${ground}: ${own.toFixed(2)}`);
    }
  }
  await page.context().close();
  assert.deepEqual(wrong, []);
});
