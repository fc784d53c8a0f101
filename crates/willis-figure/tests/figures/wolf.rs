//! Wolf diagrams.

use willis_figure::{draw_wolf, wolf};

use crate::trains::examples;

#[test]
fn every_coupling_of_a_train_is_drawn() {
    let mut variators = 0;
    for (name, train) in examples() {
        let Ok(data) = wolf(&train, None) else { continue };
        let svg = draw_wolf(&data);
        assert_eq!(data.ties.len(), train.shift_elements().len(), "{name}");
        assert_eq!(data.variators.len(), train.variators().len(), "{name}");
        for (drawn, own) in data.variators.iter().zip(train.variators()) {
            variators += 1;
            let names: Vec<&str> = drawn.members.iter().map(|m| data.members[*m].name.as_str()).collect();
            let members: Vec<&str> = own.members().into_iter().map(|m| train.member_name(m)).collect();
            assert_eq!(names, members, "{name}");
            assert!(svg.contains(&format!("The variator {} couples", drawn.name)), "{name}");
        }
        assert_eq!(svg.contains("no shift element closed"), !data.ties.is_empty(), "{name}");
        // Names that have room are whole.
        let short = data.ties.iter().filter(|t| t.name.chars().count() < 14 && !t.name.contains(['&', '<']));
        assert!(short.clone().all(|t| svg.contains(&format!("\n{}\n", t.name))), "{name}");
    }
    assert!(variators > 4, "{variators}");
}
