//! A set with three terminals for every basic ratio it can have: Esmail's Table 1, and what lies
//! between its columns.
//!
//! With links p and q (the ends of the set) on carrier c and `R = R^c_{q,p} = (ω_q − ω_c)/(ω_p − ω_c)`,
//! the torque on c is `(ρ/R − 1) T_p`. It turns round at `R = η` (p drives) and `R = 1/η` (q drives);
//! speeds change their order at R = 0 and R = 1. So five ranges of R have regimes of their own. The
//! paper's table has the two outermost of the positive ones.

use serde::{Deserialize, Serialize};

use crate::analysis::NameMap;
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::train::Train;

use super::atlas::{assignment_order, atlas};
use super::basis::EfficiencyBasis;
use super::setup::{Linked, Setup};
use super::{RegimeSelection, SelectedConfiguration, selected};

/// Every regime of a set with three terminals, over all basic ratios.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Family {
    /// `willis-family-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The ends of the set, p and q, and its carrier.
    pub ends: [String; 2],
    /// See `ends`.
    pub carrier: String,
    /// What R is.
    pub ratio: String,
    /// R of this train.
    pub value: f64,
    /// The same, exactly.
    pub exact: Rational,
    /// Efficiency seen from the carrier, p driving and q driving.
    pub efficiencies: [f64; 2],
    /// The ranges of R.
    pub cases: Vec<FamilyCase>,
    /// The assignments of inputs and outputs, in the paper's order, with their regimes in each range.
    pub rows: Vec<Row>,
    /// Number of regimes in all ranges.
    pub regimes: usize,
    /// Where mesh efficiencies come from whose losses laws compute; absent where all are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_basis: Option<EfficiencyBasis>,
}

impl Contract for Family {
    const FORMAT: &'static str = "willis-family-1";
}

/// A range of basic ratios.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
// The schema keeps the name that is published.
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Case"))]
#[non_exhaustive]
pub struct FamilyCase {
    /// `R > 1/eta`.
    pub label: String,
    /// In LaTeX.
    pub latex: String,
    /// Lower bound of R.
    pub low: Option<f64>,
    /// Upper bound of R.
    pub high: Option<f64>,
    /// Between a self-locking limit and 1: not in the paper.
    pub band: bool,
    /// Whether this train lies in it.
    pub here: bool,
    /// A ratio in it.
    pub example: f64,
}

/// An assignment of inputs and outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Row {
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// For each range of R, the regimes in groups that share a formula.
    pub cells: Vec<Vec<Group>>,
}

/// Regimes with one driver and so one formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Group {
    /// The end that drives, seen from the carrier.
    pub driver: String,
    /// The loss over the input power, `l = η − 1`, in the paper's notation.
    pub loss: String,
    /// The same in LaTeX.
    pub loss_latex: String,
    /// Torque signs and order of speeds, in pairs of mirror images.
    pub ranges: Vec<FamilyRange>,
}

/// Signs of torques and order of speeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FamilyRange {
    /// Sign of each terminal's torque.
    pub torque_signs: NameMap<i8>,
    /// Terminals and `0`, from the fastest down.
    pub order: Vec<String>,
    /// Efficiency at the example ratio, at speeds in the middle of the range.
    pub efficiency: f64,
}

/// All regimes of a set with three terminals, over all basic ratios.
///
/// # Errors
/// A train that is not one set with three terminals and two freedoms; an unknown state.
///
/// # Example
/// ```
/// use willis::regimes::{RegimeSelection, family};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("differential")
///     .members(["1", "2", "4"])
///     .terminals(["1", "2", "4"])
///     .set(SetSpec::simple("P1", ("1", 30), ("4", 70), "2").planet(20, 4).basic_efficiency(0.98))
///     .build()?;
/// let all = family(&train, &RegimeSelection::default())?;
/// assert_eq!(all.regimes, 80);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn family(train: &Train, selection: &RegimeSelection) -> Result<Family, Diagnostics> {
    let refuse = |why: String| {
        let mut all = Diagnostics::default();
        all.push(
            Diagnostic::new(Code::Unfit, "", format!("no table over all basic ratios: {why}"))
                .hint("it is for one set with three terminals and two degrees of freedom; leave out `family`"),
        );
        all
    };
    let choices = selected(train, selection)?;
    let mut reason = "the train has no state with two degrees of freedom".to_owned();
    for SelectedConfiguration { state, configuration, terminals, basis, .. } in choices {
        let setup = match Setup::new(configuration.clone(), &terminals, Linked::Nothing) {
            Ok(setup) => setup,
            Err(why) => {
                reason = why;
                continue;
            }
        };
        if setup.active.len() != 1 || setup.terminals.len() != 3 || setup.base.len() != 2 {
            reason = format!(
                "{state}: loaded elements {}, terminals {}, degrees of freedom {}",
                setup.active.len(),
                setup.terminals.len(),
                setup.base.len()
            );
            continue;
        }
        let index = setup.active[0];
        let e = setup.element(0).clone();
        let name = |m| train.member_name(m).to_owned();
        let here = setup.ratio(0).recip();
        let (forward, backward) = (e.forward.clone(), e.backward.recip());
        let equal = e.forward == e.backward;
        let mut bounds = vec![Rational::ZERO, forward.clone(), Rational::ONE, backward.clone()];
        bounds.dedup();
        let eta = if equal { ["eta", "1/eta"] } else { ["eta_f", "1/eta_b"] };
        let tex = if equal { ["\\eta", "1/\\eta"] } else { ["\\eta_f", "1/\\eta_b"] };
        let word = |x: &Rational, names: [&str; 2]| {
            if x.is_zero() {
                "0".to_owned()
            } else if *x == Rational::ONE {
                "1".to_owned()
            } else if *x == forward {
                names[0].to_owned()
            } else {
                names[1].to_owned()
            }
        };
        let two = Rational::from(2);
        let mut cases = Vec::new();
        let mut lists: Vec<Vec<(Vec<i8>, Group)>> = Vec::new();
        let mut regimes = 0;
        for k in 0..=bounds.len() {
            let low = k.checked_sub(1).map(|k| bounds[k].clone());
            let high = bounds.get(k).cloned();
            let example = match (&low, &high) {
                _ if low.as_ref().is_none_or(|l| *l < here) && high.as_ref().is_none_or(|h| here < *h) => here.clone(),
                (Some(l), Some(h)) => (l + h) / &two,
                (Some(l), None) => l + l,
                (None, _) => Rational::from(-1),
            };
            let label = |r: &str, names: [&str; 2], low: &Option<Rational>, high: &Option<Rational>| match (low, high) {
                (Some(l), Some(h)) => format!("{} < {r} < {}", word(l, names), word(h, names)),
                (Some(l), None) => format!("{r} > {}", word(l, names)),
                (None, Some(h)) => format!("{r} < {}", word(h, names)),
                (None, None) => r.to_owned(),
            };
            let one = Rational::ONE;
            let band = low.as_ref() == Some(&one) && high.is_some()
                || high.as_ref() == Some(&one) && low.as_ref().is_some_and(|l| !l.is_zero());
            let float = |x: &Option<Rational>| x.as_ref().map(Rational::to_f64);
            cases.push(FamilyCase {
                label: label("R", eta, &low, &high),
                latex: label("R", tex, &low, &high),
                low: float(&low),
                high: float(&high),
                band,
                here: example == here,
                example: example.to_f64(),
            });
            // The same train with this basic ratio.
            let mut c = configuration.clone();
            c.elements[index].b = -(&e.a / &example);
            let own = atlas(state.clone(), c, &terminals, None);
            regimes += own.regimes.len();
            let mut list: Vec<(Vec<i8>, Group)> = Vec::new();
            for r in &own.regimes {
                let p_drives = r.pattern[0] == Some(true);
                let order = {
                    let region = &own.regions[r.region - 1];
                    let mut speeds: Vec<(f64, String)> =
                        region.example.iter().map(|(n, w)| (*w, n.clone())).chain([(0.0, "0".to_owned())]).collect();
                    speeds.sort_by(|a, b| b.0.total_cmp(&a.0));
                    speeds.into_iter().map(|(_, n)| n).collect()
                };
                let range =
                    FamilyRange { torque_signs: r.torque_signs.clone(), order, efficiency: r.example.efficiency };
                let driver = name(if p_drives { e.p } else { e.q });
                match list.iter_mut().find(|(powers, g)| *powers == r.power_signs && g.driver == driver) {
                    Some((_, g)) => g.ranges.push(range),
                    None => {
                        let links = [e.p, e.q, e.carrier].map(name);
                        let notation = Paper { links: &links, equal, meshes: e.links.len() };
                        let at = |m| setup.terminals.iter().position(|t| setup.c.node(m) == Some(t.node));
                        let roles = [e.p, e.q, e.carrier].map(|m| at(m).map_or(0, |t| r.power_signs[t]));
                        let [loss, loss_latex] = [false, true].map(|latex| notation.loss(p_drives, roles, latex));
                        list.push((r.power_signs.clone(), Group { driver, loss, loss_latex, ranges: vec![range] }));
                    }
                }
            }
            lists.push(list);
        }
        let terminal_names: Vec<String> = setup.terminals.iter().map(|t| name(t.member)).collect();
        let rows = assignment_order(3)
            .into_iter()
            .map(|powers| {
                let of = |sign: i8| (0..3).filter(|&t| powers[t] == sign).map(|t| terminal_names[t].clone()).collect();
                let cells = lists
                    .iter()
                    .map(|l| l.iter().filter(|(p, _)| *p == powers).map(|(_, g)| g.clone()).collect())
                    .collect();
                Row { inputs: of(1), outputs: of(-1), cells }
            })
            .collect();
        let [p, q, carrier] = [e.p, e.q, e.carrier].map(name);
        return Ok(Family {
            format: Format::new(),
            train: train.name.clone(),
            ratio: format!("R = (w_{q} - w_{carrier})/(w_{p} - w_{carrier})"),
            ends: [p, q],
            carrier,
            value: here.to_f64(),
            exact: here,
            efficiencies: [e.forward.to_f64(), e.backward.to_f64()],
            cases,
            rows,
            regimes,
            efficiency_basis: basis,
        });
    }
    Err(refuse(reason))
}

/// The paper's notation: `R^v_{w,u} = (ω_w − ω_v)/(ω_u − ω_v)`, f the frame.
struct Paper<'a> {
    /// The ends p, q and the carrier.
    links: &'a [String; 3],
    equal: bool,
    meshes: usize,
}

impl Paper<'_> {
    /// `l = η − 1` for roles of p, q, c and the driving end.
    fn loss(&self, p_drives: bool, roles: [i8; 3], latex: bool) -> String {
        if roles.iter().all(|r| *r >= 0) {
            return "-1".to_owned();
        }
        let eta = self.efficiency(p_drives, latex);
        let less = format!("({eta} - 1)");
        // The link that stands alone as input or output carries the reference power.
        let inputs = roles.iter().filter(|r| **r > 0).count();
        let lone = roles.iter().position(|r| (*r > 0) == (inputs == 1)).unwrap_or(0);
        let [driver, driven] = if p_drives { [0, 1] } else { [1, 0] };
        // Loss over the power of the lone link, as (sign of (η − 1), the rest).
        let (sign, share) = if lone == driver {
            (-1, self.product(&less, &self.ratio(lone, 2, None, latex), None, latex))
        } else if lone == driven {
            (1, self.product(&less, &self.ratio(lone, 2, None, latex), Some(&eta), latex))
        } else {
            let other = self.ratio(2, driven, Some(driver), latex);
            let below = if latex { format!("\\frac{{{eta}}}{{{other}}} - 1") } else { format!("({eta}/{other} - 1)") };
            (1, self.product(&less, &self.ratio(2, driver, None, latex), Some(&below), latex))
        };
        if inputs == 1 {
            // l = −L/P_in
            return if sign > 0 { format!("-{share}") } else { share };
        }
        // l = 1/(1 + L/|P_out|) − 1, P_out = −|P_out|
        let inner = if sign > 0 { format!("1 - {share}") } else { format!("1 + {share}") };
        if latex { format!("\\left[{inner}\\right]^{{-1}} - 1") } else { format!("1/({inner}) - 1") }
    }

    fn product(&self, less: &str, ratio: &str, below: Option<&str>, latex: bool) -> String {
        match (below, latex) {
            (None, false) => format!("{less}*{ratio}"),
            (None, true) => format!("{less} {ratio}"),
            (Some(b), false) if b.starts_with('(') => format!("{less}*{ratio}/{b}"),
            (Some(b), false) => format!("{less}*{ratio}/({b})"),
            (Some(b), true) => format!("\\frac{{{less} {ratio}}}{{{b}}}"),
        }
    }

    /// `R^{link}_{to,f}`, or `R^{link}_{to,from}`.
    fn ratio(&self, link: usize, to: usize, from: Option<usize>, latex: bool) -> String {
        let from = from.map_or("f", |k| self.links[k].as_str());
        let tidy = |s: &str| if latex { super::formula::upright(s) } else { s.to_owned() };
        match latex {
            true => format!("R^{{{}}}_{{{},{}}}", tidy(&self.links[link]), tidy(&self.links[to]), tidy(from)),
            false => format!("R^{}_{{{},{from}}}", self.links[link], self.links[to]),
        }
    }

    fn efficiency(&self, p_drives: bool, latex: bool) -> String {
        let [p, q, c] = [0, 1, 2].map(|k| match latex {
            true => super::formula::upright(&self.links[k]),
            false => self.links[k].clone(),
        });
        let product: Vec<String> =
            (1..=self.meshes).map(|k| if latex { format!("\\eta_{{{k}}}") } else { format!("eta{k}") }).collect();
        match (self.equal, latex, p_drives) {
            (true, true, _) => product.join(" "),
            (true, false, _) => product.join("*"),
            (false, true, true) => format!("\\eta_{{{c}({p}-{q})}}"),
            (false, true, false) => format!("\\eta_{{{c}({q}-{p})}}"),
            (false, false, true) => format!("eta_{c}({p}-{q})"),
            (false, false, false) => format!("eta_{c}({q}-{p})"),
        }
    }
}
