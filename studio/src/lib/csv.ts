/** Tables of the library's answers. */

export interface Table {
  /** Where an answer has several. */
  name: string;
  head: string[];
  rows: string[][];
}

/** Cells of a line; quotes are doubled within quotes. */
function cells(line: string): string[] {
  const all: string[] = [];
  const cell = /(?:"((?:[^"]|"")*)"|([^,]*))(,|$)/gy;
  for (let m = cell.exec(line); m; m = cell.exec(line)) {
    all.push(m[1] !== undefined ? m[1].replaceAll('""', '"') : (m[2] ?? ""));
    if (m[3] !== ",") break;
  }
  return all;
}

/** Tables have a heading `# name` where there are several, and an empty line between. */
export function tables(csv: string): Table[] {
  const all: Table[] = [];
  let now: Table | null = null;
  let name = "";
  for (const line of csv.split("\n")) {
    if (line === "") now = null;
    else if (!now && line.startsWith("# ")) name = line.slice(2);
    else if (!now) all.push((now = { name, head: cells(line), rows: [] }));
    else now.rows.push(cells(line));
  }
  return all;
}
