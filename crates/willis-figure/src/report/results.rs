//! What came out: the shift table, the operating points, losses, maps, motion, formulas.

use willis::analysis::{
    CertificateReport, Direction, HeatBasis, MachineReport, OperationReport, Role, SolutionReport, StateReport,
    VariatorReport, Verdict,
};
use willis::operating_point::LubricationRegime;
use willis::regimes::{ClosedFormula, FormulaRequest, formulas as closed};
use willis::statics::Certificate;
use willis::symbolic::Notation;
use willis::train::AS_DRAWN;

use super::{Findings, TOLD, and_more, notice};
use crate::FigureKind;
use crate::parts::style::{figures, watts};
use crate::parts::words::{law_of, law_title, spelled};
use crate::report::document::{Block, Column, Level, Section, Term};
use crate::report::formula::{Display, mathml};

/// Formulas that are printed.
const FORMULAS: usize = 9;
/// The width of a page in the type size of its formulas.
const LINE: f64 = 47.0;
/// Quantities in the table of what matters most.
const RANKED: usize = 12;

const RPM: f64 = 30.0 / std::f64::consts::PI;

/// So many digits, with a true minus sign.
pub fn significant(x: f64, digits: i32) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !x.is_finite() {
        return "–".to_owned();
    }
    let size = x.abs().log10().floor() as i32;
    if !(-5..9).contains(&size) {
        return figures(x, digits);
    }
    let decimals = (digits - 1 - size).clamp(0, 12) as usize;
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

/// So many decimals, so that numbers of a row stand below each other.
pub fn fixed(x: f64, decimals: usize) -> String {
    match x {
        0.0 => "0".to_owned(),
        // Of a small number that would leave too few digits.
        x if x.is_finite() && (0.1..1e5).contains(&x.abs()) => format!("{x:.decimals$}").replace('-', "−"),
        x => significant(x, 4),
    }
}

/// A power with its sign.
pub fn signed_watts(x: f64) -> String {
    if x > 0.0 { format!("+{}", watts(x)) } else { watts(x) }
}

pub fn signed(x: f64) -> String {
    if x > 0.0 { format!("+{}", significant(x, 3)) } else { significant(x, 3) }
}

/// Per cent with three decimals at most.
pub fn exact_percent(x: f64) -> String {
    let text = format!("{:.3}", 100.0 * x);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.').replace('-', "−"))
}

pub fn efficiency(s: &SolutionReport) -> String {
    match s.efficiency {
        Some(_) if s.all_dissipated => "none: all power is lost".to_owned(),
        Some(e) => exact_percent(e),
        None => "–".to_owned(),
    }
}

pub fn certificate(v: Verdict, c: &CertificateReport) -> &'static str {
    match (v, c.unique_for_every_load, c.method) {
        (Verdict::Locked, _, Certificate::Undecided) => "not proved",
        (Verdict::Locked, ..) => "proved: no equilibrium drives a load",
        (_, true, Certificate::SpectralRadius) => {
            "proved: exactly one equilibrium for every load (spectral radius below one)"
        }
        (_, true, _) => "proved: exactly one equilibrium for every load (all determinants of sign patterns agree)",
        (_, false, Certificate::Enumeration) => "not unique for every load; for this one every sign pattern was tried",
        _ => "uniqueness undecided",
    }
}

/// The one equilibrium, where there is one.
pub fn single(o: &OperationReport) -> Option<&SolutionReport> {
    match (&o.solutions[..], o.verdict) {
        ([one], Verdict::Unique | Verdict::Unloaded) => Some(one),
        _ => None,
    }
}

pub fn shift_table(all: &Findings<'_>) -> Option<Section> {
    let mut blocks = vec![];
    blocks.extend(all.figures.block(FigureKind::Shift, None, "States, ratios, steps and nominal efficiencies"));
    let columns = ["State", "From – to", "Ratio exactly"].map(Column::words).into_iter();
    let columns = columns
        .chain(["Ratio", "Step"].map(Column::numbers))
        .chain(["Nominal η driving", "Nominal η coasting"].map(Column::numbers))
        .chain([Column::words("Only solution")]);
    let rows: Vec<Vec<String>> = all.analysis.ratios.iter().map(|(name, s)| state(name, s)).collect();
    // The figure has all of it but the proofs.
    if matches!(blocks[..], [Block::Figure { .. }]) {
        blocks.push(Block::Text { text: proofs(all) });
    } else if !rows.is_empty() {
        let caption =
            "Ratio is the input's over the output's speed. Efficiencies are nominal: from those of the meshes as given or \
             assumed, whatever the operating point"
                .to_owned();
        blocks.push(Block::Table { caption, columns: columns.collect(), rows });
    }
    for (name, s) in all.analysis.ratios.iter() {
        for (way, d) in [("driving", &s.drive), ("coasting", &s.coast)] {
            if let (Some(reason), true) = (&d.reason, matches!(d.verdict, Verdict::Locked | Verdict::Multiple)) {
                let text = format!("State {name}, {way}: {}. {reason}", d.verdict.words());
                blocks.push(Block::Notice { level: Level::Stop, text });
            }
        }
    }
    let title = if all.model.train().states().is_empty() { "Ratio" } else { "Shift table" };
    (!blocks.is_empty()).then(|| Section { title: title.into(), blocks })
}

/// In which gears the solution is proved to be the only one.
fn proofs(all: &Findings<'_>) -> String {
    let open = |(name, s): &(String, StateReport)| {
        let ways = [("driving", &s.drive), ("coasting", &s.coast)].into_iter();
        let not: Vec<&str> = ways.filter(|(_, d)| !proved(d)).map(|(way, _)| way).collect();
        (!not.is_empty()).then(|| format!("{name} ({})", not.join(", ")))
    };
    let open: Vec<String> = all.analysis.ratios.iter().filter_map(open).collect();
    let exactly = "It is proved that the solution is the only one for every load, driving and coasting, with the nominal \
                   efficiencies: from those of the meshes as given or assumed, whatever the operating point";
    match open.is_empty() {
        true => format!("{exactly}."),
        false => format!("{exactly}. It is not proved of: {}.", open.join("; ")),
    }
}

fn proved(d: &Direction) -> bool {
    d.certificate.is_some_and(|c| c.unique_for_every_load)
}

fn state(name: &str, s: &StateReport) -> Vec<String> {
    let way = |d: &Direction| match d.efficiency {
        Some(e) => exact_percent(e),
        None => d.verdict.words().to_owned(),
    };
    let certain = match (proved(&s.drive), proved(&s.coast)) {
        (true, true) => "both ways",
        (true, false) => "driving",
        (false, true) => "coasting",
        _ => "no",
    };
    vec![
        name.to_owned(),
        format!("{} – {}", s.input, s.output),
        s.exact
            .as_ref()
            .map(|i| i.to_fraction().replace('-', "−"))
            .or(s.no_ratio.clone())
            .unwrap_or_else(|| "–".into()),
        s.value.map_or("–".into(), |v| significant(v, 6)),
        s.step.map_or(String::new(), |v| significant(v, 4)),
        way(&s.drive),
        way(&s.coast),
        certain.to_owned(),
    ]
}

pub fn operations(all: &Findings<'_>) -> Option<Section> {
    let mut blocks = vec![];
    blocks.extend(and_more(all.analysis.operations.len(), "operating points"));
    for o in all.analysis.operations.iter().take(TOLD) {
        let state = o.state.as_ref().map(|s| format!(", state {s}")).unwrap_or_default();
        blocks.push(Block::Heading { text: format!("{}{state}", o.name) });
        blocks.push(notice(o));
        blocks.extend(value(all, o));
        let count = o.solutions.len();
        for (k, s) in o.solutions.iter().enumerate() {
            let which = if count > 1 { format!(", solution {} of {count}", k + 1) } else { String::new() };
            blocks.push(members(&format!("Members{which}"), s));
            blocks.push(Block::Text { text: balance(s) });
            blocks.extend(elements(s));
            blocks.extend(bearings(&o.name, s));
            blocks.extend(variators(s));
            blocks.extend(stiction(s));
        }
        for s in &o.dissipative_solutions {
            blocks.push(members("Members, if every loaded member pushes", s));
            blocks.push(Block::Text { text: balance(s) });
        }
        let of = Some(o.name.as_str());
        let sankey = format!("Where the power goes at {}; widths to scale", o.name);
        blocks.extend(all.figures.block(FigureKind::Sankey, of, &sankey));
        let lever = format!("Speeds and torques on levers at {}", o.name);
        blocks.extend(all.figures.block(FigureKind::Lever, of, &lever));
    }
    if all.analysis.operations.is_empty() {
        let text = "Speeds and torques for one unit of speed and torque at the input, as levers.";
        blocks.push(Block::Text { text: text.into() });
        blocks.extend(all.figures.block(FigureKind::Lever, None, "Speeds on levers"));
    }
    blocks.extend(all.figures.block(FigureKind::Split, None, "The power split over its ratio"));
    let title = if all.analysis.operations.is_empty() { "Levers" } else { "Operating points" };
    (!blocks.is_empty()).then(|| Section { title: title.into(), blocks })
}

/// What is known of the value of an efficiency, as another matter than whether the solution is the only one: its band, what
/// that comes from, and laws that are used outside their ranges.
fn value(all: &Findings<'_>, o: &OperationReport) -> Option<Block> {
    let s = single(o)?;
    let mut text = match (&o.band, s.efficiency) {
        (Some(band), Some(value)) => {
            let decimals = band.decimals();
            let percent = |e: f64| format!("{:.decimals$} %", 100.0 * e);
            let [low, high] = [&band.low, &band.high].map(|end| {
                let laws: Vec<String> = end.laws.iter().map(|(f, law)| law_of(f, law)).collect();
                format!("{} ({})", percent(end.efficiency), laws.join(", "))
            });
            let which = if band.beyond_ranges() { "laws, some outside their ranges" } else { "laws in range" };
            format!("Value: efficiency {}, {}; over {which} from {low} to {high}.", percent(value), basis(s))
        }
        _ => format!("Value: efficiency {}, {}.", efficiency(s), basis(s)),
    };
    if let Some(sure) = all.sure(&o.name) {
        text += &format!(" {}", sure.words());
    }
    for law in &o.outside_laws {
        text += &format!(" Outside the range of a law: {law}.");
    }
    let level = if o.outside_laws.is_empty() { Level::Note } else { Level::Warning };
    Some(Block::Notice { level, text })
}

/// What an efficiency of an operating point rests on.
pub fn basis(s: &SolutionReport) -> &'static str {
    match s.sources.iter().any(|x| x.law != "given") {
        true => "computed at this operating point from the laws of loss",
        false => "from the mesh efficiencies of the file",
    }
}

fn members(caption: &str, s: &SolutionReport) -> Block {
    let columns = ["Member", "Role"].map(Column::words).into_iter();
    let columns = columns.chain(["Speed, rpm", "Torque, N m", "Power"].map(Column::numbers)).collect();
    let number = |x: Option<f64>, scale: f64| x.map_or("–".into(), |x| significant(x * scale, 5));
    let rows = (s.members.iter())
        .map(|(name, m)| {
            let role = match m.role {
                Role::Input => "input",
                Role::Output => "output",
                Role::Fixed => "held",
                _ => "",
            };
            let power = m.power_w.filter(|p| *p != 0.0).map_or("–".into(), watts);
            vec![name.clone(), role.to_owned(), number(m.speed_rad_s, RPM), number(m.torque_n_m, 1.0), power]
        })
        .collect();
    let caption =
        format!("{caption}; torque is the external torque on the member, power flows in where it is positive");
    Block::Table { caption, columns, rows }
}

fn balance(s: &SolutionReport) -> String {
    let mut text = format!(
        "{} in, {} out, {} lost: efficiency {}.",
        watts(s.input_power_w),
        watts(s.output_power_w),
        watts(s.loss_w),
        efficiency(s),
    );
    // Round-off is nothing to tell.
    if s.power_residual_w.abs() > 1e-9 * s.input_power_w.abs() {
        text += &format!(" The balance of power closes to {}.", watts(s.power_residual_w.abs()));
    }
    for c in &s.recirculation {
        text += &format!(
            " {} ({} % of the input) run in a circle: {}.",
            watts(c.power_w),
            significant(100.0 * c.share_of_input, 3),
            c.path.join(" → ")
        );
    }
    if let Some(c) = &s.convergence {
        text += &match c.converged {
            true => format!(" Losses and torques agree after {} rounds.", c.rounds),
            false => {
                format!(" NOT CONVERGED after {} rounds: {} of the loss is left.", c.rounds, exact_percent(c.error))
            }
        };
    }
    if let Some(l) = &s.margin.lock {
        text += &format!(
            " It would lock if the efficiency of {} fell from {} to {}.",
            l.meshes.join(", "),
            exact_percent(l.efficiency),
            exact_percent(l.threshold)
        );
    }
    text
}

/// What friction in meshes at rest leaves open.
fn stiction(s: &SolutionReport) -> Option<Block> {
    let range = |r: &willis::analysis::StictionRange| match (r.low, r.high) {
        (Some(low), Some(high)) => {
            format!("{} anywhere from {} to {}", r.what, significant(low, 6), significant(high, 6))
        }
        _ => format!("{}, within limits that were not found", r.what),
    };
    let all: Vec<String> = s.stiction.iter().map(range).collect();
    let text = || {
        format!(
            "Friction in meshes at rest leaves open: {}. The tables and pictures show the case in which those meshes lose \
             nothing.",
            all.join("; ")
        )
    };
    (!all.is_empty()).then(|| Block::Notice { level: Level::Note, text: text() })
}

fn elements(s: &SolutionReport) -> Option<Block> {
    let columns = ["Engaged", "Kind", "Joins"].map(Column::words).into_iter();
    let columns = columns.chain([Column::numbers("Torque, N m")]).collect();
    let rows: Vec<Vec<String>> = (s.shift_elements.iter())
        .map(|(name, e)| {
            let torque = e.torque_n_m.map_or("not divided by statics".into(), |t| significant(t, 5));
            vec![name.clone(), e.kind.to_string(), e.members.join(" – "), torque]
        })
        .collect();
    (!rows.is_empty()).then(|| Block::Table { caption: "Torques of engaged elements".into(), columns, rows })
}

/// The forces on bearings.
fn bearings(operation: &str, s: &SolutionReport) -> Option<Block> {
    let columns = ["Bearing", "Designation", "Joins"].map(Column::words).into_iter();
    let numbers = ["Number", "Speed, rpm", "Radial force, N", "Axial force, N", "Friction, N m", "Loss of all"];
    let columns = columns.chain(numbers.map(Column::numbers)).collect();
    let rows: Vec<Vec<String>> = (s.bearings.iter())
        .map(|(name, b)| {
            let n = |x: f64| significant(if x.abs() < 1e-9 { 0.0 } else { x }, 4);
            vec![
                name.clone(),
                b.designation.clone(),
                b.members.join(" – "),
                b.bearings.to_string(),
                n(b.speed_rad_s.abs() * RPM),
                n(b.radial_load_n),
                n(b.axial_load_n),
                significant(b.torque_n_m, 3),
                watts(b.loss_w),
            ]
        })
        .collect();
    let caption = format!(
        "Forces on bearings at {operation}, each of one bearing, the most loaded; the speed is that of one ring relative to the other"
    );
    (!rows.is_empty()).then_some(Block::Table { caption, columns, rows })
}

/// What each variator does, side by side or machine by machine.
fn variators(s: &SolutionReport) -> Vec<Block> {
    let one = |(name, v): &(String, VariatorReport)| {
        let columns = ["Side", "On member"].map(Column::words).into_iter();
        let columns =
            columns.chain(["Speed, rpm", "Torque on it, N m", "Power into it"].map(Column::numbers)).collect();
        let row = |(side, m): &(String, MachineReport)| {
            let power = watts(m.power_w);
            let [speed, torque] = [m.speed_rad_s * RPM, m.torque_n_m].map(|x| significant(x, 5));
            vec![side.clone(), m.member.clone(), speed, torque, power]
        };
        let store = match v.store_w {
            Some(p) if p > 0.0 => format!("; its store gives {}", watts(p)),
            Some(p) if p < 0.0 => format!("; its store takes {}", watts(-p)),
            _ => String::new(),
        };
        let share = exact_percent(v.share).replace('-', "−");
        let caption =
            format!("{name}: {share} of the input power arrives through it, {} is lost{store}", watts(v.loss_w));
        Block::Table { caption, columns, rows: v.machines.iter().map(row).collect() }
    };
    s.variators.iter().map(one).collect()
}

pub fn losses(all: &Findings<'_>) -> Option<Section> {
    let mut blocks = vec![];
    if let Some((o, s)) = all.analysis.operations.iter().find_map(|o| Some((o, single(o)?))) {
        let from = format!("At {} {} of {} are lost", o.name, watts(s.loss_w), watts(s.input_power_w));
        let most =
            s.sources.first().map(|x| format!("; the most in {}, {}: {}", x.name, x.kind.words(), watts(x.loss_w)));
        blocks.push(Block::Text { text: format!("{from}{}.", most.unwrap_or_default()) });
    }
    let told = blocks.len();
    blocks.extend(all.figures.block(FigureKind::Losses, None, "Losses by source"));
    for o in all.analysis.operations.iter().take(TOLD) {
        let Some(s) = single(o).filter(|s| !s.sources.is_empty()) else { continue };
        let columns = ["Loss", "Kind", "Law"].map(Column::words).into_iter();
        let columns = columns.chain(["Loss", "Share"].map(Column::numbers)).collect();
        let rows = (s.sources.iter().filter(|x| x.loss_w > 0.0))
            .map(|x| {
                vec![
                    x.name.clone(),
                    x.kind.words().into(),
                    law_title(Some(x.kind), &x.law),
                    watts(x.loss_w),
                    percent(x.share),
                ]
            })
            .collect();
        blocks.push(Block::Table { caption: format!("Losses at {}", o.name), columns, rows });
        blocks.extend(contacts(&o.name, s));
    }
    blocks.extend(all.figures.block(FigureKind::Film, None, "Oil film over roughness along the path of contact"));
    blocks.extend(all.figures.block(FigureKind::Path, None, "Friction, sliding and load along the path of contact"));
    match all.figures.block(FigureKind::Tornado, None, "What to change first: what a step of each quantity changes") {
        Some(picture @ Block::Figure { .. }) => blocks.push(picture),
        other => blocks.extend(what_first(all).into_iter().chain(other)),
    }
    if told == 0 && !blocks.is_empty() {
        let text = "The file has no operating point; this is at one by default, which the picture names.";
        blocks.insert(0, Block::Text { text: text.into() });
    }
    // Nothing but the sum is in the summary already.
    if blocks.len() == told {
        blocks.clear();
    }
    (!blocks.is_empty()).then(|| Section { title: "Losses, and what to change first".into(), blocks })
}

/// A share, with three digits.
fn percent(x: f64) -> String {
    format!("{} %", significant(100.0 * x, 3))
}

fn contacts(operation: &str, s: &SolutionReport) -> Option<Block> {
    let heads = ["µ", "HV", "Fₜ, N", "vₜ, m/s", "slide, m/s", "Hertz, MPa", "h, µm", "λ"];
    let columns = [Column::words("Tooth contact")].into_iter().chain(heads.map(Column::numbers));
    let columns = columns.chain([Column::words("Film")]).collect();
    let rows: Vec<Vec<String>> = (s.contacts.iter())
        .map(|(name, c)| {
            let n = |x: f64| significant(x, 4);
            let or = |x: Option<f64>| x.map_or("–".into(), |x| significant(x, 3));
            let film = c.regime.map_or("–", LubricationRegime::words);
            vec![
                name.clone(),
                or(c.friction),
                n(c.loss_factor),
                n(c.tangential_force_n),
                n(c.pitch_line_speed_m_s),
                significant(c.sliding_speed_m_s, 3),
                n(c.pressure_pa / 1e6),
                or(c.film_m.map(|h| h * 1e6)),
                or(c.film_ratio),
                film.to_owned(),
            ]
        })
        .collect();
    let caption = format!(
        "Tooth contacts at {operation}: mean friction, loss factor, tangential force, pitch line speed, largest sliding \
         speed and pressure, smallest film, film over roughness"
    );
    (!rows.is_empty()).then_some(Block::Table { caption, columns, rows })
}

fn what_first(all: &Findings<'_>) -> Option<Block> {
    let o = match all.sensitivity.as_ref()? {
        Ok(found) => found.operations.first()?,
        Err(wrong) => {
            let why: Vec<&str> = wrong.iter().map(|d| d.message.as_str()).collect();
            let text = format!("What to change first could not be computed. {}", why.join("; "));
            return Some(Block::Notice { level: Level::Warning, text });
        }
    };
    let columns = [Column::words("Quantity")].into_iter();
    let columns = columns
        .chain([Column::numbers("Step"), Column::numbers("η, points"), Column::numbers("Losses, W")])
        .chain([Column::words("Moves most")])
        .collect();
    let rows: Vec<Vec<String>> = (o.quantities.iter().take(RANKED))
        .map(|q| {
            let most = q.sources.first().map_or(String::new(), |x| format!("{} {} W", x.name, signed(x.change_w)));
            let name = if q.assumed { format!("{} (not given)", spelled(&q.name)) } else { spelled(&q.name) };
            vec![
                name,
                q.step.label().to_owned(),
                q.efficiency_change.map_or("–".into(), |e| signed(if e.abs() < 1e-10 { 0.0 } else { 100.0 * e })),
                signed(q.loss_change_w),
                most,
            ]
        })
        .collect();
    let caption = format!(
        "What to change first at {}: exact derivatives times a small step, the largest effect first ({} of {})",
        o.name,
        rows.len(),
        o.quantities.len()
    );
    (!rows.is_empty()).then_some(Block::Table { caption, columns, rows })
}

/// Oil temperature of every operating point, and where its heat goes.
pub fn heat(all: &Findings<'_>) -> Option<Section> {
    let celsius = |t: f64| fixed(t - 273.15, 1);
    let of = |o: &OperationReport| {
        let h = o.heat.as_ref()?;
        let from = match (h.basis, h.verdict) {
            (HeatBasis::Given, _) => "given",
            (_, Some(verdict)) => verdict.words(),
            (_, None) => "–",
        };
        let limit = h.basis == HeatBasis::Limit;
        Some(vec![
            o.name.clone(),
            if limit { format!("above {}", celsius(h.limit_k)) } else { celsius(h.oil_k) },
            from.to_owned(),
            if limit { "–".into() } else { fixed(h.margin_k, 1) },
            celsius(h.ambient_k),
            watts(h.heat_w),
        ])
    };
    let rows: Vec<Vec<String>> = all.analysis.operations.iter().filter_map(of).collect();
    let columns = ["Operating point", "Oil, °C", "Balance", "Below the limit, K", "Air, °C", "Heat"];
    let columns =
        columns.map(|c| if matches!(c, "Operating point" | "Balance") { Column::words(c) } else { Column::numbers(c) });
    let caption = "Oil temperature at which losses and the heat that is carried away agree".to_owned();
    let mut blocks: Vec<Block> = vec![];
    if !rows.is_empty() {
        blocks.push(Block::Table { caption, columns: columns.into(), rows });
    }
    blocks.extend(all.figures.block(FigureKind::Heat, None, "How warm it gets: places, balance and warm-up"));
    (!blocks.is_empty()).then(|| Section { title: "Heat".into(), blocks })
}

pub fn maps(all: &Findings<'_>) -> Option<Section> {
    let mut blocks = vec![];
    blocks.extend(all.figures.block(FigureKind::Map, None, "Efficiency map"));
    blocks.extend(all.figures.block(
        FigureKind::Band,
        None,
        "How sure efficiency and losses are; what counts as uncertain stands below the picture",
    ));
    let text = match all.model.train().states().is_empty() {
        true => "How the efficiency depends on the operating point.",
        false => "How the efficiency depends on the operating point and the state.",
    };
    (!blocks.is_empty()).then(|| {
        blocks.insert(0, Block::Text { text: text.into() });
        Section { title: "Maps".into(), blocks }
    })
}

pub fn motion(all: &Findings<'_>) -> Option<Section> {
    let [scenario, others @ ..] = all.model.train().scenarios() else { return None };
    let figure = all.figures.block(FigureKind::Time, None, &format!("Scenario {}", scenario.name))?;
    let others: Vec<&str> = others.iter().map(|s| s.name.as_str()).collect();
    let more = if others.is_empty() { String::new() } else { format!(" The file has others: {}.", others.join(", ")) };
    let text = format!("Speeds, torques and powers over time in the scenario {}.{more}", scenario.name);
    Some(Section { title: "Motion".into(), blocks: vec![Block::Text { text }, figure] })
}

pub fn formulas(all: &Findings<'_>) -> Option<Section> {
    let train = all.model.train();
    let mut blocks = vec![];
    blocks.extend(all.figures.block(
        FigureKind::Regimes,
        None,
        "Every regime of the two freedoms: directions of speed, inputs and outputs, efficiency",
    ));
    let title = if blocks.is_empty() { "Closed formulas" } else { "Regimes and closed formulas" };
    if let Ok(sheet) = closed(train, &FormulaRequest::default()) {
        // A gear in which all turn as one needs no formula.
        let count = sheet.formulas.iter().filter(|f| !f.arguments.is_empty()).count();
        let mut printed: Vec<&ClosedFormula> = vec![];
        for f in &sheet.formulas {
            if printed.len() == FORMULAS {
                break;
            }
            let Some(own) = formula(f).filter(|_| !f.arguments.is_empty()) else { continue };
            printed.push(f);
            blocks.extend(own);
        }
        blocks.extend(symbols(&printed));
        if printed.len() < count {
            let text = format!(
                "{} of {count} formulas are not printed here, for their number or their length. The command willis formula \
                 gives them all, also as code.",
                count - printed.len()
            );
            blocks.push(Block::Text { text });
        }
    }
    (!blocks.is_empty()).then(|| Section { title: title.into(), blocks })
}

/// A formula with its left side and the conditions under which it holds; none where it is wider than a page.
fn formula(f: &ClosedFormula) -> Option<Vec<Block>> {
    let heading = match f.state == AS_DRAWN {
        true => f.title.clone(),
        false => format!("State {}: {}", f.state, f.title),
    };
    let mut lines = vec![format!("\\eta = {}", f.efficiency(Notation::Latex))];
    if let ([from], [to], Some([speed, _])) = (&f.inputs[..], &f.outputs[..], f.ratios(Notation::Latex)) {
        let (from, to) = (index(from), index(to));
        lines.push(format!("i = \\frac{{\\omega_{{{from}}}}}{{\\omega_{{{to}}}}} = {speed}"));
        // What enters less what is lost leaves.
        lines.push(format!("\\frac{{T_{{{to}}}}}{{T_{{{from}}}}} = -\\eta\\,i"));
    }
    if !lines.iter().all(|latex| fits(latex)) {
        return None;
    }
    let mut blocks = vec![Block::Heading { text: heading }];
    // As many in a line as fit there.
    let mut line = String::new();
    for latex in lines {
        let longer = format!("{line}, \\qquad {latex}");
        match line.is_empty() {
            true => line = latex,
            false if fits(&longer) => line = longer,
            false => blocks.push(Block::Formula { latex: std::mem::replace(&mut line, latex), note: String::new() }),
        }
    }
    blocks.push(Block::Formula { latex: line, note: String::new() });
    let items = conditions(f);
    if !items.is_empty() {
        blocks.push(Block::Terms { head: "It holds where".into(), items });
    }
    Some(blocks)
}

/// The conditions of a formula that fit the width of a page; the others are counted.
fn conditions(f: &ClosedFormula) -> Vec<Term> {
    let all =
        f.conditions(Notation::Latex).into_iter().map(|(latex, text)| Term { latex: format!("{latex} > 0"), text });
    let (short, long): (Vec<Term>, Vec<Term>) =
        all.partition(|t| !t.latex.contains("\\begin") && width(&t.latex).is_some_and(|w| w < 0.6 * LINE));
    let more = (!long.is_empty()).then(|| Term {
        latex: format!("+ {}", long.len()),
        text: "more, too long for this page; the command willis formula has them".to_owned(),
    });
    short.into_iter().chain(more).collect()
}

/// What the symbols of these formulas stand for, each once.
fn symbols(formulas: &[&ClosedFormula]) -> Option<Block> {
    let mut items: Vec<Term> = vec![];
    for a in formulas.iter().flat_map(|f| &f.arguments) {
        // Speeds and torques are the reader's to give.
        let latex = match a.fixed {
            true => format!("{} = {}", a.latex, significant(a.value, 6).replace('−', "-")),
            false => a.latex.clone(),
        };
        let own = match &a.made_of {
            Some(formula) => Term { latex: format!("{latex} = {formula}"), text: "basic ratio".to_owned() },
            None => Term { latex, text: a.meaning.clone() },
        };
        match items.iter_mut().find(|t| t.latex == own.latex) {
            // Whichever wheel drives: of several gears each has its own words.
            Some(same) if !same.text.contains(&own.text) => same.text = format!("{}; {}", same.text, own.text),
            Some(_) => {}
            None => items.push(own),
        }
    }
    (!items.is_empty()).then(|| Block::Terms { head: "Symbols:".into(), items })
}

/// A name as an upright index.
fn index(name: &str) -> String {
    let escaped = name.chars().fold(String::new(), |mut out, c| {
        match c {
            '_' | '&' | '%' | '$' | '#' | '{' | '}' => out.extend(['\\', c]),
            '\\' | '^' | '~' => out.push(' '),
            c => out.push(c),
        }
        out
    });
    format!("\\text{{{escaped}}}")
}

/// How wide a formula is, in its type size.
fn width(latex: &str) -> Option<f64> {
    mathml(latex, Display::Line).map(|(_, width)| width)
}

/// Whether a formula fits the width of a page.
fn fits(latex: &str) -> bool {
    width(latex).is_some_and(|w| w <= LINE)
}
