//! The train: its schematic, its wheels, its teeth, its shift elements and bearings.

use willis::train::{MemberId, Train};

use super::Findings;
use super::results::{exact_percent, significant};
use crate::FigureKind;
use crate::report::document::{Block, Column, Section};

pub fn section(all: &Findings<'_>) -> Section {
    let train = all.model.train();
    let mut blocks = vec![];
    if let Some(source) = train.source() {
        blocks.push(Block::Text { text: format!("Source of the data: {source}") });
    }
    let state = all.analysis.operations.first().and_then(|o| o.state.as_deref());
    let caption = match state {
        Some(state) => {
            format!("The train in state {state}: shafts, wheels, carriers, shift elements, and the power path")
        }
        None => "The train: shafts, wheels, carriers and shift elements".to_owned(),
    };
    blocks.extend(all.figures.block(FigureKind::Stick, None, &caption));
    blocks.push(wheels(train));
    blocks.extend(super::wheels::sheets(train));
    for set in train.sets() {
        let caption = format!("{} seen along its axis", set.name);
        blocks.extend(all.figures.block(FigureKind::Front, Some(&set.name), &caption));
    }
    blocks.extend(shift_elements(train));
    blocks.extend(bearings(train));
    blocks.extend(oil(train));
    Section { title: "The train".into(), blocks }
}

fn name(train: &Train, m: MemberId) -> String {
    train.member_name(m).to_owned()
}

fn wheels(train: &Train) -> Block {
    let heads = ["Mesh", "First wheel", "Second wheel", "Carrier"].map(Column::words).into_iter();
    let heads = heads.chain([Column::numbers("Pairs"), Column::words("Efficiency relative to the carrier")]).collect();
    let rows = (train.meshes().iter())
        .map(|m| {
            let wheel = |k: usize| {
                let g = &m.gears[k];
                let kind = if g.internal { ", ring" } else { "" };
                format!("{} (z {}{kind})", name(train, g.member), significant(g.teeth.to_f64(), 6))
            };
            let efficiency = match (m.computed, m.efficiency.forward == m.efficiency.backward) {
                (true, _) => "computed from the teeth".to_owned(),
                (false, true) => exact_percent(m.efficiency.forward.to_f64()),
                (false, false) => format!(
                    "{} driven by the first, {} by the second",
                    exact_percent(m.efficiency.forward.to_f64()),
                    exact_percent(m.efficiency.backward.to_f64())
                ),
            };
            vec![m.name.clone(), wheel(0), wheel(1), name(train, m.carrier), m.count.to_string(), efficiency]
        })
        .collect();
    Block::Table { caption: "Wheels and meshes; z is the number of teeth".into(), columns: heads, rows }
}

fn shift_elements(train: &Train) -> Option<Block> {
    let rows: Vec<Vec<String>> = (train.shift_elements().iter())
        .map(|e| {
            let states = (train.states().iter())
                .filter(|s| s.engaged.iter().any(|id| train.shift_elements()[id.index()].name == e.name))
                .map(|s| s.name.as_str());
            vec![
                e.name.clone(),
                e.kind.to_string(),
                e.members.map(|m| train.member_name(m).to_owned()).join(" – "),
                states.collect::<Vec<_>>().join(", "),
            ]
        })
        .collect();
    let columns = ["Shift element", "Kind", "Joins", "Engaged in"].map(Column::words).into();
    (!rows.is_empty()).then(|| Block::Table { caption: "Shift elements".into(), columns, rows })
}

fn bearings(train: &Train) -> Option<Block> {
    let rows: Vec<Vec<String>> = (train.bearings().iter())
        .map(|b| {
            vec![
                b.name.clone(),
                b.bearing.designation.clone(),
                b.members.map(|m| train.member_name(m).to_owned()).join(" – "),
                (b.count * b.places).to_string(),
            ]
        })
        .collect();
    let columns = ["Bearing", "Designation", "Joins"].map(Column::words).into_iter();
    let columns = columns.chain([Column::numbers("Number")]).collect();
    (!rows.is_empty()).then(|| Block::Table { caption: "Rolling bearings".into(), columns, rows })
}

fn oil(train: &Train) -> Option<Block> {
    let l = train.lubrication()?;
    let mut text = format!("Oil: {}", l.oil.name);
    // With a heat balance every operating point has its own.
    if train.heat().is_none() {
        text += &format!(" at {} °C", significant(l.temperature - 273.15, 4));
    }
    if let Some(volume) = l.volume {
        text += &format!(", {} litres in the sump", significant(volume * 1e3, 4));
    }
    Some(Block::Text { text: text + "." })
}
