/** What goes between the page and the library. Answers are the contracts of the command line. */

export interface Doc {
  name: string;
  text: string;
  /** Tables that the train file names. */
  files: Record<string, string>;
}

/** What is shown of a train: a gear or elements closed by hand, and an operating point. */
export interface Point {
  state: string | null;
  engaged: string[] | null;
  speeds: Record<string, string>;
  torques: Record<string, string>;
  powers: Record<string, string>;
  fixed: string[];
  /** What else an operation of the file says, such as the power of a store. */
  more: Record<string, unknown>;
}

export interface Boxes {
  width: number;
  stick: number;
  lever: number;
  power: [number, number];
  scale: [number, number, number] | null;
}

export interface Frame {
  width: number;
  aligned: boolean;
  /** How far 1 rad/s reaches on a lever, px. */
  reach: number;
  columns: { name: string; x: number; span: [number, number] }[];
  scale: [number, number, number];
}

export interface Diagnostic {
  code: string;
  severity: "error" | "warning" | "note";
  place: string;
  message: string;
  hints: string[];
  span?: { line: number; column: number; length: number } | null;
  replacement?: unknown;
}

export interface Refusal {
  format: "willis-refusal-1";
  file: string | null;
  diagnostics: Diagnostic[];
  more?: number;
}

export interface State {
  name: string;
  engaged: string[];
  ends: [string | null, string | null];
}

export interface Element {
  name: string;
  kind: string | null;
  members: string[];
}

export interface Facts {
  name: string;
  asDrawn: string;
  members: string[];
  terminals: string[];
  ends: [string | null, string | null];
  states: State[];
  elements: Element[];
  sets: Record<string, any>[];
  operations: Record<string, any>[];
  scenarios: string[];
  quantities: { path: string; value: string | null }[];
  warnings: Diagnostic[];
}

export interface MemberReport {
  speed_rad_s: number | null;
  torque_n_m: number;
  power_w: number;
  role: string;
}

export interface Solution {
  efficiency: number | null;
  input_power_w: number;
  output_power_w: number;
  loss_w: number;
  power_residual_w: number;
  members: Record<string, MemberReport>;
  meshes: Record<string, any>;
  shift_elements: Record<string, any>;
  variators?: Record<string, any>;
  losses_w: Record<string, number>;
  sources?: { name: string; loss_w: number; [more: string]: any }[];
  recirculation: any[];
  margin: any;
  stiction: any[];
}

export interface OperationReport {
  name: string;
  state: string | null;
  degrees_of_freedom: number;
  verdict: string;
  certificate: { unique_for_every_load: boolean; method: string } | null;
  reason: string | null;
  outside_laws?: any[];
  speeds_rad_s: Record<string, number | null>;
  solutions: Solution[];
  dissipative_solutions: Solution[];
}

export interface RatioReport {
  input: string;
  output: string;
  exact: string | null;
  value: number | null;
  no_ratio: string | null;
  step: number | null;
  engaged: string[];
  degrees_of_freedom: number;
  drive: any;
  coast: any;
}

export interface Analysis {
  format: "willis-analysis-1";
  train: string;
  degrees_of_freedom: number;
  ratios: Record<string, RatioReport>;
  operations: OperationReport[];
  assumptions: string[];
  diagnostics: Diagnostic[];
}
