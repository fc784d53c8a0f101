//! How much work an operating point of a train is.

use crate::train::Train;
use crate::work::Effort;

use super::Selection;

/// What each point costs whatever the train: reading settings, building the answer, s.
const POINT: f64 = 2e-5;
/// What each mesh costs: its part of the answer, s.
const MESH: f64 = 1.2e-5;
/// Elimination costs the cube of the number of meshes: exact kinematics and the forces, s.
const ELIMINATION: f64 = 1.3e-8;
/// Values that are sampled are long decimals, and exact numbers grow with them.
const DECIMALS: f64 = 3.0;
/// Losses that depend on torques are found in rounds.
const ROUNDS: f64 = 3.0;
/// An oil temperature is found in about as much time as so many points.
const HEAT: f64 = 10.0;
/// What it costs to read a train file anew, s for a byte.
const BYTE: f64 = 3e-8;

/// Seconds of one core for an operating point of this train, within a factor of about three; `digits` is how much longer
/// elimination takes than with the numbers of the file.
fn point(train: &Train, digits: f64) -> f64 {
    let n = train.meshes().len() as f64;
    let rounds = if train.is_physical() { ROUNDS } else { 1.0 } * if train.heat().is_some() { HEAT } else { 1.0 };
    POINT + rounds * (MESH * n + digits * ELIMINATION * n.powi(3))
}

impl Effort {
    /// So many operating points of a train.
    pub fn of_points(train: &Train, count: u64) -> Self {
        Self::new("operating points", count, point(train, 1.0))
    }

    /// So many trains that differ in values of a file of so many bytes, each with so many operating points.
    pub fn of_trains(train: &Train, bytes: usize, trains: u64, points_each: u64) -> Self {
        let points = Self::new("operating points", trains.saturating_mul(points_each), point(train, DECIMALS));
        Self { seconds: points.seconds + trains as f64 * BYTE * bytes as f64, ..points }
    }

    /// The operations and states that a selection leaves.
    pub fn of_analysis(train: &Train, selection: &Selection) -> Self {
        let operations = match &selection.operation {
            Some(_) => 1,
            None => train.operations().len(),
        };
        let states = if selection.state.is_some() { 1 } else { train.states().len().max(1) };
        // A state is asked driving and coasting; where losses depend on load, at it and without it.
        let each = if train.depends_on_load() { 4 } else { 2 };
        Self::of_points(train, (operations + each * states) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effort_is_told_in_words_and_grows_with_points_and_meshes() {
        let text = |n: usize| {
            let sets = (0..n).map(|k| {
                let carrier = if k + 1 == n { "out".to_owned() } else { format!("c{}", k + 1) };
                let sun = if k == 0 { "s".to_owned() } else { format!("c{k}") };
                format!(
                    "[[set]]\nname = \"P{k}\"\nsun = {{ member = \"{sun}\", teeth = 30 }}\nring = {{ member = \"frame\", teeth = 70 }}\n\
                     carrier = \"{carrier}\"\n"
                )
            });
            let members: Vec<String> = (1..n).map(|k| format!("\"c{k}\", ")).collect();
            format!(
                "format = 1\nname = \"t\"\nmembers = [\"s\", {}\"out\"]\nterminals = [\"s\", \"out\"]\n{}",
                members.concat(),
                sets.collect::<String>()
            )
        };
        let train = |n| Train::from_toml(&text(n)).unwrap();
        let (one, sixty) = (train(1), train(60));
        let seconds = |t: &Train, n| Effort::of_points(t, n).seconds;
        assert!((seconds(&one, 1000) / seconds(&one, 1) - 1000.0).abs() < 1e-9);
        assert!(seconds(&sixty, 1) > 100.0 * seconds(&one, 1));
        assert_eq!(Effort::new("points", 3, 1.0).to_string(), "3 points, about 3 seconds of one core");
        assert_eq!(Effort::new("points", 3, 1e4).to_string(), "3 points, about 9 hours of one core");
        assert_eq!(Effort::new("points", 3, 1e6).to_string(), "3 points, about 35 days of one core");
    }
}
