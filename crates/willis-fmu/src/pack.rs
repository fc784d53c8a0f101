//! A train in a scenario as one file that other simulators read.

use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;

use crate::LIBRARY;
use crate::archive::{Entry, zip};
use crate::description::{Version, describe};
use crate::layout::{Interface, Layout, Role};
use crate::resources::{INDEX, Resources};

/// What is asked of a unit.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The scenario; none where the train has one only.
    pub scenario: Option<&'a str>,
    /// The version of the interface.
    pub version: Version,
    /// Who advances.
    pub interface: Interface,
    /// The runtime: the bytes of this crate as a library of C.
    pub library: &'a [u8],
}

/// A unit.
#[derive(Clone, Debug)]
pub struct Packed {
    /// The file.
    pub bytes: Vec<u8>,
    /// The scenario in it.
    pub scenario: String,
    /// How many inputs, parameters, outputs and states it has.
    pub counts: [usize; 4],
}

/// Packs a unit; the same bytes for the same request.
///
/// # Errors
/// A scenario that there is not, or that cannot be run.
///
/// # Example
/// ```
/// use willis_fmu::{Interface, Request, Version, pack};
/// let model = willis::Model::from_toml("format = 1\nname = 'a rotor coasts'\nmembers = ['rotor']\n\
///     inertias = { rotor = '2 kg m^2' }\ndrag = [{ name = 'b', members = ['rotor'], coulomb = '4 N m' }]\n\
///     scenario = [{ name = 'coast', duration = '10 s', initial_speeds = { rotor = '12 rad/s' } }]")?;
/// // Really the bytes of the runtime.
/// let library = b"...";
/// let request = Request { scenario: None, version: Version::Two, interface: Interface::Both, library };
/// let unit = pack(&model, &request)?;
/// assert_eq!(unit.scenario, "coast");
/// assert_eq!(unit.bytes, pack(&model, &request)?.bytes);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn pack(model: &Model, request: &Request<'_>) -> Result<Packed, Diagnostics> {
    let train = model.train();
    let scenario = match (request.scenario, train.scenarios()) {
        (Some(name), _) => train.find_scenario(name)?.name.clone(),
        (None, [one]) => one.name.clone(),
        (None, []) => {
            let d =
                Diagnostic::new(Code::UnknownSelection, "", "the train has no scenario, so that nothing moves in it");
            return Err(d.hint("add a [[scenario]] with a duration, sources and speeds at the start").into());
        }
        (None, all) => {
            let names = all.iter().map(|s| format!("`{}`", s.name)).collect::<Vec<_>>().join(", ");
            let d = Diagnostic::new(Code::UnknownSelection, "", format!("the train has {} scenarios", all.len()));
            return Err(d.hint(format!("name one of them: {names}")).into());
        }
    };
    let layout = Layout::of(model, &scenario, request.interface)?;
    let resources = Resources::of(model, &scenario, request.interface, &layout);
    let description =
        describe(&layout, train.name(), &scenario, &resources.index.token, request.version, request.interface);
    let mut entries = vec![Entry { name: "modelDescription.xml".to_owned(), bytes: description.into_bytes() }];
    let folder = format!("binaries/{}", platform(request.version));
    let library = format!("{folder}/{LIBRARY}{}", std::env::consts::DLL_SUFFIX);
    entries.push(Entry { name: library, bytes: request.library.to_vec() });
    let index = serde_json::to_string_pretty(&resources.index).expect("plain data") + "\n";
    entries.push(Entry { name: format!("resources/{INDEX}"), bytes: index.into_bytes() });
    for (name, text) in resources.files {
        entries.push(Entry { name: format!("resources/{name}"), bytes: text.into_bytes() });
    }
    let bytes = zip(&entries).ok_or_else(|| {
        Diagnostics::from(Diagnostic::new(Code::OutOfRange, "", "the unit would be larger than 4 GiB"))
    })?;
    let count = |is: fn(&Role) -> bool| layout.places(is).len();
    let states = layout.states.len();
    let counts = [count(Role::is_input), count(Role::is_parameter), count(Role::is_output), states];
    Ok(Packed { bytes, scenario, counts })
}

/// The folder of libraries for this machine.
fn platform(version: Version) -> String {
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    match version {
        Version::Two => {
            let name = match os {
                "windows" => "win",
                "macos" => "darwin",
                other => other,
            };
            format!("{name}{}", if cfg!(target_pointer_width = "64") { "64" } else { "32" })
        }
        Version::Three => format!("{arch}-{}", if os == "macos" { "darwin" } else { os }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenarios_with_commas_in_their_names_are_told_apart() {
        let scenario = |name: &str| format!("[[scenario]]\nname = '{name}'\nduration = '1 s'\n");
        let model = Model::from_toml(&format!(
            "format = 1\nname = 'rotor'\nmembers = ['rotor']\ninertias = {{ rotor = '2 kg m^2' }}\n{}{}",
            scenario("1 to 2, handed over"),
            scenario("coast")
        ));
        let request =
            Request { scenario: None, version: Version::Two, interface: Interface::Both, library: b"the runtime" };
        let wrong = pack(&model.unwrap(), &request).unwrap_err();
        let hints: Vec<String> = wrong.iter().flat_map(|d| d.hints.iter().map(ToString::to_string)).collect();
        assert_eq!(hints, ["name one of them: `1 to 2, handed over`, `coast`"]);
    }
}
