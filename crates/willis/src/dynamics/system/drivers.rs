//! Sources: where they act, and the inertia and rolling resistance they bring with them.

use crate::dynamics::source::GRAVITY;
use crate::train::{Curve, FRAME, MemberId, Scenario, SourceKind};

use super::frictions::{Friction, Rubs};
use super::inertia::NodeInertia;
use super::ports::Ports;

/// What a source needs beside its description.
#[derive(Clone)]
pub(in crate::dynamics) struct Driver {
    pub member: MemberId,
    /// Port of its torque; `None` for a prescribed speed.
    pub port: Option<usize>,
    /// Position of its integral among those of the controllers.
    pub integral: Option<usize>,
    /// Position among the prescribed speeds.
    pub prescribed: Option<usize>,
    /// Its rolling resistance among the friction elements.
    pub rolling: Option<usize>,
}

/// All sources of a scenario.
pub(super) struct Drivers {
    /// One for each source.
    pub drivers: Vec<Driver>,
    /// Rolling resistances of vehicles.
    pub rolling: Vec<Friction>,
    /// Number of controller integrals.
    pub integrals: usize,
}

impl Drivers {
    /// Gives each its port and adds its inertia.
    pub fn of(scenario: &Scenario, inertia: &mut NodeInertia<'_>, ports: &mut Ports<'_>) -> Self {
        let mut all = Self { drivers: Vec::new(), rolling: Vec::new(), integrals: 0 };
        let mut prescribed_seen = 0;
        for (k, s) in scenario.sources.iter().enumerate() {
            let mut driver = Driver { member: s.member, port: None, integral: None, prescribed: None, rolling: None };
            if !matches!(s.kind, SourceKind::Speed(_)) {
                driver.port = Some(ports.on(s.member));
            }
            match &s.kind {
                SourceKind::Speed(_) => {
                    driver.prescribed = Some(prescribed_seen);
                    prescribed_seen += 1;
                }
                SourceKind::Controller { derivative, .. } => {
                    driver.integral = Some(all.integrals);
                    all.integrals += 1;
                    // The derivative of the speed is the acceleration: an added inertia.
                    inertia.add_felt(s.member, *derivative);
                }
                SourceKind::Vehicle { mass, wheel_radius, final_drive, rolling, .. } => {
                    let arm = wheel_radius / final_drive;
                    inertia.add(s.member, mass * arm * arm);
                    if *rolling > 0.0 {
                        driver.rolling = Some(all.rolling.len());
                        let torque = Curve::constant(rolling * mass * GRAVITY * arm.abs());
                        let between = ports.between([s.member, FRAME]);
                        all.rolling.push(Friction {
                            rolls: Some(k),
                            ..Friction::new(Rubs::Rolling(k), &s.name, torque, between)
                        });
                    }
                }
                _ => {}
            }
            all.drivers.push(driver);
        }
        all
    }
}
