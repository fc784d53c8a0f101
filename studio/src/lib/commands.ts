/** What the page can be told to do, by the names that it is told with. */

export const COMMANDS: [string, string][] = [
  ["share", "Share a link"],
  ["pin", "Pin and compare"],
  ["theme", "Light or dark"],
];

/** What can be saved or copied. */
export const EXPORTS: [string, string][] = [
  ["toml", "Train file with this point"],
  ["command", "The command line that gives the same"],
  ["json", "Answer as JSON"],
  ["csv", "Table as CSV"],
  ["print", "Print, or PDF, of what is seen"],
  ["report", "Report (web page)"],
  ["stick", "Schematic as SVG"],
  ["lever", "Levers as SVG"],
  ["sankey", "Power flow as SVG"],
  ["stick.png", "Schematic as PNG"],
  ["dxf", "Wheels as DXF"],
  ["formula", "Formulas as LaTeX"],
  ["embed", "Frame for a web page"],
];
