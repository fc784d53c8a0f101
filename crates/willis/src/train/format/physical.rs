//! Pours the checked values of the physical layer into its description.

use crate::catalogue::bearing::Kind;
use crate::catalogue::oil::Base;
use crate::losses::seal::Material;

use crate::train::describe::physical::{
    BearingSpec, Fluid, GeometrySpec, HousingSpec, OilSpec, OilSupply, RotorSpec, SealSpec, ToothSpec,
};

use super::reader::Fields;

pub(super) fn tooth(t: &Fields) -> ToothSpec {
    ToothSpec {
        shift: t.real("shift"),
        addendum: t.real("addendum"),
        dedendum: t.real("dedendum"),
        tip_alteration: t.si("tip_alteration"),
        tip_diameter: t.si("tip_diameter"),
        roughness: t.si("roughness"),
        immersion: t.si("immersion"),
    }
}

pub(super) fn geometry(t: &Fields) -> Option<GeometrySpec> {
    let g = t.table("geometry")?;
    let standard = GeometrySpec::default();
    Some(GeometrySpec {
        // What is missing or wrong was reported; the rest is checked all the same.
        module: g.si("module").unwrap_or(1e-3),
        width: g.si("width").unwrap_or(10e-3),
        pressure_angle: g.si("pressure_angle").unwrap_or(standard.pressure_angle),
        helix: g.si("helix").unwrap_or(standard.helix),
        double_helical: g.flag("double_helical"),
        centre_distance: g.si("centre_distance"),
        addendum: g.real("addendum").unwrap_or(standard.addendum),
        dedendum: g.real("dedendum").unwrap_or(standard.dedendum),
        roughness: g.si("roughness"),
        youngs_modulus: g.si("youngs_modulus").unwrap_or(standard.youngs_modulus),
        poisson_ratio: g.real("poisson_ratio").unwrap_or(standard.poisson_ratio),
    })
}

fn supply(t: &Fields) -> Option<OilSupply> {
    Some(match t.optional_text("supply")?.as_str() {
        "bath" => OilSupply::Bath,
        "jet" => OilSupply::Jet,
        "mist" => OilSupply::Mist,
        _ => OilSupply::Grease,
    })
}

pub(super) fn oil(t: &Fields) -> OilSpec {
    OilSpec {
        name: t.optional_text("name"),
        base: t.optional_text("base").map(|b| match b.as_str() {
            "pao" => Base::Pao,
            "ester" => Base::Ester,
            "pag" => Base::Pag,
            "phosphate-ester" => Base::PhosphateEster,
            "traction" => Base::Traction,
            _ => Base::Mineral,
        }),
        viscosity_40: t.si("viscosity_40"),
        viscosity_100: t.si("viscosity_100"),
        viscosity: t.si("viscosity"),
        density_15: t.si("density_15"),
        pressure_viscosity: t.si("pressure_viscosity"),
        lubricant_factor: t.real("lubricant_factor"),
        temperature: t.si("temperature"),
        supply: supply(t),
        volume: t.si("volume"),
        mist: t.real("mist"),
    }
}

pub(super) fn housing(t: &Fields) -> HousingSpec {
    HousingSpec { enclosure: t.real("enclosure"), axial_gap: t.si("axial_gap") }
}

pub(super) fn bearing(t: &Fields) -> BearingSpec {
    BearingSpec {
        name: t.text("name"),
        members: t.names("members"),
        designation: t.optional_text("designation"),
        kind: t.optional_text("kind").and_then(|k| Kind::named(&k)),
        series: t.optional_text("series"),
        bore: t.si("bore"),
        outside_diameter: t.si("outside_diameter"),
        width: t.si("width"),
        static_rating: t.si("static_rating"),
        axial_factor: t.real("axial_factor"),
        count: t.integer("count"),
        shaft_diameter: t.si("shaft_diameter"),
        span: t.si("span"),
        radial_load: t.si("radial_load"),
        axial_load: t.si("axial_load"),
        supply: supply(t),
        level: t.si("level"),
    }
}

pub(super) fn seal(t: &Fields) -> SealSpec {
    SealSpec {
        name: t.text("name"),
        members: t.names("members"),
        diameter: t.si("diameter").unwrap_or(1.0),
        material: match t.optional_text("material").as_deref() {
            Some("nbr") => Material::Nbr,
            _ => Material::Fkm,
        },
        count: t.integer("count").unwrap_or(1),
    }
}

pub(super) fn rotor(t: &Fields) -> RotorSpec {
    RotorSpec {
        name: t.text("name"),
        member: t.text("member"),
        radius: t.si("radius").unwrap_or(1.0),
        length: t.si("length").unwrap_or(1.0),
        radial_gap: t.si("radial_gap").unwrap_or(1.0),
        axial_gap: t.si("axial_gap"),
        fluid: match t.optional_text("fluid").as_deref() {
            Some("oil") => Fluid::Oil,
            Some("air") => Fluid::Air,
            _ => Fluid::Mist,
        },
    }
}

/// Family and law of each choice.
pub(super) fn laws(t: &Fields) -> Vec<(String, String)> {
    crate::losses::FAMILIES.iter().filter_map(|f| Some(((*f).to_owned(), t.optional_text(f)?))).collect()
}
