//! `formula`: closed formulas to take away.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::named::NameMap;
use willis::regimes::{self, ClosedFormula, Derivative, Efficiencies, EfficiencyBasis, FormulaRequest, Ratios};
use willis::symbolic::Notation;
use willis::work::Work;

use super::amount::pair;
use crate::{Given, Question, Refusal};

/// Give the closed formula of efficiency, speed ratio and torque ratio, also as code.
///
/// Emitted code checks first whether its formula holds for its arguments and refuses to answer where it does not.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Formula {
    /// Only this state of the shift table, or "as drawn".
    #[cfg_attr(feature = "clap", arg(long, value_name = "STATE"))]
    pub state: Option<String>,
    /// Where power enters; else the state's input. Several with commas between.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub from: Vec<String>,
    /// Where power leaves; else the state's output. Several with commas between.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub to: Vec<String>,
    /// Members on which torque may act, for two and more degrees of freedom.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ','))]
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero.
    #[cfg_attr(feature = "clap", arg(long, value_delimiter = ',', value_name = "A,B"))]
    pub balance: Option<Vec<String>>,
    /// Only the regime of this name, as `willis regimes` lists it.
    #[cfg_attr(feature = "clap", arg(long))]
    pub regime: Option<String>,
    /// How to write it.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value = "text"))]
    pub lang: Language,
    /// How ratios are written.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value = "basic"))]
    pub ratios: RatiosAs,
    /// How efficiencies are written.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value = "basic"))]
    pub efficiencies: EfficienciesAs,
    /// Also the derivatives with respect to every efficiency: which mesh matters most.
    #[cfg_attr(feature = "clap", arg(long))]
    pub derivatives: bool,
}

/// How to write a formula.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Language {
    /// For eyes.
    #[default]
    Text,
    /// For typesetting (amsmath).
    Latex,
    /// Python 3.
    Python,
    /// Rust.
    Rust,
    /// C99.
    C,
    /// Modelica.
    Modelica,
}

/// How ratios are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum RatiosAs {
    /// One symbol for the basic ratio of each set.
    #[default]
    Basic,
    /// Tooth numbers as symbols.
    Teeth,
    /// The numbers of this train.
    Numbers,
}

/// How efficiencies are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum EfficienciesAs {
    /// One symbol for each set: the product over its meshes.
    #[default]
    Basic,
    /// One symbol for each mesh.
    Meshes,
    /// The numbers of this train.
    Numbers,
}

/// Closed formulas of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct FormulaAnswer {
    /// `willis-formula-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The formulas, state by state.
    pub formulas: Vec<OneFormula>,
    /// States, or directions of one, that have no formula.
    pub without: Vec<NoFormula>,
    /// All formulas written in the language that was asked for.
    pub code: String,
}

impl Contract for FormulaAnswer {
    const FORMAT: &'static str = "willis-formula-1";
}

/// The closed formula of a regime, or of several that share it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneFormula {
    /// An identifier: train, state, direction.
    pub name: String,
    /// What it is, in words.
    pub title: String,
    /// The state of the shift table, or `as drawn`.
    pub state: String,
    /// Regimes in which it holds (two or more degrees of freedom).
    pub regimes: Vec<String>,
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// The member that drives each element; null where none does.
    pub drivers: NameMap<Option<String>>,
    /// The efficiency.
    pub efficiency: Written,
    /// Its value with the arguments' own values, as a fraction and as a number; absent at a pole.
    pub value: Option<Valued>,
    /// Speed of the input over that of the output (one degree of freedom).
    pub speed_ratio: Option<Written>,
    /// Torque on the output over that on the input (one degree of freedom).
    pub torque_ratio: Option<Written>,
    /// What it takes.
    pub arguments: Vec<OneArgument>,
    /// Expressions that are positive where the formula holds, and nowhere else.
    pub conditions: Vec<OneCondition>,
    /// Where mesh efficiencies come from whose losses laws compute; absent where all are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_basis: Option<EfficiencyBasis>,
    /// Derivatives of the efficiency, where they were asked for; the one that costs most first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub derivatives: Vec<OneDerivative>,
}

/// An expression, written twice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Written {
    /// In plain text, as most languages read it.
    pub text: String,
    /// In LaTeX.
    pub latex: String,
}

/// A number and the fraction that it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Valued {
    /// `493/500`.
    pub exact: String,
    /// `0.986`.
    pub value: f64,
}

/// What a formula takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneArgument {
    /// Its identifier.
    pub name: String,
    /// In LaTeX.
    pub latex: String,
    /// What it stands for, in words.
    pub meaning: String,
    /// Its value in this train; of a speed (rad/s) or a torque (N m) one inside the regime.
    pub value: f64,
    /// The same as a fraction.
    pub exact: String,
    /// Whether it is an efficiency, above 0 and at most 1.
    pub efficiency: bool,
    /// Whether the train fixes it: a ratio, a tooth number, an efficiency.
    pub fixed: bool,
}

/// A condition of a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneCondition {
    /// Positive where the formula holds.
    pub expression: Written,
    /// What it ensures, in words.
    pub ensures: String,
}

/// A derivative of the efficiency.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneDerivative {
    /// The efficiency by which it is taken.
    pub of: String,
    /// The derivative.
    pub formula: Written,
    /// Its value in this train; absent at a pole.
    pub value: Option<f64>,
    /// How much of the whole loss this element or mesh causes, to first order; absent at a pole.
    pub share: Option<f64>,
}

/// A state or a direction without a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct NoFormula {
    /// The state.
    pub state: String,
    /// Why.
    pub why: String,
}

impl From<Language> for Notation {
    fn from(l: Language) -> Self {
        match l {
            Language::Text => Self::Text,
            Language::Latex => Self::Latex,
            Language::Python => Self::Python,
            Language::Rust => Self::Rust,
            Language::C => Self::C,
            Language::Modelica => Self::Modelica,
        }
    }
}

impl Formula {
    fn request(&self) -> Result<FormulaRequest, Refusal> {
        Ok(FormulaRequest {
            state: self.state.clone(),
            from: self.from.clone(),
            to: self.to.clone(),
            terminals: self.terminals.clone(),
            balance: pair(self.balance.as_deref())?,
            regime: self.regime.clone(),
            ratios: match self.ratios {
                RatiosAs::Basic => Ratios::Basic,
                RatiosAs::Teeth => Ratios::Teeth,
                RatiosAs::Numbers => Ratios::Numbers,
            },
            efficiencies: match self.efficiencies {
                EfficienciesAs::Basic => Efficiencies::Basic,
                EfficienciesAs::Meshes => Efficiencies::Meshes,
                EfficienciesAs::Numbers => Efficiencies::Numbers,
            },
        })
    }
}

fn one(f: &ClosedFormula, derivatives: bool) -> OneFormula {
    let [text, latex] = [Notation::Text, Notation::Latex];
    let ratio = |k: usize| {
        let (text, latex) = (f.ratios(text)?, f.ratios(latex)?);
        Some(Written { text: text[k].clone(), latex: latex[k].clone() })
    };
    let conditions = f.conditions(text).into_iter().zip(f.conditions(latex));
    let finite = |x: f64| x.is_finite().then_some(x);
    let derivative = |d: Derivative| OneDerivative {
        of: d.of,
        formula: Written { text: d.formula, latex: d.latex },
        value: finite(d.value),
        share: finite(d.share),
    };
    OneFormula {
        name: f.name.clone(),
        title: f.title.clone(),
        state: f.state.clone(),
        regimes: f.regimes.clone(),
        inputs: f.inputs.clone(),
        outputs: f.outputs.clone(),
        drivers: f.drivers.clone(),
        efficiency: Written { text: f.efficiency(text), latex: f.efficiency(latex) },
        value: f.value().map(|v| Valued { exact: v.to_string(), value: v.to_f64() }),
        speed_ratio: ratio(0),
        torque_ratio: ratio(1),
        arguments: f
            .arguments
            .iter()
            .map(|a| OneArgument {
                name: a.name.clone(),
                latex: a.latex.clone(),
                meaning: a.meaning.clone(),
                value: a.value,
                exact: a.exact.to_string(),
                efficiency: a.efficiency,
                fixed: a.fixed,
            })
            .collect(),
        conditions: conditions
            .map(|((text, ensures), (latex, _))| OneCondition { expression: Written { text, latex }, ensures })
            .collect(),
        efficiency_basis: f.basis.clone(),
        derivatives: if derivatives { f.derivatives().into_iter().map(derivative).collect() } else { vec![] },
    }
}

impl Question for Formula {
    const NAME: &'static str = "formula";
    type Answer = FormulaAnswer;

    fn ask(&self, of: &[Given], _: &dyn Work) -> Result<FormulaAnswer, Refusal> {
        let sheet = regimes::formulas(of[0].model.train(), &self.request()?)?;
        let without = sheet.without.iter().map(|(state, why)| NoFormula { state: state.clone(), why: why.to_string() });
        Ok(FormulaAnswer {
            format: Format::new(),
            train: sheet.train.clone(),
            formulas: sheet.formulas.iter().map(|f| one(f, self.derivatives)).collect(),
            without: without.collect(),
            code: sheet.emit(self.lang.into(), self.derivatives),
        })
    }

    fn text(&self, answer: &FormulaAnswer, _: &[Given]) -> String {
        answer.code.clone()
    }
}
