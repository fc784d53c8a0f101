//! One scheme in full, by exact arithmetic.

use serde::{Deserialize, Serialize};
use willis::exact::Rational;
use willis::named::NameMap;
use willis::train::ShiftElementKind;

use super::layout::{GROUND, Layout, shaft_digit};
use super::measure;
use super::motion;
use super::planar;
use super::wish::{SetRatio, Wish};

/// A shaft of a scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeShaft {
    /// `input`, `output`, `housing`, or what it carries: `r2s3` is ring 2 and sun 3.
    pub name: String,
    /// Its digit in the name of the layout.
    pub digit: char,
    /// The members of sets that belong to it.
    pub members: Vec<String>,
}

/// A clutch or a brake of a scheme.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeElement {
    /// `A`, `B`, …: brakes first.
    pub name: String,
    /// Clutch or brake.
    pub kind: ShiftElementKind,
    /// The shafts that it joins; for a brake the housing and one shaft.
    pub joins: [String; 2],
    /// Other places at which an element does the same to all speeds: each joins two shafts.
    pub same: Vec<[String; 2]>,
    /// The largest modulus of its torque in the gears shown, per torque of the input, without losses.
    pub max_torque: f64,
    /// The largest modulus of its slip in the gears shown, per speed of the input.
    pub max_slip: f64,
}

/// A gear of a scheme. Speeds are per speed of the input, torques per torque of the input and without losses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SchemeGear {
    /// `1`, `2`, …, `R`; other states that have a ratio are named after what they close.
    pub name: String,
    /// The closed elements.
    pub closed: Vec<String>,
    /// Speed of the input over speed of the output.
    pub ratio: Rational,
    /// The same as a number.
    pub value: f64,
    /// The ratio over that of the next gear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Speed of every shaft.
    pub speeds: NameMap<f64>,
    /// Speed of the planets of every set relative to their carrier.
    pub planets: NameMap<f64>,
    /// Torque of every closed element on the first of its shafts. Zero: it carries nothing.
    pub torques: NameMap<f64>,
    /// Slip of every open element, the speed of the first of its shafts less that of the second.
    pub slips: NameMap<f64>,
    /// Output over input power when the input drives, of the scheme's train file with the mesh efficiencies that it has
    /// ([`Schemes::rate`](super::Schemes::rate)).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency: Option<f64>,
    /// Why there is no efficiency.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_efficiency: Option<String>,
}

/// A shift scheme: a layout with elements, and what it does.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::{Scheme, Wish};
///
/// let wish = Wish { layout: None, ..Wish::new(&["96/48", "96/48", "111/69", "85/23"], 5, 3, 8)? };
/// let elements = [[2, 3], [2, 4], [0, 7], [1, 8], [6, 7]];
/// let zf = Scheme::new(&wish, "345360678751".parse()?, &elements).unwrap();
/// assert_eq!(zf.gears[0].ratio.to_string(), "108/23");
/// assert_eq!(zf.gears[0].closed.join(" "), "A B C");
/// // The train file has the same ratios, exactly.
/// let train = willis::Train::from_toml(&zf.to_toml())?;
/// let analysis = willis::analyze(&train, &willis::Selection::default())?;
/// assert_eq!(analysis.ratios.get("1").unwrap().exact.as_ref(), Some(&zf.gears[0].ratio));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Scheme {
    /// Its name: layout, and the digits of the shafts that each element joins: `345360678751 07 18 23 24 67`.
    pub id: String,
    /// The known transmission that it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known: Option<String>,
    /// The layout.
    pub layout: Layout,
    /// The tooth ratio of every set.
    pub sets: Vec<SetRatio>,
    /// Efficiencies of the meshes of sun and planet, and of planet and ring, in every set.
    #[serde(default = "Wish::usual_meshes")]
    pub mesh_efficiencies: [Rational; 2],
    /// The shafts, in the order of the layout's digits.
    pub shafts: Vec<SchemeShaft>,
    /// Brakes and clutches.
    pub elements: Vec<SchemeElement>,
    /// How many of the elements are brakes.
    pub brakes: usize,
    /// The longest chain of forward gears.
    pub gears: Vec<SchemeGear>,
    /// Reverse gears.
    pub reverse: Vec<SchemeGear>,
    /// Other states with a ratio.
    pub others: Vec<SchemeGear>,
    /// Ratio of the first over that of the last gear.
    pub spread: f64,
    /// The largest modulus of a shaft's speed in the gears and in reverse, per speed of the input.
    pub max_speed: f64,
    /// The largest modulus of an element's torque there, per torque of the input.
    pub max_torque: f64,
    /// Whether it can be drawn with nested shafts and without a crossing: the graph of sets, shafts and elements, with
    /// housing, input and output on its outer face, is planar.
    pub planar: bool,
}

/// A state by its closed elements, with the speeds of all shafts.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) mask: u32,
    pub(crate) speeds: Vec<Rational>,
    pub(crate) ratio: Rational,
}

/// All states of a scheme that have a ratio, by rational arithmetic.
pub(crate) fn states(ratios: &[Rational], layout: &Layout, elements: &[[u8; 2]], closed: usize) -> Vec<State> {
    (0..1_u32 << elements.len())
        .filter(|mask| mask.count_ones() as usize == closed)
        .filter_map(|mask| {
            let speeds = motion::speeds(layout, ratios, &among(elements, mask))?;
            let ratio = speeds[1].recip();
            Some(State { mask, speeds, ratio })
        })
        .collect()
}

fn among(elements: &[[u8; 2]], mask: u32) -> Vec<[u8; 2]> {
    (0..elements.len()).filter(|e| mask >> e & 1 == 1).map(|e| elements[e]).collect()
}

fn within(value: &Rational, bounds: &super::wish::Bounds) -> bool {
    bounds.min.as_ref().is_none_or(|min| value >= min) && bounds.max.as_ref().is_none_or(|max| value <= max)
}

/// The longest chain of forward gears among states, as positions, by rational arithmetic.
///
/// Along the steps instead of the states, so that it also holds where no step may be larger than the one before.
pub(crate) fn chain(wish: &Wish, states: &[State]) -> Vec<usize> {
    let mut forward: Vec<usize> = (0..states.len())
        .filter(|s| states[*s].ratio.sign() > 0 && within(&states[*s].ratio, &wish.forward_range))
        .collect();
    forward.sort_by(|a, b| states[*b].ratio.cmp(&states[*a].ratio));
    let mut best: Vec<usize> = forward.first().map(|s| vec![*s]).unwrap_or_default();
    // Steps in the order of their second states; the longest chain that ends with each.
    struct Step {
        ends: [usize; 2],
        quotient: Rational,
        before: Option<usize>,
        length: usize,
    }
    let mut steps: Vec<Step> = vec![];
    for (at, to) in forward.iter().enumerate() {
        for from in &forward[..at] {
            let (a, b) = (&states[*from], &states[*to]);
            if (a.mask ^ b.mask).count_ones() != 2 || a.ratio <= b.ratio {
                continue;
            }
            let quotient = &a.ratio / &b.ratio;
            if !within(&quotient, &wish.step) {
                continue;
            }
            let may = |s: &Step| s.ends[1] == *from && (!wish.progressive || quotient <= s.quotient);
            let before = (0..steps.len()).filter(|s| may(&steps[*s])).max_by_key(|s| steps[*s].length);
            let length = before.map_or(1, |s| steps[s].length) + 1;
            steps.push(Step { ends: [*from, *to], quotient, before, length });
        }
    }
    if let Some(last) = (0..steps.len()).rev().max_by_key(|s| steps[*s].length) {
        best = vec![steps[last].ends[1]];
        let mut at = Some(last);
        while let Some(step) = at {
            best.push(steps[step].ends[0]);
            at = steps[step].before;
        }
        best.reverse();
    }
    best
}

/// States with different reverse ratios that are wanted.
pub(crate) fn reverse(wish: &Wish, states: &[State]) -> Vec<usize> {
    let mut all: Vec<usize> = vec![];
    if wish.reverse > 0 {
        for (s, state) in states.iter().enumerate() {
            let fits = state.ratio.sign() < 0 && within(&state.ratio.abs(), &wish.reverse_range);
            if fits && all.iter().all(|o| states[*o].ratio != state.ratio) {
                all.push(s);
            }
        }
    }
    all
}

impl Scheme {
    /// What a layout with these elements, pairs of shafts, does for a wish. None if it has no chain of the forward gears
    /// and reverse gears that are wanted; the other rules of the wish are not looked at.
    pub fn new(wish: &Wish, layout: Layout, elements: &[[u8; 2]]) -> Option<Self> {
        let shafts = layout.shafts() as u8;
        if layout.sets() != wish.sets.len()
            || elements.len() > super::choose::MAX_ELEMENTS
            || elements.iter().flatten().any(|s| *s >= shafts)
        {
            return None;
        }
        let ratios = wish.ratios();
        // Brakes first, each kind in the order of its shafts.
        let mut elements = elements.to_vec();
        elements.iter_mut().for_each(|e| e.sort_unstable());
        let id = std::iter::once(layout.to_string()).chain({
            let mut sorted = elements.clone();
            sorted.sort_unstable();
            sorted.into_iter().map(|e| e.map(shaft_digit).into_iter().collect())
        });
        let id = id.collect::<Vec<String>>().join(" ");
        elements.sort_by_key(|e| (!e.contains(&GROUND), *e));
        let states = states(&ratios, &layout, &elements, wish.closed);
        let chain = chain(wish, &states);
        let reverse = reverse(wish, &states);
        if chain.len() < wish.forward.max(1) || reverse.len() < wish.reverse {
            return None;
        }
        let names = shaft_names(&layout);
        let letter = |e: usize| char::from(b'A' + e as u8).to_string();
        let gear = |name: String, state: &State| -> Option<SchemeGear> {
            let closed = among(&elements, state.mask);
            let torques = measure::torques(&layout, &ratios, &closed)?;
            let is_closed = |e: &usize| state.mask >> e & 1 == 1;
            let speed = |s: u8| &state.speeds[usize::from(s)];
            let planets = layout.blocks().chunks(3).zip(&ratios).enumerate().map(|(set, (three, k))| {
                let spin = &(speed(three[0]) - speed(three[2])) * &Rational::from(-2) / (k - &Rational::ONE);
                (format!("P{}", set + 1), spin.to_f64())
            });
            let turning = (0..layout.shafts()).filter(|s| *s != usize::from(GROUND));
            let slips = (0..elements.len()).filter(|e| !is_closed(e)).map(|e| {
                let [x, y] = elements[e];
                (letter(e), (speed(x) - speed(y)).to_f64())
            });
            Some(SchemeGear {
                name,
                closed: (0..elements.len()).filter(is_closed).map(letter).collect(),
                value: state.ratio.to_f64(),
                ratio: state.ratio.clone(),
                step: None,
                speeds: turning.map(|s| (names[s].clone(), state.speeds[s].to_f64())).collect(),
                planets: planets.collect(),
                torques: (0..elements.len())
                    .filter(is_closed)
                    .map(letter)
                    .zip(torques[1..].iter().map(Rational::to_f64))
                    .collect(),
                slips: slips.collect(),
                efficiency: None,
                no_efficiency: None,
            })
        };
        let mut gears = vec![];
        for (n, s) in chain.iter().enumerate() {
            gears.push(gear((n + 1).to_string(), &states[*s])?);
        }
        for n in 1..gears.len() {
            gears[n - 1].step = Some((&gears[n - 1].ratio / &gears[n].ratio).to_f64());
        }
        let mut back = vec![];
        for (n, s) in reverse.iter().enumerate() {
            let name = if reverse.len() == 1 { "R".to_owned() } else { format!("R{}", n + 1) };
            back.push(gear(name, &states[*s])?);
        }
        let mut others = vec![];
        for (s, state) in states.iter().enumerate().filter(|(s, _)| !chain.contains(s) && !reverse.contains(s)) {
            let name: String = (0..elements.len()).filter(|e| state.mask >> e & 1 == 1).map(letter).collect();
            others.extend(gear(name, &states[s]));
        }
        let shown = || gears.iter().chain(&back);
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |m, v| m.max(v.abs()));
        let max_speed = most(&mut shown().flat_map(|g| &g.speeds).map(|(_, v)| *v));
        let max_torque = most(&mut shown().flat_map(|g| &g.torques).map(|(_, v)| *v));
        let spread = gears[0].value / gears[gears.len() - 1].value;
        let places = places(wish, &layout);
        let named = |pair: [u8; 2]| pair.map(|s| names[usize::from(s)].clone());
        let own_elements = elements.iter().enumerate().map(|(e, pair)| {
            let name = letter(e);
            let of = |all: fn(&SchemeGear) -> &NameMap<f64>| {
                let name = name.clone();
                most(&mut shown().filter_map(|g| all(g).get(&name).copied()))
            };
            let same = places.iter().find(|p| p.contains(pair)).into_iter().flatten().filter(|p| *p != pair);
            SchemeElement {
                kind: match pair.contains(&GROUND) {
                    true => ShiftElementKind::Brake,
                    false => ShiftElementKind::Clutch,
                },
                joins: named(*pair),
                same: same.map(|p| named(*p)).collect(),
                max_torque: of(|g| &g.torques),
                max_slip: of(|g| &g.slips),
                name,
            }
        });
        let own_elements = own_elements.collect();
        let shafts = names.iter().enumerate().map(|(s, name)| SchemeShaft {
            name: name.clone(),
            digit: shaft_digit(s as u8),
            members: members(&layout).filter(|(b, _)| usize::from(*b) == s).map(|(_, m)| m).collect(),
        });
        Some(Self {
            id,
            known: None,
            layout,
            sets: wish.sets.clone(),
            mesh_efficiencies: wish.mesh_efficiencies.clone(),
            shafts: shafts.collect(),
            brakes: elements.iter().filter(|e| e.contains(&GROUND)).count(),
            elements: own_elements,
            spread,
            max_speed,
            max_torque,
            planar: planar::is_planar(&layout, &elements),
            gears,
            reverse: back,
            others,
        })
    }
}

/// Every member with its shaft: `s1`, `r1`, `c1`, `s2`, …
fn members(layout: &Layout) -> impl Iterator<Item = (u8, String)> + '_ {
    layout.blocks().iter().enumerate().map(|(m, b)| (*b, format!("{}{}", ['s', 'r', 'c'][m % 3], m / 3 + 1)))
}

/// What the shafts of a layout are called.
pub(crate) fn shaft_names(layout: &Layout) -> Vec<String> {
    let fixed = ["input", "output", "housing"].map(str::to_owned);
    let others = (3..layout.shafts())
        .map(|s| members(layout).filter(|(b, _)| usize::from(*b) == s).map(|(_, m)| m).collect::<String>());
    fixed.into_iter().chain(others).collect()
}

/// Places for elements in a layout, those together that do the same to all speeds.
fn places(wish: &Wish, layout: &Layout) -> Vec<Vec<[u8; 2]>> {
    let Some(teeth) = motion::teeth(&wish.ratios()) else { return vec![] };
    let mut points = super::points::Points::default();
    if !points.fill(layout, &teeth, super::points::may_join) {
        return vec![];
    }
    (0..points.len()).map(|p| points.at(p).to_vec()).collect()
}
