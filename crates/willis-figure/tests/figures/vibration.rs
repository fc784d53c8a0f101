//! Modes of vibration: the numbers are those of the question, on the stick diagram of the train.

use willis::dynamics::modes;
use willis_figure::{stick, vibration};

use crate::trains::examples;

#[test]
fn every_mode_is_that_of_the_question_on_one_diagram() {
    let mut drawn = 0;
    for (name, train) in examples() {
        let states = train.states().iter().map(|s| Some(s.name.as_str()));
        for state in std::iter::once(None).chain(states) {
            let (shown, told) = (vibration(&train, state), modes(&train, state, &[]));
            let (Ok(shown), Ok(told)) = (shown, told) else { continue };
            let rigid = told.rigid_body_modes.len();
            assert_eq!(shown.modes.len() + shown.left_out, rigid + told.modes.len(), "{name} {state:?}");
            for (k, mode) in shown.modes.iter().enumerate() {
                let (frequency, shape) = match k.checked_sub(rigid) {
                    Some(k) => (told.modes[k].frequency_hz, &told.modes[k].shape),
                    None => (0.0, &told.rigid_body_modes[k].shape),
                };
                assert_eq!((mode.frequency_hz, &mode.shape), (frequency, shape), "{name} {state:?}");
                assert_eq!(mode.number, k.checked_sub(rigid).map(|k| k + 1), "{name} {state:?}");
            }
            assert_eq!(shown.stick, stick(&train, state).expect("it has a diagram"), "{name} {state:?}");
            drawn += 1;
        }
    }
    assert!(drawn >= 9, "{drawn}");
}
