/** Numbers as the studio shows them: four figures, a true minus, thin spaces from 10 000, never an exponent. */

export const RPM = 30 / Math.PI;
const MINUS = "\u2212";
const THIN = "\u2009";

function grouped(whole: string): string {
  return whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, THIN);
}

/** So many significant figures, without trailing zeros; whole parts are never cut. */
export function figures(x: number | null | undefined, count = 4): string {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : `${MINUS}∞`;
  const size = Math.abs(x);
  if (size < 1e-12) return "0";
  const decimals = Math.min(20, Math.max(0, count - 1 - Math.floor(Math.log10(size))));
  let text = size.toFixed(decimals);
  if (text.includes(".")) text = text.replace(/\.?0+$/, "");
  if (Number(text) === 0) return "0";
  const [whole, part] = text.split(".");
  return `${x < 0 ? MINUS : ""}${grouped(whole ?? "")}${part ? `.${part}` : ""}`;
}

/** A speed in rpm, from rad/s: whole from 100 up. */
export function rpm(w: number | null | undefined): string {
  if (w === null || w === undefined) return "–";
  const n = w * RPM;
  return Math.abs(n) >= 100 ? figures(Math.round(n), 9) : figures(n, 4);
}

/** An efficiency in %, two decimals, three above 99.9. */
export function percent(eta: number | null | undefined): string {
  if (eta === null || eta === undefined) return "–";
  const text = (100 * eta).toFixed(eta > 0.999 && eta < 1 ? 3 : 2);
  return text.replace("-", MINUS);
}

const PREFIXES: [number, string][] = [
  [1e6, "MW"],
  [1e3, "kW"],
  [1, "W"],
  [1e-3, "mW"],
];

/** A power in W with the prefix that suits it. */
export function watts(p: number | null | undefined): string {
  if (p === null || p === undefined) return "–";
  const size = Math.abs(p);
  const [factor, unit] = PREFIXES.find(([f]) => size >= f) ?? (size > 0 ? [1e-3, "mW"] : [1, "W"]);
  return `${figures(p / (factor as number))} ${unit}`;
}

export function torque(t: number | null | undefined): string {
  if (t === null || t === undefined) return "–";
  return Math.abs(t) >= 1e4 ? `${figures(t / 1e3)} kN m` : `${figures(t)} N m`;
}

/** A number with its unit as a train file writes it: the shortest decimal that reads back the same. */
export function plain(x: number): string {
  const text = String(x);
  return text.includes("e") ? x.toFixed(12).replace(/\.?0+$/, "") : text;
}

/** The number before a unit. */
export function value(text: string | undefined): number | null {
  const read = text === undefined ? null : /^\s*([-+]?[\d.]+(?:e[-+]?\d+)?)/i.exec(text);
  return read ? Number(read[1]) : null;
}

const PER_SI: Record<string, number> = {
  rpm: Math.PI / 30,
  "1/min": Math.PI / 30,
  "rad/s": 1,
  "N m": 1,
  Nm: 1,
  "kN m": 1e3,
  "mN m": 1e-3,
};

/** What a quantity of an operating point is in SI; null where its unit is not a common one. */
export function si(text: string | undefined): number | null {
  const number = value(text);
  const unit = text?.replace(/^\s*[-+]?[\d.]+(?:e[-+]?\d+)?\s*/i, "").trim();
  const factor = unit === undefined ? undefined : PER_SI[unit];
  return number === null || factor === undefined ? null : number * factor;
}

/** A number rounded to a step that suits a drag over a range: 1, 2 or 5 times a power of ten. */
export function rounded(x: number, range: number): number {
  const raw = Math.abs(range) / 400;
  if (!(raw > 0)) return x;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw) ?? power;
  return Number((Math.round(x / step) * step).toPrecision(12));
}
