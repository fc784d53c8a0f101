//! Variants side by side as tables.

use willis::study::{ComparedValue, Comparison, MapPlace};

use crate::table::Kind::{Integer, Number, Text};
use crate::table::{Cell, Kind, Table};

pub fn tables(c: &Comparison) -> Vec<Table> {
    let labels: Vec<String> = c.variants.iter().map(|v| v.label.to_lowercase()).collect();
    let per_variant = |kind: Kind| labels.iter().map(move |l| (l.as_str(), kind));
    let mut all = vec![];
    let against: Vec<String> =
        labels[1..].iter().flat_map(|l| [format!("{l}_less_{}", labels[0]), format!("{l}_relative")]).collect();
    let mut t = Table::new("variants", [("variant", Text), ("file", Text), ("train", Text)]);
    for v in &c.variants {
        t.row([(&v.label).into(), (&v.file).into(), (&v.train).into()]);
    }
    all.push(t);
    let mut t = Table::new("files", std::iter::once(("key", Text)).chain(per_variant(Text)));
    for d in &c.files {
        t.row(std::iter::once((&d.path).into()).chain(d.values.iter().map(|v| v.clone().into())));
    }
    all.push(t);
    for (title, compared) in [("states", &c.states), ("operations", &c.operations)] {
        let head = [("name", Text), ("quantity", Text), ("unit", Text)].into_iter();
        // A quantity of a state or an operation may be a word.
        let columns = head.chain(per_variant(Text)).chain(against.iter().map(|a| (a.as_str(), Number)));
        let mut t = Table::new(title, columns.collect::<Vec<_>>());
        let width = t.columns.len();
        let mut row = |mut cells: Vec<Cell>| {
            cells.resize(width, Cell::Empty);
            t.row(cells);
        };
        for x in compared.iter() {
            for l in &x.missing_in {
                row(vec![(&x.name).into(), format!("missing in {l}").into()]);
            }
            for p in &x.prescribed {
                let head = [(&x.name).into(), format!("prescribed: {}", p.path).into(), Cell::Empty];
                row(head.into_iter().chain(p.values.iter().map(|v| v.clone().into())).collect());
            }
            for d in &x.differences {
                let mut cells: Vec<Cell> = vec![(&x.name).into(), (&d.quantity).into(), d.unit.name().into()];
                cells.extend(d.values.iter().map(|v| match v {
                    ComparedValue::None => Cell::Empty,
                    ComparedValue::Word(w) => w.into(),
                    ComparedValue::Number(x) => {
                        let mut text = String::new();
                        crate::table::number(&mut text, *x);
                        text.into()
                    }
                }));
                for k in 1..d.values.len() {
                    cells.extend([d.differences[k].into(), d.relative[k].into()]);
                }
                row(cells);
            }
        }
        all.push(t);
    }
    if let Some(m) = &c.map {
        let mut t = Table::new(
            "map",
            [
                ("variant", Text),
                ("against", Text),
                ("quantity", Text),
                ("compared", Integer),
                ("better", Integer),
                ("worse", Integer),
                ("equal", Integer),
                ("mean", Number),
                ("most_better", Number),
                ("most_better_at", Text),
                ("most_worse", Number),
                ("most_worse_at", Text),
            ],
        );
        for p in &m.pairs {
            for (name, d) in [("efficiency", &p.efficiency), ("loss_w", &p.loss_w)] {
                let place = |x: &Option<MapPlace>| -> [Cell; 2] {
                    [x.as_ref().map(|x| x.difference).into(), x.as_ref().map(|x| x.place.clone()).into()]
                };
                let mut row: Vec<Cell> = vec![(&p.other).into(), (&p.first).into(), name.into()];
                row.extend([p.compared, d.better, d.worse, d.equal].map(Cell::from));
                row.push(d.mean.into());
                row.extend(place(&d.most_better).into_iter().chain(place(&d.most_worse)));
                t.row(row);
            }
        }
        all.push(t);
    }
    all
}
