//! Expressions in the usual order of operations: read once, evaluated over numbers of any kind.
//!
//! Powers go before signs and from the right: `-t^2` is `-(t^2)`, and `2^3^2` is `2^(3^2)`.

use std::f64::consts::{E, PI, TAU};

/// Brackets, signs and exponents within each other at most: what is read deeper than that is no formula of a person.
const DEEPEST: usize = 256;
/// Values that wait for an operator without memory of their own.
const FEW: usize = 16;

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    Min,
    Max,
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unary {
    Negative,
    Abs,
    Signum,
    Floor,
    Round,
    Ceil,
    Trunc,
    Fract,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Exp,
    Sqrt,
    Cbrt,
    Ln,
    Log2,
    Log10,
}

/// The functions of two numbers, by name; they may stand between them too: `t max 0`.
const OF_TWO: [(&str, Binary); 3] = [("atan2", Binary::Atan2), ("min", Binary::Min), ("max", Binary::Max)];

/// The functions of one number, by name.
const OF_ONE: [(&str, Unary); 26] = [
    ("abs", Unary::Abs),
    ("signum", Unary::Signum),
    ("floor", Unary::Floor),
    ("round", Unary::Round),
    ("ceil", Unary::Ceil),
    ("trunc", Unary::Trunc),
    ("fract", Unary::Fract),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("asin", Unary::Asin),
    ("acos", Unary::Acos),
    ("atan", Unary::Atan),
    ("sinh", Unary::Sinh),
    ("cosh", Unary::Cosh),
    ("tanh", Unary::Tanh),
    ("asinh", Unary::Asinh),
    ("acosh", Unary::Acosh),
    ("atanh", Unary::Atanh),
    ("exp", Unary::Exp),
    ("sqrt", Unary::Sqrt),
    ("cbrt", Unary::Cbrt),
    ("ln", Unary::Ln),
    ("log", Unary::Ln),
    ("log2", Unary::Log2),
    ("log10", Unary::Log10),
];

/// All functions by name.
fn functions() -> String {
    OF_ONE.iter().map(|(name, _)| *name).chain(OF_TWO.iter().map(|(name, _)| *name)).collect::<Vec<_>>().join(", ")
}

const CONSTANTS: [(&str, f64); 6] = [("PI", PI), ("π", PI), ("E", E), ("e", E), ("TAU", TAU), ("τ", TAU)];

fn named<T: Copy>(of: &[(&str, T)], name: &str) -> Option<T> {
    of.iter().find(|(known, _)| *known == name).map(|(_, it)| *it)
}

/// A kind of number that a formula can be evaluated over.
pub(super) trait Number: Copy {
    /// A number that stands in the formula.
    fn constant(value: f64) -> Self;
    /// What an operation makes of two.
    fn binary(self, operation: Binary, other: Self) -> Self;
    /// What a function makes of one.
    fn unary(self, function: Unary) -> Self;
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        match operation {
            Binary::Add => self + other,
            Binary::Subtract => self - other,
            Binary::Multiply => self * other,
            Binary::Divide => self / other,
            Binary::Power => self.powf(other),
            Binary::Atan2 => self.atan2(other),
            Binary::Min => self.min(other),
            Binary::Max => self.max(other),
        }
    }

    fn unary(self, function: Unary) -> Self {
        match function {
            Unary::Negative => -self,
            Unary::Abs => self.abs(),
            Unary::Signum => self.signum(),
            Unary::Floor => self.floor(),
            Unary::Round => self.round(),
            Unary::Ceil => self.ceil(),
            Unary::Trunc => self.trunc(),
            Unary::Fract => self.fract(),
            Unary::Sin => self.sin(),
            Unary::Cos => self.cos(),
            Unary::Tan => self.tan(),
            Unary::Asin => self.asin(),
            Unary::Acos => self.acos(),
            Unary::Atan => self.atan(),
            Unary::Sinh => self.sinh(),
            Unary::Cosh => self.cosh(),
            Unary::Tanh => self.tanh(),
            Unary::Asinh => self.asinh(),
            Unary::Acosh => self.acosh(),
            Unary::Atanh => self.atanh(),
            Unary::Exp => self.exp(),
            Unary::Sqrt => self.sqrt(),
            Unary::Cbrt => self.cbrt(),
            Unary::Ln => self.ln(),
            Unary::Log2 => self.log2(),
            Unary::Log10 => self.log10(),
        }
    }
}

/// A step of the evaluation.
#[derive(Clone, Copy, Debug)]
enum Step {
    Constant(f64),
    Variable(usize),
    Unary(Unary),
    Binary(Binary),
}

/// An expression that was read: steps that each take values from the end of a list and put one there.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    steps: Vec<Step>,
    /// Values that wait at once, at most.
    deepest: usize,
}

impl Expression {
    /// Reads tokens; returns the expression and its variables, in the order of their names.
    pub fn parse(tokens: &[&str]) -> Result<(Self, Vec<String>), String> {
        let mut parser = Parser { tokens, at: 0, depth: 0, steps: vec![], variables: vec![] };
        parser.sum()?;
        if let Some(token) = parser.next() {
            return Err(match token {
                ")" => "there is a `)` without a `(`".to_owned(),
                "(" => match tokens[..parser.at].iter().rev().nth(1).filter(|t| t.starts_with(char::is_alphabetic)) {
                    Some(name) => format!("there is no function `{name}`; there are {}", functions()),
                    None => "an operator is missing before `(`".to_owned(),
                },
                token => format!("an operator is missing before `{token}`"),
            });
        }
        let Parser { mut steps, variables, .. } = parser;
        let mut names = variables.clone();
        names.sort_unstable();
        let (mut depth, mut deepest) = (0, 0);
        for step in &mut steps {
            match step {
                Step::Constant(_) => depth += 1,
                Step::Variable(k) => {
                    *k = names.iter().position(|n| *n == variables[*k]).unwrap_or(0);
                    depth += 1;
                }
                Step::Unary(_) => {}
                Step::Binary(_) => depth -= 1,
            }
            deepest = deepest.max(depth);
        }
        Ok((Self { steps, deepest }, names.into_iter().map(str::to_owned).collect()))
    }

    /// Its value, with these values of its variables.
    pub fn value<N: Number>(&self, variable: impl Fn(usize) -> N) -> N {
        let mut few = [N::constant(0.0); FEW];
        if self.deepest <= FEW {
            return self.value_in(&mut few, variable);
        }
        self.value_in(&mut vec![N::constant(0.0); self.deepest], variable)
    }

    fn value_in<N: Number>(&self, values: &mut [N], variable: impl Fn(usize) -> N) -> N {
        let mut n = 0;
        for step in &self.steps {
            match *step {
                Step::Constant(value) => values[n] = N::constant(value),
                Step::Variable(k) => values[n] = variable(k),
                Step::Unary(function) => {
                    values[n - 1] = values[n - 1].unary(function);
                    continue;
                }
                Step::Binary(operation) => {
                    n -= 1;
                    values[n - 1] = values[n - 1].binary(operation, values[n]);
                    continue;
                }
            }
            n += 1;
        }
        values[0]
    }
}

struct Parser<'t> {
    tokens: &'t [&'t str],
    at: usize,
    depth: usize,
    steps: Vec<Step>,
    variables: Vec<&'t str>,
}

impl<'t> Parser<'t> {
    fn next(&self) -> Option<&'t str> {
        self.tokens.get(self.at).copied()
    }

    /// Goes past this token, if it is the next one.
    fn takes(&mut self, token: &str) -> bool {
        let is_it = self.next() == Some(token);
        self.at += usize::from(is_it);
        is_it
    }

    fn wants(&mut self, token: &str) -> Result<(), String> {
        match (self.takes(token), self.next()) {
            (true, _) => Ok(()),
            (false, Some(other)) => Err(format!("there is `{other}` where `{token}` should be")),
            (false, None) => Err(format!("a `{token}` is missing at the end")),
        }
    }

    fn put(&mut self, step: Step) {
        // What is made of numbers alone is a number.
        let known = |k: usize| match self.steps.len().checked_sub(k).map(|at| self.steps[at]) {
            Some(Step::Constant(value)) => Some(value),
            _ => None,
        };
        let (made, of) = match (step, known(1), known(2)) {
            (Step::Unary(function), Some(a), _) => (a.unary(function), 1),
            (Step::Binary(operation), Some(b), Some(a)) => (a.binary(operation, b), 2),
            _ => return self.steps.push(step),
        };
        self.steps.truncate(self.steps.len() - of);
        self.steps.push(Step::Constant(made));
    }

    /// `a + b max c`, from the left. What takes away binds closer than what adds, so that `a max b - c` is `a max (b - c)`.
    fn sum(&mut self) -> Result<(), String> {
        self.row(Self::difference, |token| match token {
            "+" => Some(Binary::Add),
            name => named(&OF_TWO, name),
        })
    }

    /// `a - b - c`, from the left.
    fn difference(&mut self) -> Result<(), String> {
        self.row(Self::product, |token| (token == "-").then_some(Binary::Subtract))
    }

    /// `a * b * c`, from the left.
    fn product(&mut self) -> Result<(), String> {
        self.row(Self::quotient, |token| (token == "*").then_some(Binary::Multiply))
    }

    /// `a / b / c`, from the left.
    fn quotient(&mut self) -> Result<(), String> {
        self.row(Self::signed, |token| (token == "/").then_some(Binary::Divide))
    }

    /// Operands with operators between them, from the left.
    fn row(
        &mut self,
        operand: fn(&mut Self) -> Result<(), String>,
        operator: fn(&str) -> Option<Binary>,
    ) -> Result<(), String> {
        operand(self)?;
        while let Some(operation) = self.next().and_then(operator) {
            self.at += 1;
            operand(self)?;
            self.put(Step::Binary(operation));
        }
        Ok(())
    }

    /// A power with its signs.
    fn signed(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("brackets, signs and powers lie more than {DEEPEST} deep in each other"));
        }
        if self.takes("-") {
            self.signed()?;
            self.put(Step::Unary(Unary::Negative));
        } else if self.takes("+") {
            self.signed()?;
        } else {
            self.primary()?;
            if self.takes("^") {
                self.signed()?;
                self.put(Step::Binary(Binary::Power));
            }
        }
        self.depth -= 1;
        Ok(())
    }

    /// A number, a variable, a function of something, or something in brackets.
    fn primary(&mut self) -> Result<(), String> {
        let Some(token) = self.next() else { return Err("it ends where a value should be".to_owned()) };
        self.at += 1;
        if token == "(" {
            self.sum()?;
            return self.wants(")");
        }
        if let Some(function) = named(&OF_ONE, token) {
            return self.argument(token).map(|()| self.put(Step::Unary(function)));
        }
        if let Some(operation) = named(&OF_TWO, token) {
            self.wants("(")?;
            self.sum()?;
            self.wants(",")?;
            self.sum()?;
            self.wants(")")?;
            self.put(Step::Binary(operation));
            return Ok(());
        }
        if let Some(value) = named(&CONSTANTS, token) {
            self.put(Step::Constant(value));
            return Ok(());
        }
        if token.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            let value = token.parse().map_err(|_| format!("`{token}` is no number"))?;
            self.put(Step::Constant(value));
            return Ok(());
        }
        let name = match token.strip_prefix('{') {
            Some(name) => name.strip_suffix('}').ok_or_else(|| format!("the `}}` of `{token}` is missing"))?,
            None => token,
        };
        if !token.starts_with(|c: char| c.is_alphabetic() || matches!(c, '_' | '{')) {
            return Err(format!("there is `{token}` where a value should be"));
        }
        let k = self.variables.iter().position(|n| *n == name).unwrap_or_else(|| {
            self.variables.push(name);
            self.variables.len() - 1
        });
        self.put(Step::Variable(k));
        Ok(())
    }

    /// The argument of a function: in brackets, or the one value that follows, as in `sin t`.
    fn argument(&mut self, function: &str) -> Result<(), String> {
        if self.next().is_none() {
            return Err(format!("`{function}` has no argument"));
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("functions lie more than {DEEPEST} deep in each other"));
        }
        let negative = self.takes("-");
        self.primary()?;
        if negative {
            self.put(Step::Unary(Unary::Negative));
        }
        self.depth -= 1;
        Ok(())
    }
}
