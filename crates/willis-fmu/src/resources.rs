//! What lies in the folder `resources` of a unit: the train file, the tables that it names, and what was asked.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use willis::diagnostic::Diagnostics;
use willis::model::Model;

use crate::layout::{Interface, Layout};

/// The train file.
pub(crate) const TRAIN: &str = "train.toml";
/// What was asked, and what else there is.
pub(crate) const INDEX: &str = "unit.json";

/// Largest file that is read back, bytes.
const MOST: u64 = 256 << 20;

/// The index of the folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResourceIndex {
    /// `willis-fmu-2`
    pub format: String,
    pub scenario: String,
    pub co_simulation: bool,
    pub model_exchange: bool,
    /// Laws in force over those of the text: family and name.
    pub laws: Vec<(String, String)>,
    /// Files of the tables, by the names that the train file has for them.
    pub tables: BTreeMap<String, String>,
    /// What tells that the runtime has the variables of the description, in the same order.
    pub variables: String,
    /// What tells that folder and description belong together.
    pub token: String,
}

/// The only format there is.
pub(crate) const FORMAT: &str = "willis-fmu-2";

impl ResourceIndex {
    pub fn interface(&self) -> Interface {
        match (self.co_simulation, self.model_exchange) {
            (true, true) => Interface::Both,
            (false, true) => Interface::ModelExchange,
            _ => Interface::CoSimulation,
        }
    }
}

/// All files of the folder.
pub(crate) struct Resources {
    pub index: ResourceIndex,
    /// Names and texts; the index is not among them.
    pub files: Vec<(String, String)>,
}

impl Resources {
    /// Of a model in a scenario, which has these variables.
    pub fn of(model: &Model, scenario: &str, interface: Interface, layout: &Layout) -> Self {
        let mut files = vec![(TRAIN.to_owned(), model.to_toml().to_owned())];
        let mut tables = BTreeMap::new();
        for (k, (name, text)) in model.files().enumerate() {
            let file = format!("table-{k}.csv");
            tables.insert(name.to_owned(), file.clone());
            files.push((file, text.to_owned()));
        }
        let mut index = ResourceIndex {
            format: FORMAT.to_owned(),
            scenario: scenario.to_owned(),
            co_simulation: interface.steps(),
            model_exchange: interface.exchanges(),
            laws: model.laws().to_vec(),
            tables,
            variables: order(layout),
            token: String::new(),
        };
        index.token = token(&index, &files);
        Self { index, files }
    }

    /// Reads a folder and makes sure that nothing in it was changed.
    ///
    /// # Errors
    /// What is missing, unreadable or changed, in words.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let file = |name: &str| {
            let path = folder.join(name);
            let told = |e: std::io::Error| format!("{}: {e}", path.display());
            let size = fs::metadata(&path).map_err(told)?.len();
            if size > MOST {
                return Err(format!("{}: {size} bytes are more than a unit holds", path.display()));
            }
            fs::read_to_string(&path).map_err(told)
        };
        let text = file(INDEX)?;
        let index: ResourceIndex = serde_json::from_str(&text)
            .map_err(|e| format!("{}: {e}; export the unit anew", folder.join(INDEX).display()))?;
        if index.format != FORMAT {
            return Err(format!(
                "the unit was written as `{}`, and this runtime reads `{FORMAT}`; export the unit anew",
                index.format
            ));
        }
        let mut files = vec![(TRAIN.to_owned(), file(TRAIN)?)];
        // In the order in which they were written.
        let mut names: Vec<&String> = index.tables.values().collect();
        names.sort_by_key(|name| (name.len(), (*name).clone()));
        for name in names {
            if name.contains(['/', '\\']) {
                return Err(format!("`{name}` is no file of this folder; export the unit anew"));
            }
            files.push((name.clone(), file(name)?));
        }
        if token(&index, &files) != index.token {
            return Err(format!(
                "{}: the files are not those that the unit was exported with; set parameters instead of changing them, or \
                 export it anew",
                folder.display()
            ));
        }
        Ok(Self { index, files })
    }

    /// The model.
    ///
    /// # Errors
    /// What is wrong with the train file.
    pub fn model(&self) -> Result<Model, Diagnostics> {
        let text = |name: &str| self.files.iter().find(|f| f.0 == name).map(|f| f.1.clone());
        let mut load = |name: &str| {
            let table = self.index.tables.get(name).and_then(|file| text(file));
            table.ok_or_else(|| "it is not in the unit".to_owned())
        };
        Model::read(&self.files[0].1, &mut load)?.with_laws(self.index.laws.clone())
    }
}

/// Of what is in the folder.
fn token(index: &ResourceIndex, files: &[(String, String)]) -> String {
    let bare = ResourceIndex { token: String::new(), ..index.clone() };
    let mut hash = Sha256::new();
    hash.update(serde_json::to_vec(&bare).expect("plain data"));
    for (name, text) in files {
        hash.update((name.len() as u64).to_le_bytes());
        hash.update(name);
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    let digits = digits(hash);
    let part = |from: usize, to: usize| &digits[from..to];
    format!("{{{}-{}-{}-{}-{}}}", part(0, 8), part(8, 12), part(12, 16), part(16, 20), part(20, 32))
}

/// Of the variables in their order: whatever gives a reference its meaning.
pub(crate) fn order(layout: &Layout) -> String {
    let mut hash = Sha256::new();
    for variable in &layout.variables {
        let text = format!("{:?}", (&variable.name, variable.kind, &variable.role));
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    digits(hash)
}

fn digits(hash: Sha256) -> String {
    hash.finalize().iter().take(16).map(|b| format!("{b:02x}")).collect()
}
