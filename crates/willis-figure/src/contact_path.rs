//! What happens to a tooth pair on its way along the path of contact.

pub mod film;
pub mod path;

use serde::{Deserialize, Serialize};
use willis::analysis::operate;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::operating_point::LubricationRegime;
use willis::train::{Operation, Train};
use willis::unstable::{self, Along};

/// Load, speeds, film, friction and loss along the paths of contact of an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ContactPath {
    /// The train.
    pub title: String,
    /// The operating point.
    pub operation: String,
    /// The oil.
    pub oil: String,
    /// Its temperature, °C.
    pub temperature_celsius: f64,
    /// Law of tooth friction in force.
    pub friction_law: String,
    /// Whether it gives a coefficient for each place; else one mean value for the mesh.
    pub local: bool,
    /// Law of the film thickness in force.
    pub film_law: String,
    /// Film thickness ratios λ at which mixed and full lubrication begin.
    pub limits: [f64; 2],
    /// Every loaded mesh that was asked for.
    pub meshes: Vec<MeshPath>,
    /// Meshes that were asked for and are not shown, with the reason.
    pub left_out: Vec<String>,
}

/// One of the pairs in parallel of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MeshPath {
    /// The mesh.
    pub name: String,
    /// Its two members.
    pub gears: [String; 2],
    /// Which of them drives, seen from the carrier.
    pub driver: usize,
    /// Identical pairs in parallel.
    pub count: u32,
    /// The points A, B, C, D, E, mm from C along the line of action, positive towards the addendum
    /// of the first gear; the first gear driving, contacts run from A to E.
    pub breakpoints_mm: [f64; 5],
    /// Transverse contact ratio `ε_α`.
    pub contact_ratio: f64,
    /// From A to E, on both sides of every jump of the load.
    pub points: Vec<PathPoint>,
    /// Mean coefficient of friction of the mesh; absent when its efficiency is given.
    pub friction: Option<f64>,
    /// Sliding loss of the mesh, all pairs in parallel, as the operating point has it, W.
    pub sliding_loss_w: f64,
    /// The local loss integrated over the path, over the base pitch, all pairs in parallel, W; absent
    /// when the efficiency is given.
    ///
    /// `P = (1/p_bt) ∫ μ F_n v_g ds`: on the average over a base pitch so much is lost at once.
    pub integrated_loss_w: Option<f64>,
}

/// A tooth pair at one place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PathPoint {
    /// Distance `s` from C along the line of action, mm.
    pub s_mm: f64,
    /// Normal load per length of contact line, N/m.
    pub line_load_n_per_m: f64,
    /// Sliding speed `|v_g|`, m/s.
    pub sliding_m_s: f64,
    /// Sum of the surface speeds `u_1 + u_2`, m/s: twice the rolling speed.
    pub sum_speed_m_s: f64,
    /// Hertzian pressure, Pa.
    pub pressure_pa: f64,
    /// Film thickness, thermal reduction included, m; absent where nothing presses.
    pub film_m: Option<f64>,
    /// Film thickness over the composite rms roughness, `λ`.
    pub film_ratio: Option<f64>,
    /// Coefficient of friction; of a mean law that of the mesh.
    pub friction: Option<f64>,
    /// Power `μ F_n v_g` that this tooth pair turns into heat here, W.
    pub loss_w: Option<f64>,
}

/// Places in each part of the path.
const STEPS: usize = 16;

impl MeshPath {
    /// Whether the local loss adds up to the mesh's.
    pub fn adds_up(&self) -> bool {
        self.integrated_loss_w.is_some_and(|own| (own - self.sliding_loss_w).abs() <= 1e-3 * self.sliding_loss_w)
    }

    /// Smallest λ on the path.
    pub fn least_film_ratio(&self) -> Option<f64> {
        self.points.iter().filter_map(|p| p.film_ratio).min_by(f64::total_cmp)
    }
}

/// The paths of contact of an operating point: of the operation named (else the first that has an
/// answer), of the mesh named (else of all whose teeth are given).
///
/// # Errors
/// Unknown names; a train without teeth, oil or operations; an operating point without an
/// equilibrium; meshes without load.
///
/// # Example
/// ```
/// use willis_figure::contact_path;
/// use willis::train::{GeometrySpec, OilSpec, OperationSpec, SetSpec, Train};
/// use willis::units::{AngularSpeed, Length, Torque};
///
/// let geometry = GeometrySpec::new(Length::mm(4.0), Length::mm(50.0));
/// let train = Train::builder("stage")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .oil(OilSpec { name: Some("ISO VG 100".into()), ..OilSpec::default() })
///     .set(SetSpec::simple("P1", ("s", 17), ("frame", 61), "c").planet(22, 3).geometry(geometry))
///     .operation(
///         OperationSpec::new("rated")
///             .speed("s", AngularSpeed::rpm(1500.0))
///             .torque("s", Torque::n_m(1500.0)),
///     )
///     .build()?;
/// let path = contact_path(&train, None, None)?;
/// assert_eq!(path.meshes.len(), 2);
/// assert!(path.meshes[0].adds_up());
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn contact_path(train: &Train, operation: Option<&str>, mesh: Option<&str>) -> Result<ContactPath, Diagnostics> {
    if let Some(name) = mesh
        && train.mesh(name).is_none()
    {
        let known = train.meshes().iter().map(|m| m.name.as_str());
        return Err(Diagnostic::missing(Code::UnknownName, "mesh", name, known).into());
    }
    let wanted: Vec<usize> =
        (0..train.meshes().len()).filter(|&k| mesh.is_none_or(|name| train.meshes()[k].name == name)).collect();
    if wanted.iter().all(|&k| train.meshes()[k].teeth.is_none()) {
        let what = mesh.map_or("no mesh has teeth".to_owned(), |name| format!("mesh `{name}` has no teeth"));
        return Err(unfit(
            format!("no path of contact: {what}"),
            "give the set or mesh its `geometry = { module = \"2 mm\", width = \"20 mm\" }`",
        ));
    }
    let Some(lubrication) = train.lubrication() else {
        return Err(unfit("no path of contact: the train has no oil", "add `[oil]` with `name = \"ISO VG 100\"`"));
    };
    let operations: Vec<&Operation> = match operation {
        Some(name) => vec![train.find_operation(name)?],
        None => train.operations().iter().collect(),
    };
    if operations.is_empty() {
        return Err(unfit(
            "no path of contact: the train has no operating point",
            "add an `[[operation]]` with speeds and torques",
        ));
    }
    let mut why = None;
    for operation in operations {
        match at(train, operation, &wanted) {
            Ok((meshes, mut left_out, oil_k)) if !meshes.is_empty() => {
                left_out.sort();
                return Ok(ContactPath {
                    title: train.name().to_owned(),
                    operation: operation.name.clone(),
                    oil: lubrication.oil.name.clone(),
                    temperature_celsius: oil_k.unwrap_or(lubrication.temperature) - 273.15,
                    friction_law: train.laws().mesh_friction(true).meta().id.to_owned(),
                    local: meshes.iter().any(|m| m.1),
                    film_law: train.laws().film.meta().id.to_owned(),
                    limits: LubricationRegime::LIMITS,
                    meshes: meshes.into_iter().map(|m| m.0).collect(),
                    left_out,
                });
            }
            Ok(_) => {
                let text = format!("no path of contact at `{}`: no such mesh is loaded and turns", operation.name);
                why.get_or_insert_with(|| unfit(text, "name another operation, or give it a torque"));
            }
            Err(wrong) => {
                why.get_or_insert(wrong);
            }
        }
    }
    Err(why.unwrap_or_default())
}

type Paths = (Vec<(MeshPath, bool)>, Vec<String>, Option<f64>);

/// The meshes at one operating point, what is left out, and the oil temperature, K.
fn at(train: &Train, operation: &Operation, wanted: &[usize]) -> Result<Paths, Diagnostics> {
    let (report, _) = operate(train, operation)?;
    let Some(solution) = report.solutions.first() else {
        let reason = report.reason.unwrap_or_else(|| "it has no equilibrium".to_owned());
        return Err(unfit(
            format!("no path of contact at `{}`: {reason}", operation.name),
            "`willis analyze` tells more",
        ));
    };
    // At the temperature of the heat balance, where there is one.
    let mut warm = operation.clone();
    warm.temperature = report.oil_k(train, operation);
    let (mut all, mut left_out) = (Vec::new(), Vec::new());
    for &k in wanted {
        let mesh = &train.meshes()[k];
        let found = (mesh.teeth.as_ref(), solution.meshes.get(&mesh.name), solution.contacts.get(&mesh.name));
        let (Some(teeth), Some(own), Some(contact)) = found else {
            left_out.push(format!("{}: no teeth given", mesh.name));
            continue;
        };
        let Some(Along { stations, loss, local, driver }) = unstable::along(train, &warm, k, own, STEPS) else {
            left_out.push(format!("{}: not loaded, or at rest", mesh.name));
            continue;
        };
        let points = stations.iter().map(|p| PathPoint {
            s_mm: p.s * 1e3,
            line_load_n_per_m: p.line_load,
            sliding_m_s: p.sliding,
            sum_speed_m_s: p.sum,
            pressure_pa: p.pressure,
            film_m: p.film,
            film_ratio: p.film_ratio,
            friction: p.friction,
            loss_w: p.loss,
        });
        let path = MeshPath {
            name: mesh.name.clone(),
            gears: [0, 1].map(|g| train.member_name(mesh.gears[g].member).to_owned()),
            driver,
            count: mesh.count,
            breakpoints_mm: teeth.pair.breakpoints().map(|s| s * 1e3),
            contact_ratio: teeth.pair.contact_ratio,
            points: points.collect(),
            friction: contact.friction,
            sliding_loss_w: contact.sliding_loss_w,
            integrated_loss_w: loss,
        };
        all.push((path, local));
    }
    Ok((all, left_out, warm.temperature))
}

fn unfit(text: impl Into<String>, hint: impl Into<String>) -> Diagnostics {
    [Diagnostic::new(Code::Unfit, "", text).hint(hint)].into_iter().collect()
}
