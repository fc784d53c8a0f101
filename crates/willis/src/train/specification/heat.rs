//! The thermal layer of a specification: what carries the heat away, and what stores it.

use crate::train::heat::Surroundings;
use crate::units::{
    Area, Conductance, HeatCapacity, HeatTransfer, Length, Mass, Power, SpecificHeat, Speed, Temperature, VolumeFlow,
};

use super::field::{choice, specification};

choice!(Surroundings { Confined = "confined", Hall = "hall", MovingAir = "moving-air" });

specification! {
    /// How heat leaves a surface, or passes between two places: `conductance`; or `area` and `coefficient`; or `area`
    /// and `surroundings`; or `area`, `height` and `emissivity`, from which convection and radiation follow.
    SurfaceSpec => PlainSurface {
        /// Heat flow over the difference of temperatures.
        may conductance: Option<Conductance>,
        /// Surface that gives heat to the air, without the base plate. Default: from `length`, `width` and `height`.
        may area: Option<Area>,
        /// Heat transfer coefficient of the area.
        may coefficient: Option<HeatTransfer>,
        /// The coefficient by ISO/TR 14179-1: `confined` 12, `hall` 18.5, `moving-air` 25 W/(m² K).
        may surroundings: Option<Surroundings>,
        /// Height of the box, for free convection.
        may height: Option<Length>,
        /// Length of the box; with `width` and `height` instead of `area`.
        may length: Option<Length>,
        /// Width of the box.
        may width: Option<Length>,
        /// Emissivity of the surface: painted or cast iron 0.9, oily machined 0.4, bare aluminium 0.1. Default: 0.9.
        may emissivity: Option<f64>,
        /// Speed of air along the surface. Default: at rest.
        may air_speed: Option<Speed>,
        /// Length of the surface along the air. Default: the height.
        may flow_length: Option<Length>,
        /// Part of the area that the air reaches. Default: 1.
        may air_share: Option<f64>,
        /// Surface of the fins, both sides.
        may fin_area: Option<Area>,
        /// How far the fins stand out.
        may fin_height: Option<Length>,
        /// Thickness of the fins.
        may fin_thickness: Option<Length>,
    }

    /// A cooler of the oil. It needs `conductance`, or `flow` and `effectiveness`.
    CoolerSpec => PlainCooler {
        /// Temperature of the water or air that cools, where it enters.
        must inlet: Temperature,
        /// Flow of oil through the cooler.
        may flow: Option<VolumeFlow>,
        /// Drop of the oil over its difference from the inlet, 0 to 1.
        may effectiveness: Option<f64>,
        /// Heat flow over the difference of oil and inlet, instead of flow and effectiveness.
        may conductance: Option<Conductance>,
        /// Oil temperature at which the thermostat begins to open. Default: no thermostat.
        may opens: Option<Temperature>,
        /// Oil temperature at which it is open. Default: 10 K above `opens`.
        may open: Option<Temperature>,
    }

    /// A place of a thermal network with one temperature. `oil` and `ambient` are always there.
    HeatNodeSpec => PlainHeatNode {
        /// What it is called.
        must name: String,
        /// What makes its heat here: members (half the tooth friction of each of their meshes), bearings, seals, rotors and
        /// variators, by name. What no node names is made in the oil.
        may parts: Vec<String>,
        /// A given temperature: a foundation, water.
        may temperature: Option<Temperature>,
        /// Heat capacity. Default: none, it follows at once.
        may heat_capacity: Option<HeatCapacity>,
        /// Mass of steel, instead of a heat capacity: 470 J/(kg K).
        may mass: Option<Mass>,
    }

    /// A way for heat between two places.
    HeatPathSpec => PlainHeatPath {
        /// The two places.
        must between: Vec<String>,
        ..surface: SurfaceSpec,
    }

    /// What carries the heat of the losses away. An operation without a temperature runs at the oil temperature at which
    /// losses and heat flow agree.
    HeatSpec => PlainHeat {
        /// Temperature of the air around.
        must ambient: Temperature,
        /// Highest oil temperature that is allowed. Default: 95 degC, for mineral oil by ISO/TR 14179-1.
        may limit: Option<Temperature>,
        /// Oil temperature at the start of a warm-up. Default: that of the air.
        may start: Option<Temperature>,
        /// Heat into the oil beside the losses: a converter, a pump of its own.
        may extra_heat: Option<Power>,
        /// Factor on all conductances to the outside, as tests give it. Default: 1.
        may factor: Option<f64>,
        /// Inner surface that the oil reaches; with `oil_coefficient` it makes the housing a place of its own. Default: oil
        /// and housing have one temperature.
        may oil_area: Option<Area>,
        /// Heat transfer from oil to housing: splash 100 to 300 W/(m² K). Default: 200.
        may oil_coefficient: Option<HeatTransfer>,
        /// Conductance to foundation and shafts, at the temperature of the air.
        may foundation: Option<Conductance>,
        /// Heat capacity of the oil and what warms with it; of everything, where the housing is no place of its own.
        may heat_capacity: Option<HeatCapacity>,
        /// Mass of the steel that warms with the oil, instead of a heat capacity; the oil's own is added.
        may mass: Option<Mass>,
        /// Heat capacity of the housing.
        may housing_heat_capacity: Option<HeatCapacity>,
        /// Mass of the housing of iron, instead: 500 J/(kg K).
        may housing_mass: Option<Mass>,
        /// Specific heat of the oil. Default: 1950 J/(kg K).
        may oil_specific_heat: Option<SpecificHeat>,
        /// A cooler of the oil.
        may cooler: Option<CoolerSpec>,
        /// Places of a network.
        may node: Vec<HeatNodeSpec>,
        /// Ways for heat between them.
        may path: Vec<HeatPathSpec>,
        ..surface: SurfaceSpec,
    }
}
