//! Every equilibrium at given speeds and torques, and whether these are all.

use crate::exact::Rational;
use crate::regimes::setup::{Pattern, Setup};
use crate::statics::Certificate;

/// An equilibrium, exactly.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    pub pattern: Pattern,
    /// By terminal.
    pub torques: Vec<Rational>,
    /// Active elements that are loaded and lossy, and have no relative motion: friction leaves their torques open.
    pub at_rest: Vec<usize>,
}

/// The equilibria under one load.
pub(super) struct Equilibria {
    pub states: Vec<State>,
    /// Whether it is certain that there are no others.
    pub complete: bool,
    /// Why there is none, or what else must be known.
    pub reason: Option<String>,
}

/// Every equilibrium at given base speeds, under torques on terminals.
pub(super) fn equilibria(setup: &Setup<'_>, base: &[Rational], loads: &[(usize, Rational)]) -> Equilibria {
    if loads.iter().all(|(_, x)| x.is_zero()) {
        return no_equilibrium(true, "no torque acts: nothing is loaded");
    }
    match setup.link {
        Some(_) => balanced(setup, base, &loads[0]),
        None => loaded(setup, base, loads),
    }
}

fn no_equilibrium(complete: bool, why: impl Into<String>) -> Equilibria {
    Equilibria { states: vec![], complete, reason: Some(why.into()) }
}

/// With two powers balanced one torque is given; each ray of equilibria is scaled to it.
fn balanced(setup: &Setup<'_>, base: &[Rational], (t, load): &(usize, Rational)) -> Equilibria {
    let Ok((cells, _)) = setup.torque_cells(base) else {
        return no_equilibrium(false, "too many interacting meshes to try every pattern of drivers");
    };
    let states: Vec<State> = cells
        .into_iter()
        .filter(|c| c.signs[*t] == load.sign() && load.sign() != 0)
        .map(|c| {
            let factor = load / &c.torques[*t];
            State { pattern: c.pattern, torques: c.torques.iter().map(|x| x * &factor).collect(), at_rest: vec![] }
        })
        .collect();
    let reason = states.is_empty().then(|| "no equilibrium: friction locks the train here".to_owned());
    Equilibria { states, complete: true, reason }
}

/// With as many torques as are independent the statics gives the equilibria, and whether they are all.
fn loaded(setup: &Setup<'_>, base: &[Rational], loads: &[(usize, Rational)]) -> Equilibria {
    let on: Vec<usize> = loads.iter().map(|(t, _)| *t).collect();
    let Ok(problem) = setup.equilibrium(base, &on) else {
        let names: Vec<&str> = on.iter().map(|t| setup.terminal_name(*t)).collect();
        return no_equilibrium(true, format!("the torques on {} do not settle the others", names.join(", ")));
    };
    let mut right = vec![Rational::ZERO; setup.c.nodes];
    loads.iter().for_each(|(t, x)| right[setup.terminals[*t].node] = x.clone());
    let answer = problem.solve(&right);
    let complete = answer.certificate != Certificate::Undecided;
    let sigma = setup.sigma_signs(base);
    let states: Vec<State> = answer
        .solutions
        .iter()
        .filter_map(|s| {
            let pattern = setup.pattern_of(base, s);
            let torques = setup.torques_for(&pattern, loads)?;
            let loaded = |&j: &usize| sigma[j] == 0 && setup.lossy(j) && s.forces[setup.active[j]] != 0.0;
            let at_rest = (0..setup.active.len()).filter(loaded).collect();
            Some(State { pattern, torques, at_rest })
        })
        .collect();
    let reason = verdict(!states.is_empty(), complete, !answer.stretches.is_empty()).map(str::to_owned);
    Equilibria { states, complete, reason }
}

/// What must be said beside the equilibria that were found.
fn verdict(found: bool, complete: bool, continuum: bool) -> Option<&'static str> {
    match (found, complete) {
        (false, true) => Some("no equilibrium: friction locks the train at these speeds and torques"),
        (false, false) => Some("too many interacting meshes: no equilibrium was found, and none is excluded"),
        (true, false) => Some("too many interacting meshes: the equilibrium shown may not be the only one"),
        (true, true) => {
            continuum.then_some("the load lies on a self-locking threshold: a whole range of torques balances it")
        }
    }
}
