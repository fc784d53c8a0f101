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
  /** Which of several equilibria is shown. */
  answer: number;
  /** The member from which powers are seen; else the housing. */
  seen_from: string | null;
  /** How many times wider losses are drawn than power; else as wide as they can be seen. */
  losses: number | null;
}

/** What of the page a link keeps besides file and point. */
export type Look = Pick<Boxes, "answer" | "seen_from" | "losses">;

export interface Frame {
  width: number;
  aligned: boolean;
  /** How far 1 rad/s reaches on a lever, px. */
  reach: number;
  columns: { name: string; x: number; span: [number, number] }[];
  scale: [number, number, number];
  /** How many times wider losses are drawn than power. */
  widened?: number;
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

/** What a train is with some elements closed. */
export interface Closed {
  /** The gear of the shift table. */
  state: string | null;
  ends: [string | null, string | null];
  /** Members whose speeds settle all others. */
  speeds: string[];
  /** Terminals of which a torque is given while the others balance the train. */
  torques: string[];
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
  /** What acts in a scenario, and on which member. */
  sources: Record<string, { name: string; member: string }[]>;
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
  /** Of an iteration over computed losses. */
  convergence: any;
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
