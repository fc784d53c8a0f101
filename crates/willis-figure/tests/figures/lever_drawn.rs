//! Levers, shift tables and rankings as pictures: names of all kinds, nothing that is no number.

use willis::Train;
use willis::study::sensitivity;
use willis::train::{OperationSpec, SetSpec, ShiftElementSpec, StateSpec};
use willis::units::{AngularSpeed, Torque};
use willis_figure::{LeverRequest, lever, shift, tornado};

/// Members with names that are long, wide, or would be markup.
fn train() -> Train {
    let long = "a sun gear whose name is as long as a name may ever be, or so";
    Train::builder("<&\" train")
        .members([long, "<ring & \"quotes\">", "行星架行星架行星架行星架行星架"])
        .terminals([long, "行星架行星架行星架行星架行星架"])
        .set(
            SetSpec::simple("P<1>", (long, 30), ("<ring & \"quotes\">", 70), "行星架行星架行星架行星架行星架")
                .planet(20, 4)
                .mesh_efficiency(0.99),
        )
        .shift_element(ShiftElementSpec::brake("Тормоз кольцевого колеса", "<ring & \"quotes\">"))
        .shift_element(ShiftElementSpec::clutch("K&1", long, "行星架行星架行星架行星架行星架"))
        .state(StateSpec::new(
            "first gear, with a name that nobody would ever want to read",
            ["Тормоз кольцевого колеса"],
        ))
        .state(StateSpec::new("<2>", ["K&1"]))
        .state(StateSpec::new("空挡", [] as [&str; 0]))
        .operation(
            OperationSpec::new("load")
                .state("first gear, with a name that nobody would ever want to read")
                .speed(long, AngularSpeed::rpm(1000.0))
                .torque(long, Torque::n_m(10.0)),
        )
        .build()
        .unwrap()
}

fn pictures() -> Vec<String> {
    let train = train();
    let mut all: Vec<String> = [LeverRequest::First, LeverRequest::State("<2>".into()), LeverRequest::EveryState]
        .iter()
        .map(|r| willis_figure::draw_lever(&lever(&train, r).unwrap()))
        .collect();
    all.push(willis_figure::draw_shift(&shift(&train).unwrap()));
    let known = sensitivity(&train, &willis::Selection::default()).unwrap();
    all.push(willis_figure::draw_tornado(&tornado(&known, None, 12).unwrap()));
    all
}

#[test]
fn any_name_can_be_drawn() {
    for svg in pictures() {
        assert!(svg.starts_with("<svg") && svg.contains("<title>") && svg.contains("<desc>"));
        assert!(!svg.contains("<ring") && !svg.contains("P<1>") && !svg.contains("<2>"), "{svg}");
        for wrong in ["NaN", "inf\"", "style=", "rgba"] {
            assert!(!svg.contains(wrong), "{wrong}");
        }
    }
}

#[test]
fn the_same_data_make_the_same_bytes() {
    assert_eq!(pictures(), pictures());
}

#[test]
fn each_state_has_its_letter_and_the_neutral_one_its_reason() {
    let all = pictures();
    assert!(all[2].contains(">a</text>") || all[2].contains("\na\n"), "{}", all[2]);
    assert!(all[2].contains("degrees of freedom"));
    assert!(all[3].contains("degrees of freedom"));
}

/// Five sets do not fit beside each other: what joins the last lever of a row to the first of the next is drawn too.
#[test]
fn levers_in_two_rows_are_linked() {
    let (_, model) = crate::trains::hard().into_iter().find(|(name, _)| *name == "five sets").unwrap();
    let data = willis_figure::lever(model.train(), &willis_figure::LeverRequest::State("1".into())).unwrap();
    let svg = willis_figure::draw_lever(&data);
    let document = resvg::usvg::roxmltree::Document::parse(&svg).unwrap();
    let ways = document.descendants().filter(|n| n.has_tag_name("path") && n.attribute("data-member").is_some());
    let level =
        document.descendants().filter(|n| n.has_tag_name("line") && n.attribute("stroke-dasharray") == Some("6 4"));
    let pairs: usize = data.links.iter().map(|l| l.points.len() - 1).sum();
    // The key has one dashed line of its own.
    assert_eq!(ways.count() + level.count(), pairs + 1);
}

#[test]
fn gears_stand_under_their_own_names() {
    let train = crate::common::train("zf-8hp70");
    let data = willis_figure::lever(&train, &willis_figure::LeverRequest::EveryState).unwrap();
    let names: Vec<&str> = data.cases.iter().map(|c| c.letter.as_str()).collect();
    assert_eq!(names, ["1", "2", "3", "4", "5", "6", "7", "8", "R"]);
}
