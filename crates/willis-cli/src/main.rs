//! `willis`: reads files, calls the library, prints.

mod compare;
mod csv;
mod export;
mod cycle;
mod draw;
mod flow;
mod input;
mod interrupt;
mod losses;
mod modes;
mod output;
mod regimes;
mod sensitivity;
mod simulate;
mod sweep;
mod text;
mod uncertainty;
mod work;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};
use willis::analysis::{self, Analysis, LossRequest, Selection};
use willis::casebook;
use willis::diagnostic::{Code, Diagnostic, Diagnostics, Severity};
use willis::dynamics::{Method, Options};
use willis::model::Model;
use willis::regimes::{Efficiencies, FormulaRequest, LocateRequest, Ratios, RegimeSelection};
use willis::study::export::ExportRequest;
use willis::study::{Hold, Sweep, UncertaintyRequest};
use willis::symbolic::Notation;
use willis::train::Train;
use willis::units::{self, Dimension, Quantity};
use willis_figure::FigureRequest;
use willis_figure::{Drawing, Theme};

/// Planetary gear trains: ratios, speeds, torques, power flow and efficiency, with the proof that
/// the answer is the only one.
#[derive(Parser)]
#[command(name = "willis", version, max_term_width = 100)]
struct Arguments {
    /// When to use colours.
    #[arg(long, global = true, value_enum, default_value = "auto")]
    color: Color,
    #[command(subcommand)]
    command: Command,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Color {
    Auto,
    Always,
    Never,
}

#[derive(Subcommand)]
enum Command {
    /// Analyse a train: its shift table and its operating points.
    ///
    /// Prints for every state the exact ratio and the efficiency driving and coasting; for every
    /// operation speeds, torques, powers, losses, the verdict and its certificate. A train that
    /// locks is an answer: exit status 0. Status 1 means the input is wrong.
    Analyze {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this state of the shift table.
        #[arg(long)]
        state: Option<String>,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
        /// With --format csv: only this table, without a heading.
        #[arg(long, value_enum)]
        table: Option<csv::Table>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
    },
    /// Evaluate a train at many points: maps, trends, every gear at once.
    ///
    /// Any quantity of the train file or of the operating point can vary, along as many axes as wanted:
    ///
    ///   --over "input.speed=500 rpm..12000 rpm:100"   --over "output.torque=10..400 N m:80"
    ///   --over state=all   --over P1.planet.count=3,4,6   --over "oil.temperature=20..100 degC:9"
    ///
    /// `…:100` are so many values, ends included; `…:31:log` a constant ratio; `…:step 500 rpm` every so much.
    /// Torque and power of `input` and `output` are positive where they drive; of a member called by its name they
    /// are those ON it, as in the train file. Every point is that of `analyze`; a point that is locked or has several
    /// solutions is a row that says so. Without --out a summary is all there is. An interrupted sweep goes on when the
    /// same command is given again.
    Sweep {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// An axis, QUANTITY=VALUES; several times for several axes, the last runs fastest.
        #[arg(long, value_name = "AXIS")]
        over: Vec<String>,
        /// A [[study]] of the train file.
        #[arg(long, value_name = "NAME", conflicts_with_all = ["over", "operation", "state", "hold", "columns"])]
        study: Option<String>,
        /// The operation from which the sweep starts. Default: the file's first.
        #[arg(long)]
        operation: Option<String>,
        /// The state of the shift table.
        #[arg(long)]
        state: Option<String>,
        /// What stays the same while other quantities vary.
        #[arg(long, value_enum, default_value_t = HoldArgument::AsGiven)]
        hold: HoldArgument,
        /// More columns: members, meshes, elements, sources, all, or single ones such as carrier.torque_n_m.
        #[arg(long, value_delimiter = ',', value_name = "COLUMN")]
        columns: Vec<String>,
        /// A law to use instead of that of the file: family=law.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// Table to write, one row a point: .csv, .jsonl or .parquet; what was done stands beside it in .json.
        #[arg(short, long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Replace a table that exists.
        #[arg(long)]
        force: bool,
        /// Go, however long it takes and however large it gets.
        #[arg(long)]
        yes: bool,
        /// Only this part of the sweep, 3/16; `willis merge` puts the parts together.
        #[arg(long, value_name = "K/N", value_parser = shard)]
        shard: Option<(u64, u64)>,
        /// Threads. Default: as many as there are cores.
        #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// Compile the train, for maps of millions of points: given efficiencies; axes of speed, torque, state, and a
        /// few values of the file; no columns of powers and warnings. Numbers agree with `analyze` to a part in 10^12.
        #[arg(long)]
        fast: bool,
        /// How to print the summary.
        #[arg(long, value_enum, default_value_t = PlainFormat::Text)]
        format: PlainFormat,
    },
    /// Put the shards of a sweep together, after checking that they belong together.
    Merge {
        /// The table to write.
        out: PathBuf,
        /// The shards, in any order; what was written beside them must be there too.
        #[arg(required = true)]
        shards: Vec<PathBuf>,
        /// Replace a table that exists.
        #[arg(long)]
        force: bool,
    },
    /// Tell where every watt goes, at a few speeds, loads and temperatures, or law beside law.
    ///
    /// Starts from the operations of the file. Loads stay as the file gives them (a torque stays
    /// that torque, a power that power) unless --powers or --torques varies them.
    Losses {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// Speeds of the operation's first prescribed speed: 500rpm,1000rpm,2000rpm.
        #[arg(long, value_delimiter = ',', value_name = "SPEED")]
        speeds: Vec<String>,
        /// Powers at the operation's first load: 100kW,200kW.
        #[arg(long, value_delimiter = ',', value_name = "POWER", conflicts_with = "torques")]
        powers: Vec<String>,
        /// Torques at the operation's first load: '100 N m,200 N m'.
        #[arg(long, value_delimiter = ',', value_name = "TORQUE")]
        torques: Vec<String>,
        /// Oil temperatures: 40degC,60degC,90degC.
        #[arg(long, value_delimiter = ',', value_name = "TEMPERATURE")]
        temperature: Vec<String>,
        /// Compare all laws of this family: mesh_friction, bearing, windage, ...
        #[arg(long, value_name = "FAMILY")]
        compare: Option<String>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
    },
    /// Rank the inputs by what they do to efficiency and losses: which loss to attack first.
    ///
    /// Exact derivatives (no differences are taken) of efficiency, of all losses and of each loss by every
    /// continuous quantity of the file and of the operation, for a step of one percent (1 K, 1 degree, 0.01 of a
    /// profile shift); and how far the point is from another driving end and from locking.
    Sensitivity {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// Only operations that run in this state.
        #[arg(long)]
        state: Option<String>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
    },
    /// List every loss law with its range, source and how far it was checked.
    Laws {
        /// Only this family.
        #[arg(long)]
        family: Option<String>,
        /// List the catalogue of oils instead.
        #[arg(long, conflicts_with_all = ["family", "bearings", "format"])]
        oils: bool,
        /// List the catalogue of bearings instead.
        #[arg(long, conflicts_with_all = ["family", "format"])]
        bearings: bool,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
    },
    /// Show where the power runs in an operating point: components, contacts, paths, losses.
    ///
    /// The graph has every component and every contact between components (teeth, bearings, seals,
    /// clutches), the power between them, the balance of each, the efficiency of each contact and of every
    /// path from input to output, and power that runs in circles.
    Flow {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// What to print; else what the name of the file says.
        #[arg(long, value_enum)]
        format: Option<FlowFormat>,
        /// Write into this file.
        #[arg(short, long, value_name = "FILE")]
        output: Option<std::path::PathBuf>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
    },
    /// List every regime of a train: who drives whom, in which speeds, with which formula.
    ///
    /// For two and more degrees of freedom: the regions of speed, the signs of the torques, inputs
    /// and outputs, the driving ends, the closed formula of efficiency and loss, the boundaries and
    /// what changes across them, and which assignments of inputs and outputs cannot be reached. For
    /// one degree of freedom: driving and coasting of every state with its formula.
    Regimes {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this state of the shift table, or "as drawn".
        #[arg(long)]
        state: Option<String>,
        /// Members on which torque may act, with commas between; else the train's terminals.
        #[arg(long, value_delimiter = ',')]
        terminals: Option<Vec<String>>,
        /// Two terminals whose powers add to zero: the machines of a hybrid with an idle battery.
        #[arg(long, value_delimiter = ',', value_name = "A,B")]
        balance: Option<Vec<String>>,
        /// One set with three terminals: for every basic ratio it can have (Esmail's Table 1).
        #[arg(long, conflicts_with = "balance")]
        family: bool,
        /// Draw the wheel of regimes (two freedoms) into this SVG file.
        #[arg(long, value_name = "FILE.svg", conflicts_with_all = ["family", "format"])]
        map: Option<std::path::PathBuf>,
        /// What to print; `map-json` is the wheel as data.
        #[arg(long, value_enum, default_value = "text")]
        format: RegimesFormat,
    },
    /// Give the closed formula of efficiency, speed ratio and torque ratio, also as code.
    ///
    /// Emitted code checks first whether its formula holds for its arguments and refuses to answer
    /// where it does not.
    Formula {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this state of the shift table, or "as drawn".
        #[arg(long)]
        state: Option<String>,
        /// Where power enters; else the state's input. Several with commas between.
        #[arg(long, value_delimiter = ',')]
        from: Vec<String>,
        /// Where power leaves; else the state's output. Several with commas between.
        #[arg(long, value_delimiter = ',')]
        to: Vec<String>,
        /// Members on which torque may act, for two and more degrees of freedom.
        #[arg(long, value_delimiter = ',')]
        terminals: Option<Vec<String>>,
        /// Two terminals whose powers add to zero.
        #[arg(long, value_delimiter = ',', value_name = "A,B")]
        balance: Option<Vec<String>>,
        /// Only the regime of this name, as `willis regimes` lists it.
        #[arg(long)]
        regime: Option<String>,
        /// How to write it.
        #[arg(long, value_enum, default_value = "text")]
        lang: Language,
        /// How ratios are written.
        #[arg(long, value_enum, default_value = "basic")]
        ratios: RatiosArgument,
        /// How efficiencies are written.
        #[arg(long, value_enum, default_value = "basic")]
        efficiencies: EfficienciesArgument,
        /// Also the derivatives with respect to every efficiency: which mesh matters most.
        #[arg(long)]
        derivatives: bool,
    },
    /// Tell in which regime an operating point lies, how far each boundary is and what changes there.
    ///
    /// Works for trains of any size: it looks at this one point.
    Locate {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// State of the shift table; else the train as drawn.
        #[arg(long)]
        state: Option<String>,
        /// Speeds of as many members as there are degrees of freedom: engine=2000rpm,ring=1000rpm.
        #[arg(long, value_delimiter = ',', value_name = "MEMBER=SPEED")]
        speeds: Vec<String>,
        /// Torques of as many terminals as are independent: 'engine=100 N m'.
        #[arg(long, value_delimiter = ',', value_name = "MEMBER=TORQUE")]
        torques: Vec<String>,
        /// Take speeds and torques from this operation of the file.
        #[arg(long)]
        operation: Option<String>,
        /// Members on which torque may act, with commas between; else the train's terminals.
        #[arg(long, value_delimiter = ',')]
        terminals: Option<Vec<String>>,
        /// Two terminals whose powers add to zero.
        #[arg(long, value_delimiter = ',', value_name = "A,B")]
        balance: Option<Vec<String>>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: LocateFormat,
    },
    /// Simulate a scenario: how the train accelerates, sticks, slips and shifts, and where the energy goes.
    ///
    /// A run that jams, has several solutions or ends otherwise before the scenario is an answer:
    /// exit status 0, and the outcome says so. Ctrl-C ends the run where it is, with exit status 130.
    /// In both cases what was computed is written and told.
    ///
    /// Rows are in SI units; where a value is not determined the field is empty (CSV) or null. Modes
    /// are 1 forward, -1 backward, 0 stuck, 2 free. A CSV of a run that ended early has a last line
    /// that begins with `# ` and says when and why; in Parquet the metadata `willis.complete` is
    /// false and `willis.ended_s` has the time.
    Simulate {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// The scenario; needed where the file has several.
        #[arg(long)]
        scenario: Option<String>,
        /// Write the rows into this file, .csv or .parquet, as they come.
        #[arg(short, long, value_name = "FILE")]
        out: Option<std::path::PathBuf>,
        /// Draw the run into this SVG file.
        #[arg(long, value_name = "FILE.svg")]
        plot: Option<std::path::PathBuf>,
        /// Only these columns in rows and figure, by kind (speed, torque, mode, ...) or by name.
        #[arg(long, value_delimiter = ',', value_name = "KIND|NAME")]
        columns: Vec<String>,
        /// How many rows, evenly spaced in time; else as the scenario says.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000_000))]
        samples: Option<u32>,
        /// Relative tolerance of speeds and angles [default: 1e-10].
        #[arg(long, value_name = "TOLERANCE", value_parser = tolerance)]
        tolerance: Option<f64>,
        /// Advance in steps of this length, each of bounded cost: '1 ms'.
        #[arg(long, value_name = "TIME", conflicts_with = "tolerance")]
        #[arg(allow_hyphen_values = true)]
        fixed_step: Option<String>,
        /// Take the sign of each tooth force from the step before, as in Galvagno 2010, to show the
        /// error of that.
        #[arg(long, requires = "fixed_step")]
        lagged_forces: bool,
        /// Where several motions are possible, go on with one of them.
        #[arg(long)]
        continue_when_ambiguous: bool,
        /// The most changes of mode within a thousandth of the scenario [default: 1000].
        #[arg(long, value_name = "N", conflicts_with = "fixed_step")]
        #[arg(value_parser = clap::value_parser!(u64).range(1..))]
        most_events: Option<u64>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: SimulateFormat,
    },
    /// Tell what a duty cycle or a load spectrum costs: energies by source, state and direction, the worst rows.
    ///
    /// Each row of the profile, a CSV file, is one operating condition. A column weighs the rows in time: `time [s]`
    /// of a trace (each row holds until the next), or `duration [s]`, `hours` or `share` of a spectrum. The other
    /// columns set quantities, with the unit in the header: input.speed [rpm], output.torque [N m],
    /// oil.temperature [degC], state, or any quantity of the train file. Rows without an answer are told with
    /// their reason, and the energies say which part of the time they cover.
    Cycle {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// The profile (CSV), or - for standard input.
        #[arg(long, value_name = "FILE.csv")]
        profile: String,
        /// The operation that gives what no column sets; else the file's first.
        #[arg(long)]
        operation: Option<String>,
        /// State of the shift table, where no column gives it.
        #[arg(long)]
        state: Option<String>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
        /// Write every row with its answer into this CSV file.
        #[arg(long, value_name = "FILE.csv")]
        rows: Option<std::path::PathBuf>,
        /// Write what is printed into this file.
        #[arg(short, long, value_name = "FILE")]
        output: Option<std::path::PathBuf>,
        /// Replace files that are there already.
        #[arg(long)]
        force: bool,
    },
    /// Lay variants of a train side by side: what the files differ in, and what that changes.
    ///
    /// Keys that differ come first, then states and operations by the size of their differences, then in a line
    /// what is equal. Operations of one name that prescribe different things are compared and marked. With --over
    /// the same axes are applied to every variant: where which is better, and by how much.
    Compare {
        /// Train files (TOML), two or more.
        #[arg(required = true, num_args = 2.., value_name = "FILE")]
        files: Vec<String>,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// Only this state, and operations in it.
        #[arg(long)]
        state: Option<String>,
        /// A quantity and its values: 'input.speed=500 rpm..6000 rpm:12'. Several times for a grid.
        #[arg(long, value_name = "QUANTITY=VALUES")]
        over: Vec<String>,
        /// Put a law into force in all variants: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
    },
    /// List torsional natural frequencies: shapes, damping, where the energy is.
    ///
    /// Small vibrations of the moments of inertia on the elastic shafts; the gears tie them together.
    Modes {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// State of the shift table; else the train as drawn.
        #[arg(long)]
        state: Option<String>,
        /// Members held at rest, with commas between.
        #[arg(long, value_delimiter = ',', value_name = "MEMBER")]
        fixed: Vec<String>,
        /// Draw the shapes into this SVG file.
        #[arg(long, value_name = "FILE.svg")]
        plot: Option<std::path::PathBuf>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: ModesFormat,
    },
    /// Write loss maps, efficiency tables, models and actuator blocks for other programs.
    ///
    /// Without a kind it lists the kinds. Numbers are those of `analyze`, at every point of the
    /// ranges; without ranges they are taken from the operations of the file, and told. What a
    /// format cannot say (a lock, several solutions, a dependence on load) stands in the comments
    /// of the file and on standard error; a point without an answer gets no number.
    Export {
        /// The format: vecto, modelica-loss-table, ...; or list.
        kind: Option<String>,
        /// Train file (TOML), or - for standard input.
        file: Option<String>,
        /// This state of the shift table.
        #[arg(long, conflicts_with = "all_states")]
        state: Option<String>,
        /// Every state that can be exported.
        #[arg(long)]
        all_states: bool,
        /// Take state and ranges from this operation of the file.
        #[arg(long, conflicts_with = "all_states")]
        operation: Option<String>,
        /// Speeds of the input: 200rpm..2200rpm:11 are 11 values; or 500rpm,1000rpm.
        #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
        speeds: Option<String>,
        /// Torques on the input, positive driving, negative coasting: '-500 N m..500 N m:21'.
        #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
        torques: Option<String>,
        /// Oil temperatures: 40degC,90degC. Most formats take one.
        #[arg(long, value_delimiter = ',', value_name = "TEMPERATURE")]
        temperature: Vec<String>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// Write into this file, or into this folder where there are several files.
        #[arg(short, long, value_name = "FILE|FOLDER")]
        output: Option<std::path::PathBuf>,
        /// Write over files that are there already.
        #[arg(long)]
        force: bool,
    },
    /// Tell how sure a number is: its distribution when quantities are uncertain, and what dominates it.
    ///
    /// Quantities are those of the train file and of the operation. Distributions: `0.98..0.99` (equally likely),
    /// `+-5%` about the file's value, `normal(0.4 um, 0.05 um)` and `lognormal(0.4 um, 1.3)` (both cut off at three
    /// standard deviations), `triangular(0.2, 0.4, 0.8 um)`; sets of equally likely values: `3,4`, laws: `all`,
    /// `inside` (their range), or names.
    ///
    /// Without --vary and --laws: given losses 1 - efficiency by 20 %, roughness by 20 %, the oil's temperature by 5 K
    /// each way, and the laws of tooth friction inside their range; each is listed as an assumption.
    Uncertainty {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// This operation; else the first.
        #[arg(long)]
        operation: Option<String>,
        /// In this state of the shift table.
        #[arg(long)]
        state: Option<String>,
        /// An uncertain quantity: 'P1.mesh_efficiency=0.985..0.995'. Several times for several quantities.
        #[arg(long, value_name = "QUANTITY=DISTRIBUTION")]
        vary: Vec<String>,
        /// Families whose laws are each as likely as the others, with commas between; or all.
        #[arg(long, value_delimiter = ',', value_name = "FAMILY|all")]
        laws: Vec<String>,
        /// How many samples; made a power of two.
        #[arg(long, value_name = "N", default_value = "1024")]
        samples: usize,
        /// Other seeds give other samples; the same seed the same, bit for bit.
        #[arg(long, value_name = "K", default_value = "1")]
        seed: u64,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// Write every sample into this file.
        #[arg(long, value_name = "FILE.csv")]
        samples_out: Option<std::path::PathBuf>,
        /// Replace that file where it exists.
        #[arg(long, requires = "samples_out")]
        force: bool,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
    },
    /// Compare published numbers with ours: what agrees, what does not, and why.
    ///
    /// Without a case it lists the cases. Exit status 0 also where a number differs: that is an
    /// answer.
    Validate {
        /// The case, as listed.
        case: Option<String>,
        /// What to print.
        #[arg(long, value_enum, default_value = "text")]
        format: LocateFormat,
        /// Write the curves of the case as CSV files into this folder instead.
        #[arg(long, value_name = "FOLDER", requires = "case")]
        data: Option<std::path::PathBuf>,
    },
    /// Draw a train: its scheme, levers, power flow, teeth, regimes, maps, losses.
    ///
    ///   stick     kinematic schematic, engaged elements and power path of a state
    ///   lever     nomograph: speeds and torques; --state all lays all states over each other
    ///   sankey    power from input to output, each loss branching off, to scale
    ///   flow      power through components and contacts
    ///   front     a set seen along its axis, true teeth in mesh (--part SET, --animated)
    ///   regimes   the wheel of regimes of two freedoms
    ///   map       efficiency over two quantities (--over twice); of an automatic the best gear
    ///   losses    losses by source, stacked over a quantity (--over) and as bars
    ///   film      oil film over roughness along the path of contact (--part MESH)
    ///   path      friction, sliding and load along the path of contact (--part MESH)
    ///   time      a scenario over time (--part SCENARIO)
    ///   shift     the table of states with its steps
    ///   tornado   what a step of each quantity does to efficiency and losses
    ///   band      how sure efficiency and loss are, over a quantity (--over)
    #[command(verbatim_doc_comment)]
    Draw {
        /// What to draw; `all` draws whatever applies into a folder.
        kind: String,
        /// Train file (TOML), or - for standard input.
        file: String,
        /// A state of the shift table.
        #[arg(long)]
        state: Option<String>,
        /// An operation; else the file's first, or all where a figure shows several.
        #[arg(long)]
        operation: Option<String>,
        /// The set, mesh or scenario to draw.
        #[arg(long, value_name = "NAME")]
        part: Option<String>,
        /// A quantity along an axis, as `sweep` takes it: "sun.speed=500..3000 rpm:40".
        #[arg(long, value_name = "AXIS")]
        over: Vec<String>,
        /// Members on which torque may act, with commas between (regimes); else the train's terminals.
        #[arg(long, value_delimiter = ',')]
        terminals: Option<Vec<String>>,
        /// Two terminals whose powers add to zero (regimes).
        #[arg(long, value_delimiter = ',', value_name = "A,B")]
        balance: Option<Vec<String>>,
        /// Draw teeth without geometry as nominal ones of module 1.
        #[arg(long)]
        nominal: bool,
        /// Wheels turn (front, in SVG).
        #[arg(long)]
        animated: bool,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// Light or dark, or as the reader's screen is set.
        #[arg(long, value_enum, default_value_t = ThemeArgument::Light)]
        theme: ThemeArgument,
        /// Pixels of a PNG to a unit of the figure.
        #[arg(long, default_value_t = 2.0, value_parser = scale)]
        scale: f32,
        /// File to write: .svg, .png, or .json for the figure as data; else SVG goes to standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Write the engineering report of a train: one file that explains itself, as web page or PDF.
    ///
    /// Question, train with schematic and teeth, results with verdict and certificate, power flow, losses and what to
    /// change first, maps, regimes and closed formulas, assumptions, warnings, laws with their sources, and how to do it
    /// again. The same input gives the same bytes.
    Report {
        /// Train file (TOML), or - for standard input.
        file: String,
        /// Only this operation.
        #[arg(long)]
        operation: Option<String>,
        /// Put a law into force: mesh_friction=niemann. Several times for several families.
        #[arg(long, value_name = "FAMILY=LAW")]
        law: Vec<String>,
        /// Paper of a PDF.
        #[arg(long, value_enum, default_value_t = Paper::A4)]
        paper: Paper,
        /// File to write: .html, .pdf, or .json for the document before it is typeset; else HTML goes to standard output.
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Check a train file and say everything that is wrong with it.
    Check {
        /// Train file (TOML), or - for standard input.
        file: String,
    },
    /// Print the JSON Schema of the train file, for editors.
    Schema,
    /// Explain a diagnostic code, or list all of them.
    Explain {
        /// The code, such as E106.
        code: Option<String>,
    },
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write one for every command into a folder.
    Man {
        /// The folder.
        folder: Option<std::path::PathBuf>,
    },
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Format {
    /// For eyes.
    Text,
    /// The results contract, for machines.
    Json,
    /// Tables.
    Csv,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ThemeArgument {
    /// For paper.
    Light,
    /// For dark screens.
    Dark,
    /// As the screen is set, where the viewer tells.
    Auto,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Paper {
    /// 210 mm x 297 mm.
    A4,
    /// 8.5 in x 11 in.
    UsLetter,
}

/// A scale of pictures.
fn scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(x) if (0.1..=10.0).contains(&x) => Ok(x),
        _ => Err("a number from 0.1 to 10".into()),
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum FlowFormat {
    /// For eyes.
    Text,
    /// The results contract `willis-flow-1`.
    Json,
    /// Graphviz.
    Dot,
    /// A figure.
    Svg,
}

impl FlowFormat {
    /// The format that a file's name promises.
    fn of(path: &std::path::Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "json" => Some(Self::Json),
            "dot" | "gv" => Some(Self::Dot),
            "svg" => Some(Self::Svg),
            "txt" => Some(Self::Text),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum RegimesFormat {
    /// For eyes.
    Text,
    /// The results contract `willis-regimes-1`.
    Json,
    /// One row a regime.
    Csv,
    /// A table for typesetting.
    Latex,
    /// The wheel of regimes as data (two freedoms).
    MapJson,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum LocateFormat {
    /// For eyes.
    Text,
    /// The results contract: `willis-location-1`, `willis-validation-1`.
    Json,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum SimulateFormat {
    /// For eyes.
    Text,
    /// The results contract `willis-simulation-1`; with the rows, unless --out takes them.
    Json,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ModesFormat {
    /// For eyes.
    Text,
    /// The results contract `willis-modes-1`.
    Json,
    /// One row a number.
    Csv,
}

/// A relative tolerance that the arithmetic can keep.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (1e-13..=1e-2).contains(&x) => Ok(x),
        _ => Err("a number from 1e-13 to 1e-2, as in 1e-9".into()),
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Language {
    /// For eyes.
    Text,
    /// For typesetting (amsmath).
    Latex,
    /// Python 3.
    Python,
    /// Rust.
    Rust,
    /// C99.
    C,
    /// Modelica.
    Modelica,
}

impl From<Language> for Notation {
    fn from(l: Language) -> Self {
        match l {
            Language::Text => Self::Text,
            Language::Latex => Self::Latex,
            Language::Python => Self::Python,
            Language::Rust => Self::Rust,
            Language::C => Self::C,
            Language::Modelica => Self::Modelica,
        }
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum HoldArgument {
    /// The loads as the operation gives them.
    AsGiven,
    /// The torques of the loads.
    Torque,
    /// The powers of the loads.
    Power,
    /// The torque at the output.
    Output,
}

impl From<HoldArgument> for Hold {
    fn from(h: HoldArgument) -> Self {
        match h {
            HoldArgument::AsGiven => Self::AsGiven,
            HoldArgument::Torque => Self::Torque,
            HoldArgument::Power => Self::Power,
            HoldArgument::Output => Self::Output,
        }
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PlainFormat {
    /// For eyes.
    Text,
    /// For programs.
    Json,
}

/// `3/16`
fn shard(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match parts {
        Some((_, n)) if n > 1_000_000 => Err("more than a million parts are not made".into()),
        Some((k, n)) if k >= 1 && k <= n => Ok((k, n)),
        Some((k, n)) => Err(format!("there is no part {k} of {n}; parts count from 1")),
        None => Err("write which of how many, as in 3/16".into()),
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum RatiosArgument {
    /// One symbol for the basic ratio of each set.
    Basic,
    /// Tooth numbers as symbols.
    Teeth,
    /// The numbers of this train.
    Numbers,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum EfficienciesArgument {
    /// One symbol for each set: the product over its meshes.
    Basic,
    /// One symbol for each mesh.
    Meshes,
    /// The numbers of this train.
    Numbers,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match arguments.color {
        Color::Auto => {}
        Color::Always => anstream::ColorChoice::Always.write_global(),
        Color::Never => anstream::ColorChoice::Never.write_global(),
    }
    if let Command::Analyze { format: Format::Text | Format::Json, table: Some(_), .. } = &arguments.command {
        let kind = clap::error::ErrorKind::ArgumentConflict;
        Arguments::command().error(kind, "--table belongs to --format csv").exit();
    }
    if let Command::Export { kind: Some(kind), file: None, .. } = &arguments.command
        && kind != "list"
    {
        let kind = clap::error::ErrorKind::MissingRequiredArgument;
        Arguments::command().error(kind, "name a train file after the kind of export").exit();
    }
    let mut status = 0;
    match run(&arguments.command, &mut status) {
        Ok(output) => {
            // A reader that closes the pipe early (`willis … | head`) is no error.
            let mut out = anstream::stdout();
            match out.write_all(output.as_bytes()).and_then(|()| out.flush()) {
                Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
                    let _ = writeln!(anstream::stderr(), "standard output: {e}");
                    ExitCode::FAILURE
                }
                _ => ExitCode::from(status),
            }
        }
        Err(message) => {
            let _ = anstream::stderr().write_all(message.as_bytes());
            ExitCode::FAILURE
        }
    }
}

/// What goes to standard output with the exit status, 0 unless set; or to standard error with exit status 1.
fn run(command: &Command, status: &mut u8) -> Result<String, String> {
    match command {
        Command::Analyze { file, state, operation, format, table, law } => {
            let selection = Selection { state: state.clone(), operation: operation.clone() };
            let job = Job::read(file, law)?;
            let analysis = job.analyze(&selection)?;
            Ok(match format {
                Format::Text => text::analysis(job.train(), &analysis) + &job.notes(&analysis.diagnostics),
                Format::Json => serde_json::to_string_pretty(&analysis).expect("plain data") + "\n",
                Format::Csv => csv::analysis(&analysis, *table),
            })
        }
        Command::Sweep {
            file,
            over,
            study,
            operation,
            state,
            hold,
            columns,
            law,
            out,
            force,
            yes,
            shard,
            threads,
            fast,
            format,
        } => {
            let job = Job::read(file, law)?;
            if let Some(out) = out {
                output::apart(out, &[file.as_ref()])?;
            }
            let request = sweep::Request {
                study: study.clone(),
                over: over.clone(),
                operation: operation.clone(),
                state: state.clone(),
                hold: (*hold).into(),
                columns: columns.clone(),
                out: out.clone(),
                force: *force,
                yes: *yes,
                shard: *shard,
                threads: threads.map(usize::from),
                fast: *fast,
            };
            let report = match sweep::run(&job.model, &request) {
                Ok(report) => report,
                Err(sweep::Failure::Input(wrong)) => return Err(job.failure(wrong)),
                Err(sweep::Failure::Told(text)) => return Err(text),
                Err(sweep::Failure::Interrupted(text)) => {
                    *status = 130;
                    return Ok(text);
                }
            };
            Ok(match format {
                PlainFormat::Text => sweep::text(&report) + &job.notes(job.train().warnings()),
                PlainFormat::Json => serde_json::to_string_pretty(&report).expect("plain data") + "\n",
            })
        }
        Command::Merge { out, shards, force } => {
            let read: Vec<&std::path::Path> = shards.iter().map(PathBuf::as_path).collect();
            output::apart(out, &read)?;
            sweep::merge(out, shards, *force).map(|r| sweep::text(&r))
        }
        Command::Losses { file, operation, speeds, powers, torques, temperature, compare, law, format } => {
            let job = Job::read(file, law)?;
            let temperature = values("--temperature", temperature, Dimension::TEMPERATURE)?;
            let request = LossRequest {
                operation: operation.clone(),
                speeds: values("--speeds", speeds, Dimension::ANGULAR_SPEED)?,
                powers: values("--powers", powers, Dimension::POWER)?,
                torques: values("--torques", torques, Dimension::TORQUE)?,
                temperatures: temperature.iter().map(Quantity::si).collect(),
                compare: compare.clone(),
            };
            let all = analysis::losses(job.train(), &request).map_err(|wrong| job.failure(wrong))?;
            Ok(match format {
                Format::Text => losses::points(&all),
                Format::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                Format::Csv => losses::points_csv(&all),
            })
        }
        Command::Sensitivity { file, operation, state, law, format } => {
            let selection = Selection { state: state.clone(), operation: operation.clone() };
            let job = Job::read(file, law)?;
            let all = willis::study::sensitivity(job.train(), &selection).map_err(|wrong| job.failure(wrong))?;
            Ok(match format {
                Format::Text => sensitivity::text(&all) + &job.notes(&all.diagnostics),
                Format::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                Format::Csv => sensitivity::table_csv(&all),
            })
        }
        Command::Laws { oils: true, .. } => Ok(losses::oils()),
        Command::Laws { bearings: true, .. } => Ok(losses::bearings_catalogue()),
        Command::Laws { family, format, .. } => {
            let mut all = willis::losses::entries();
            if let Some(family) = &family {
                all.retain(|e| e.family == family);
                if all.is_empty() {
                    let known = willis::losses::FAMILIES.join(", ");
                    return Err(format!("there is no family of laws `{family}`; the families are: {known}\n"));
                }
            }
            Ok(match format {
                Format::Text => losses::laws(&all),
                Format::Json => {
                    let list = willis::losses::list(family.as_deref());
                    serde_json::to_string_pretty(&list).expect("plain data") + "\n"
                }
                Format::Csv => losses::laws_csv(&all),
            })
        }
        Command::Draw {
            kind,
            file,
            state,
            operation,
            part,
            over,
            terminals,
            balance,
            nominal,
            animated,
            law,
            theme,
            scale,
            output,
        } => {
            let job = Job::read(file, law)?;
            let request = FigureRequest {
                state: state.clone(),
                operation: operation.clone(),
                part: part.clone(),
                over: over.clone(),
                terminals: terminals.clone(),
                balance: pair(balance.as_deref())?,
                nominal: *nominal,
                samples: 0,
            };
            let theme = match theme {
                ThemeArgument::Light => Theme::Light,
                ThemeArgument::Dark => Theme::Dark,
                ThemeArgument::Auto => Theme::Auto,
            };
            let look = draw::Look { drawing: Drawing { animated: *animated }, theme, scale: *scale };
            if let Some(out) = output {
                output::apart(out, &[file.as_ref()])?;
            }
            draw::draw(&job.model, kind, &request, &look, output.as_deref(), &|wrong| job.failure(wrong))
        }
        Command::Report { file, operation, law, paper, output } => {
            let job = Job::read(file, law)?;
            if let Some(out) = output {
                output::apart(out, &[file.as_ref()])?;
            }
            let paper = match paper {
                Paper::A4 => "a4",
                Paper::UsLetter => "us-letter",
            };
            let request = draw::report_request(file, job.model.to_toml(), operation.clone(), law);
            let document = willis_figure::report(&job.model, &request, &willis::work::Serial)
                .map_err(|wrong| job.failure(wrong))?;
            draw::deliver(&document, paper, output.as_deref())
        }
        Command::Flow { file, operation, format, output, law } => {
            let selection = Selection { state: None, operation: operation.clone() };
            let job = Job::read(file, law)?;
            let all = willis::hypergraph::flows(job.train(), &selection).map_err(|wrong| job.failure(wrong))?;
            let promised = output.as_deref().and_then(FlowFormat::of);
            if let (Some(path), None, None) = (output, format, promised) {
                let told = "its ending is none of .svg, .json, .dot, .txt; name one of them, or give --format";
                return Err(format!("{}: {told}\n", path.display()));
            }
            let text = match format.or(promised).unwrap_or(FlowFormat::Text) {
                // A file takes no colours.
                FlowFormat::Text if output.is_some() => {
                    anstream::adapter::strip_str(&(flow::text(&all) + &job.notes(&all.diagnostics))).to_string()
                }
                FlowFormat::Text => flow::text(&all) + &job.notes(&all.diagnostics),
                FlowFormat::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                FlowFormat::Dot => willis_figure::flow_dot(&all),
                FlowFormat::Svg => willis_figure::draw_flow(&all) + "\n",
            };
            match output {
                None => Ok(text),
                Some(path) => output::write(path, text.as_bytes()).map(|()| String::new()),
            }
        }
        Command::Regimes { file, state, terminals, balance, family, map, format } => {
            let job = Job::read(file, &[])?;
            let selection = RegimeSelection {
                state: state.clone(),
                terminals: terminals.clone(),
                balance: pair(balance.as_deref())?,
            };
            if map.is_some() || *format == RegimesFormat::MapJson {
                let figure = willis_figure::regime_map(job.train(), &selection).map_err(|wrong| job.failure(wrong))?;
                return match map {
                    None => Ok(serde_json::to_string_pretty(&figure).expect("plain data") + "\n"),
                    Some(path) => {
                        output::write(path, willis_figure::draw_regimes(&figure).as_bytes()).map(|()| String::new())
                    }
                };
            }
            if *family {
                let all = willis::regimes::family(job.train(), &selection).map_err(|wrong| job.failure(wrong))?;
                return Ok(match format {
                    RegimesFormat::Text => regimes::family(&all),
                    RegimesFormat::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                    RegimesFormat::Csv => regimes::family_csv(&all),
                    RegimesFormat::Latex => regimes::family_latex(&all),
                    RegimesFormat::MapJson => unreachable!("answered above"),
                });
            }
            let all = willis::regimes::regimes(job.train(), &selection).map_err(|wrong| job.failure(wrong))?;
            Ok(match format {
                RegimesFormat::Text => regimes::text(&all),
                RegimesFormat::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                RegimesFormat::Csv => regimes::csv(&all),
                RegimesFormat::Latex => regimes::latex(&all),
                RegimesFormat::MapJson => unreachable!("answered above"),
            })
        }
        Command::Formula {
            file,
            state,
            from,
            to,
            terminals,
            balance,
            regime,
            lang,
            ratios,
            efficiencies,
            derivatives,
        } => {
            let job = Job::read(file, &[])?;
            let request = FormulaRequest {
                state: state.clone(),
                from: from.clone(),
                to: to.clone(),
                terminals: terminals.clone(),
                balance: pair(balance.as_deref())?,
                regime: regime.clone(),
                ratios: match ratios {
                    RatiosArgument::Basic => Ratios::Basic,
                    RatiosArgument::Teeth => Ratios::Teeth,
                    RatiosArgument::Numbers => Ratios::Numbers,
                },
                efficiencies: match efficiencies {
                    EfficienciesArgument::Basic => Efficiencies::Basic,
                    EfficienciesArgument::Meshes => Efficiencies::Meshes,
                    EfficienciesArgument::Numbers => Efficiencies::Numbers,
                },
            };
            let sheet = willis::regimes::formulas(job.train(), &request).map_err(|wrong| job.failure(wrong))?;
            Ok(sheet.emit((*lang).into(), *derivatives))
        }
        Command::Locate { file, state, speeds, torques, operation, terminals, balance, format } => {
            let job = Job::read(file, &[])?;
            let request = LocateRequest {
                state: state.clone(),
                terminals: terminals.clone(),
                balance: pair(balance.as_deref())?,
                operation: operation.clone(),
                speeds: quantities("--speeds", speeds, Dimension::ANGULAR_SPEED)?,
                torques: quantities("--torques", torques, Dimension::TORQUE)?,
            };
            let found = willis::regimes::locate(job.train(), &request).map_err(|wrong| job.failure(wrong))?;
            Ok(match format {
                LocateFormat::Text => regimes::location(&found),
                LocateFormat::Json => serde_json::to_string_pretty(&found).expect("plain data") + "\n",
            })
        }
        Command::Simulate {
            file,
            scenario,
            out,
            plot,
            columns,
            samples,
            tolerance,
            fixed_step,
            lagged_forces,
            continue_when_ambiguous,
            most_events,
            format,
        } => {
            let job = Job::read(file, &[])?;
            let mut options = Options {
                samples: samples.map(|n| n as usize),
                continue_when_ambiguous: *continue_when_ambiguous,
                lagged_forces: *lagged_forces,
                ..Options::default()
            };
            options.tolerance = tolerance.unwrap_or(options.tolerance);
            options.most_events = most_events.map_or(options.most_events, |n| n as usize);
            if let Some(text) = fixed_step {
                let step = values("--fixed-step", std::slice::from_ref(text), Dimension::TIME)?[0].si();
                if step <= 0.0 {
                    return Err(format!("--fixed-step {text}: give a time above zero, as in --fixed-step '1 ms'\n"));
                }
                options.method = Method::Fixed { step_s: step };
            }
            let request = simulate::Request {
                scenario: scenario.clone(),
                out: out.clone(),
                plot: plot.clone(),
                columns: columns.clone(),
                options,
                json: *format == SimulateFormat::Json,
            };
            let run = simulate::run(job.train(), &request).map_err(|failure| match failure {
                simulate::Failure::Input(wrong) => job.failure(wrong),
                simulate::Failure::Told(text) => text,
            })?;
            if run.interrupted() {
                *status = 130;
            }
            Ok(match format {
                SimulateFormat::Text => simulate::text(&run),
                SimulateFormat::Json => simulate::json(&run),
            })
        }
        Command::Cycle { file, profile, operation, state, law, format, rows, output, force } => {
            if file == "-" && profile == "-" {
                return Err("standard input is either the train file or the profile\n".into());
            }
            for path in [output, rows].into_iter().flatten() {
                output::apart(path, &[file.as_ref(), profile.as_ref()])?;
            }
            if let Some(path) = output {
                cycle::free(path, *force)?;
            }
            let studied = cycle::Studied::read(file, law)?;
            let request = cycle::Request {
                profile,
                operation: operation.as_deref(),
                state: state.as_deref(),
                rows: rows.as_deref(),
                force: *force,
            };
            let report = cycle::run(&studied, &request)?;
            let text = match format {
                Format::Text => cycle::text(&report, profile),
                Format::Json => serde_json::to_string_pretty(&report).expect("plain data") + "\n",
                Format::Csv => cycle::csv(&report),
            };
            cycle::deliver(text, output.as_ref(), *force)
        }
        Command::Compare { files, operation, state, over, law, format } => {
            let studied = files.iter().map(|f| cycle::Studied::read(f, law)).collect::<Result<Vec<_>, _>>()?;
            let request = willis::study::CompareRequest {
                operation: operation.clone(),
                state: state.clone(),
                over: over.clone(),
            };
            let all = compare::run(&studied, &request)?;
            Ok(match format {
                Format::Text => compare::text(&all),
                Format::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                Format::Csv => compare::csv(&all),
            })
        }
        Command::Modes { file, state, fixed, plot, format } => {
            let job = Job::read(file, &[])?;
            let held: Vec<&str> = fixed.iter().map(String::as_str).collect();
            let all =
                willis::dynamics::modes(job.train(), state.as_deref(), &held).map_err(|wrong| job.failure(wrong))?;
            if let Some(path) = plot {
                output::write(path, (willis_figure::draw_modes(&all) + "\n").as_bytes())?;
            }
            Ok(match format {
                ModesFormat::Text => modes::text(&all),
                ModesFormat::Json => serde_json::to_string_pretty(&all).expect("plain data") + "\n",
                ModesFormat::Csv => modes::csv(&all),
            })
        }
        Command::Export {
            kind,
            file,
            state,
            all_states,
            operation,
            speeds,
            torques,
            temperature,
            law,
            output,
            force,
        } => {
            let (Some(kind), Some(file)) = (kind, file) else { return Ok(export::list()) };
            let request = ExportRequest {
                state: state.clone(),
                all_states: *all_states,
                operation: operation.clone(),
                speeds: speeds.clone(),
                torques: torques.clone(),
                temperatures: (!temperature.is_empty()).then(|| temperature.join(", ")),
            };
            let job = Job::read(file, law)?;
            if let Some(out) = output {
                output::apart(out, &[file.as_ref()])?;
            }
            let done =
                willis::study::export::export(job.train(), kind, &request).map_err(|wrong| job.failure(wrong))?;
            export::deliver(&done, output.as_deref(), *force)
        }
        Command::Uncertainty { file, operation, state, vary, laws, samples, seed, law, samples_out, force, format } => {
            let job = Job::read(file, law)?;
            let target = samples_out.clone().map(|path| uncertainty::SamplesOut { path, force: *force });
            if let Some(out) = samples_out {
                output::apart(out, &[file.as_ref()])?;
            }
            target.iter().try_for_each(uncertainty::SamplesOut::check)?;
            let request = UncertaintyRequest {
                operation: operation.clone(),
                state: state.clone(),
                vary: vary.clone(),
                laws: laws.clone(),
                samples: *samples,
                seed: *seed,
            };
            let answer = willis::study::uncertainty(&job.model, &request, &work::Threads::default())
                .map_err(|wrong| job.failure(wrong))?;
            if let Some(target) = &target {
                uncertainty::write_samples(&target.path, &answer.samples)?;
            }
            let found = answer.report;
            Ok(match format {
                Format::Text => uncertainty::text(&found),
                Format::Json => serde_json::to_string_pretty(&found).expect("plain data") + "\n",
                Format::Csv => uncertainty::csv(&found),
            })
        }
        Command::Validate { case, format, data } => validate(case.as_deref(), *format, data.as_deref()),
        Command::Check { file } => {
            let job = Job::read(file, &[])?;
            let analysis = job.analyze(&Selection::default())?;
            if !job.train().studies().is_empty() {
                let mut wrong = Diagnostics::default();
                for study in job.train().studies() {
                    wrong.extend(Sweep::of_file(&job.model, &study.name).err().unwrap_or_default());
                }
                if wrong.has_errors() {
                    return Err(job.failure(wrong));
                }
            }
            let (train, notes) = (job.train(), job.notes(&analysis.diagnostics));
            let warnings = analysis.diagnostics.iter().filter(|d| d.severity == Severity::Warning).count();
            let count = |n: usize, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
            let meshes = train.meshes().len();
            Ok(format!(
                "{notes}{}: {}, {meshes} mesh{}, {}, {}, {}: no errors, {}\n",
                job.file,
                count(train.members().len() - 1, "member"),
                if meshes == 1 { "" } else { "es" },
                count(train.shift_elements().len(), "shift element"),
                count(train.states().len(), "state"),
                count(train.operations().len(), "operation"),
                count(warnings, "warning")
            ))
        }
        Command::Schema => Ok(serde_json::to_string_pretty(&willis::train::schema()).expect("plain data") + "\n"),
        Command::Explain { code: None } => Ok(Code::ALL.iter().map(|c| format!("{c}  {}\n", c.title())).collect()),
        Command::Explain { code: Some(code) } => match Code::parse(code) {
            Some(code) => {
                let text = code.explanation().lines().map(|l| l.trim_start()).collect::<Vec<_>>().join("\n");
                Ok(format!("{code}: {}\n\n{}\n", code.title(), text.trim()))
            }
            None => Err(format!("there is no diagnostic `{code}`; `willis explain` lists all of them\n")),
        },
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "willis", &mut script);
            Ok(String::from_utf8(script).expect("scripts are text"))
        }
        Command::Man { folder: None } => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Arguments::command()).render(&mut page).expect("writing to memory");
            Ok(String::from_utf8(page).expect("pages are text"))
        }
        Command::Man { folder: Some(folder) } => {
            let written = clap_mangen::generate_to(Arguments::command(), folder);
            written.map(|()| String::new()).map_err(|e| format!("{}: {e}\n", folder.display()))
        }
    }
}

/// `willis validate`
fn validate(case: Option<&str>, format: LocateFormat, folder: Option<&std::path::Path>) -> Result<String, String> {
    let Some(name) = case else {
        return Ok(match format {
            LocateFormat::Text => casebook::CASES.iter().map(|c| format!("{:<12}{}\n", c.name, c.about)).collect(),
            LocateFormat::Json => {
                let names: Vec<_> = casebook::CASES.iter().map(|c| c.name).collect();
                serde_json::to_string_pretty(&names).expect("plain data") + "\n"
            }
        });
    };
    if let (Some(folder), true) = (folder, casebook::CASES.iter().any(|c| c.name == name)) {
        let files = casebook::data(name).ok_or_else(|| format!("the case `{name}` has no curves\n"))?;
        for (file, text) in files {
            output::write(&folder.join(file), text.as_bytes())?;
        }
        return Ok(String::new());
    }
    let Some(report) = casebook::run(name) else {
        let known: Vec<_> = casebook::CASES.iter().map(|c| c.name).collect();
        return Err(format!("there is no case `{name}`; the cases are: {}\n", known.join(", ")));
    };
    Ok(match format {
        LocateFormat::Text => report.to_string(),
        LocateFormat::Json => serde_json::to_string_pretty(&report).expect("plain data") + "\n",
    })
}

/// `member=value` pairs of an option; everything that is wrong with them at once.
fn quantities(option: &str, given: &[String], dimension: Dimension) -> Result<Vec<(String, Quantity)>, String> {
    let (kind, example) = dimension.describe();
    let mut wrong = String::new();
    let mut all = Vec::new();
    for text in given {
        match text.split_once('=') {
            None => wrong += &format!("{option} {text}: write member=value, as in {option} 'sun={example}'\n"),
            Some((name, value)) => match units::parse(value, dimension) {
                Ok(q) => all.push((name.trim().to_owned(), q)),
                Err(why) => {
                    wrong += &format!("{option} {text}: {why}; give {kind}, as in {option} '{name}={example}'\n")
                }
            },
        }
    }
    if wrong.is_empty() { Ok(all) } else { Err(wrong) }
}

/// Values of an option; everything that is wrong with them at once.
fn values(option: &str, given: &[String], dimension: Dimension) -> Result<Vec<Quantity>, String> {
    let (kind, example) = dimension.describe();
    let mut wrong = String::new();
    let mut all = Vec::new();
    for text in given {
        match units::parse(text, dimension) {
            Ok(q) => all.push(q),
            Err(why) => wrong += &format!("{option} {text}: {why}; give {kind}, as in {option} '{example}'\n"),
        }
    }
    if wrong.is_empty() { Ok(all) } else { Err(wrong) }
}

/// The two members of `--balance`.
fn pair(names: Option<&[String]>) -> Result<Option<[String; 2]>, String> {
    match names {
        None => Ok(None),
        Some([a, b]) => Ok(Some([a.clone(), b.clone()])),
        Some(other) => {
            Err(format!("--balance names two terminals, as in --balance mg1,mg2; here are {}\n", other.len()))
        }
    }
}

/// A train read from somewhere, with the name to show.
struct Job {
    file: String,
    model: Model,
}

impl Job {
    /// Reads a train file and puts laws into force, `family=law`.
    fn read(file: &str, laws: &[String]) -> Result<Self, String> {
        let name = if file == "-" { "standard input" } else { file };
        let mut pairs = vec![];
        for text in laws {
            let Some((family, law)) = text.split_once('=') else {
                return Err(format!("--law {text}: write family=law, as in --law mesh_friction=niemann\n"));
            };
            pairs.push((family.trim(), law.trim()));
        }
        let text = input::read(file).map_err(|d| d.render(name, "", color()))?;
        let model = Model::read(&text, &mut input::tables_beside(file)).and_then(|m| m.with_laws(pairs));
        let model = model.map_err(|wrong| failure(&wrong, name, &text))?;
        Ok(Self { file: name.to_owned(), model })
    }

    fn train(&self) -> &Train {
        self.model.train()
    }

    fn analyze(&self, selection: &Selection) -> Result<Analysis, String> {
        analysis::analyze(self.train(), selection).map_err(|wrong| self.failure(wrong))
    }

    fn failure(&self, mut wrong: Diagnostics) -> String {
        self.model.locate(&mut wrong);
        failure(&wrong, &self.file, self.model.to_toml())
    }

    /// Warnings and notes, each at its place in the file.
    fn notes(&self, diagnostics: &[Diagnostic]) -> String {
        let mut all = Diagnostics::default();
        all.extend(diagnostics.iter().cloned());
        self.model.locate(&mut all);
        all.render(&self.file, self.model.to_toml(), color())
    }
}

fn failure(diagnostics: &Diagnostics, file: &str, text: &str) -> String {
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    let s = if errors == 1 { "" } else { "s" };
    format!("{}{file}: {errors} error{s}\n", diagnostics.render(file, text, color()))
}

/// Styles are always written; the stream strips them where they do not belong.
fn color() -> bool {
    true
}
