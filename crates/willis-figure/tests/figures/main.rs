//! Figures as data and as drawn, and reports.

#[path = "../../../willis/tests/common/mod.rs"]
mod common;
mod trains;

mod contact_path;
mod default_point;
mod flow_drawn;
mod front;
mod front_drawn;
mod html;
mod in_steps;
mod lever;
mod lever_drawn;
mod losses;
mod panels;
mod pictures;
mod map;
mod regimes;
mod report;
mod sankey;
mod shift;
mod spin;
mod split;
mod stick;
mod table;
mod time_drawn;
mod tornado;
mod vibration;
mod wolf;
