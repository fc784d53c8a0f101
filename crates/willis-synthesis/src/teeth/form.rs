//! Speeds as polynomials in the basic ratios of the sets: determinants that are linear in each of them.

use willis::exact::residue::{self, minus, plus, times};

use super::fit::gcd;

/// A polynomial of degree at most one in each of its variables: the coefficient at position `mask` belongs to the product
/// of the variables whose bits are set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Form(pub Vec<i64>);

/// A quotient of two forms, free of what is common to both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Quotient {
    pub numerator: Form,
    pub denominator: Form,
}

/// An equation `base + y · slope = 0`, row by row linear in the speeds; `variable` is the number of its y, none where the
/// equation has no variable and `slope` is zero.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub base: Vec<i64>,
    pub slope: Vec<i64>,
    pub variable: Option<usize>,
}

/// How the columns of a system of equations depend on each other, for almost all values of the variables.
pub(crate) struct Structure {
    /// Rows that are independent.
    pub rows: Vec<usize>,
    /// Columns that follow from the others, in the order of `order`.
    pub pivots: Vec<usize>,
    /// Columns that are free.
    pub free: Vec<usize>,
}

/// Eliminates the columns in their order at a point that is as good as random.
pub(crate) fn structure(rows: &[Row], order: &[usize]) -> Structure {
    let class = |x: i64| residue::of(x.into());
    let point = |v: usize| times(residue::of(0x1234_5678_9abc_def1), residue::power(v as u64 + 3, 7) ^ 0x5_5555_5555);
    let mut matrix: Vec<Vec<u64>> = rows
        .iter()
        .map(|r| {
            let y = r.variable.map_or(0, point);
            r.base.iter().zip(&r.slope).map(|(b, s)| plus(class(*b), times(y, class(*s)))).collect()
        })
        .collect();
    let mut at: Vec<usize> = (0..rows.len()).collect();
    let mut found = Structure { rows: vec![], pivots: vec![], free: vec![] };
    for &column in order {
        let rank = found.pivots.len();
        let Some(best) = (rank..matrix.len()).find(|&r| matrix[r][column] != 0) else {
            found.free.push(column);
            continue;
        };
        matrix.swap(rank, best);
        at.swap(rank, best);
        let scale = residue::inverse(matrix[rank][column]);
        let pivot: Vec<u64> = matrix[rank].iter().map(|x| times(*x, scale)).collect();
        // The rows below the pivot: those above it are done.
        for row in &mut matrix[rank + 1..] {
            let factor = row[column];
            if factor != 0 {
                for (x, p) in row.iter_mut().zip(&pivot) {
                    *x = minus(*x, times(factor, *p));
                }
            }
        }
        found.rows.push(at[rank]);
        found.pivots.push(column);
    }
    found
}

/// The determinant of whole numbers, by Bareiss' elimination without fractions; none where it does not fit.
fn determinant(mut m: Vec<Vec<i128>>) -> Option<i128> {
    let n = m.len();
    let (mut sign, mut previous) = (1, 1);
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&r| m[r][k] != 0) else { return Some(0) };
        if pivot != k {
            m.swap(pivot, k);
            sign = -sign;
        }
        for i in k + 1..n {
            for j in k + 1..n {
                let a = m[i][j].checked_mul(m[k][k])?;
                let b = m[i][k].checked_mul(m[k][j])?;
                m[i][j] = a.checked_sub(b)? / previous;
            }
        }
        previous = m[k][k];
    }
    Some(if n == 0 { 1 } else { sign * m[n - 1][n - 1] })
}

/// The speeds of the columns `columns`, one more than there are `rows`, up to a common factor: minors with alternating
/// signs, as forms of the variables. None where a coefficient is beyond all measure.
pub(crate) fn null_vector(rows: &[&Row], columns: &[usize], variables: usize) -> Option<Vec<Form>> {
    let corners = 1usize << variables;
    let mut forms = vec![vec![0i128; corners]; columns.len()];
    for corner in 0..corners {
        let matrix: Vec<Vec<i128>> = rows
            .iter()
            .map(|r| {
                let y = r.variable.is_some_and(|v| corner >> v & 1 == 1);
                columns.iter().map(|&c| i128::from(r.base[c]) + if y { i128::from(r.slope[c]) } else { 0 }).collect()
            })
            .collect();
        for (k, form) in forms.iter_mut().enumerate() {
            let minor = matrix.iter().map(|r| [&r[..k], &r[k + 1..]].concat()).collect();
            form[corner] = determinant(minor)? * if k % 2 == 0 { 1 } else { -1 };
        }
    }
    // From values at the corners of the unit cube to coefficients.
    for form in &mut forms {
        for v in 0..variables {
            for mask in 0..corners {
                if mask >> v & 1 == 1 {
                    form[mask] -= form[mask ^ (1 << v)];
                }
            }
        }
    }
    let common = forms.iter().flatten().fold(0i128, |g, x| gcd(g, *x)).max(1);
    forms
        .into_iter()
        .map(|f| f.into_iter().map(|x| i64::try_from(x / common).ok()).collect::<Option<Vec<_>>>().map(Form))
        .collect()
}

impl Form {
    /// Both halves with respect to a variable: what stands alone, and what is multiplied by it. Positions keep their
    /// masks; that of the variable is not set.
    fn halves(&self, variable: usize) -> [Vec<i64>; 2] {
        let bit = 1 << variable;
        let pick = |set: bool| {
            let at = |mask: usize| if mask & bit != 0 { 0 } else { self.0[if set { mask | bit } else { mask }] };
            (0..self.0.len()).map(at).collect()
        };
        [pick(false), pick(true)]
    }

    /// Whether all its coefficients are zero.
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|c| *c == 0)
    }

    /// Its value.
    pub fn at(&self, y: &[f64]) -> f64 {
        let mut fold = self.0.iter().map(|c| *c as f64).collect::<Vec<_>>();
        for value in y {
            let half = fold.len() / 2;
            for j in 0..half {
                fold[j] = fold[2 * j] + value * fold[2 * j + 1];
            }
            fold.truncate(half);
        }
        fold[0]
    }

    /// The same with the variables in another order: the variable at position `v` moves to `to[v]`.
    pub fn reordered(&self, to: &[usize]) -> Self {
        let mut coefficients = vec![0; self.0.len()];
        for (mask, c) in self.0.iter().enumerate() {
            let moved = (0..to.len()).filter(|v| mask >> v & 1 == 1).map(|v| 1 << to[v]).sum::<usize>();
            coefficients[moved] = *c;
        }
        Self(coefficients)
    }
}

/// Whether `a d − b c` vanishes identically: on a grid of three values for each variable, which is enough for a degree of
/// two. The grid is exact in double words.
fn proportional([a, b]: [&[i64]; 2], [c, d]: [&[i64]; 2], variables: usize) -> bool {
    let value = |form: &[i64], point: usize| {
        let mut fold: Vec<i128> = form.iter().map(|x| i128::from(*x)).collect();
        let mut rest = point;
        for _ in 0..variables {
            let y = (rest % 3) as i128;
            rest /= 3;
            let half = fold.len() / 2;
            for j in 0..half {
                fold[j] = fold[2 * j] + y * fold[2 * j + 1];
            }
            fold.truncate(half);
        }
        fold[0]
    };
    (0..3usize.pow(variables as u32)).all(|p| {
        let [a, b, c, d] = [a, b, c, d].map(|f| value(f, p));
        a.checked_mul(d).zip(b.checked_mul(c)).is_some_and(|(x, y)| x == y)
    })
}

impl Quotient {
    /// `numerator/denominator`, with every variable removed on which it does not depend; none where the denominator is
    /// zero.
    pub fn new(mut numerator: Form, mut denominator: Form) -> Option<Self> {
        let variables = numerator.0.len().trailing_zeros() as usize;
        if denominator.is_zero() {
            return None;
        }
        for v in 0..variables {
            let ([n0, n1], [d0, d1]) = (numerator.halves(v), denominator.halves(v));
            if proportional([&n0, &n1], [&d0, &d1], variables) {
                let zero = d0.iter().all(|c| *c == 0);
                (numerator, denominator) = if zero { (Form(n1), Form(d1)) } else { (Form(n0), Form(d0)) };
            }
        }
        let all = numerator.0.iter().chain(&denominator.0);
        let common = all.fold(0i128, |g, x| gcd(g, i128::from(*x))).max(1) as i64;
        for c in numerator.0.iter_mut().chain(&mut denominator.0) {
            *c /= common;
        }
        Some(Self { numerator, denominator })
    }

    /// Whether it depends on a variable.
    pub fn depends_on(&self, variable: usize) -> bool {
        let own = |f: &Form| f.0.iter().enumerate().any(|(mask, c)| mask >> variable & 1 == 1 && *c != 0);
        own(&self.numerator) || own(&self.denominator)
    }

    /// Its value; infinite at a pole.
    pub fn at(&self, y: &[f64]) -> f64 {
        self.numerator.at(y) / self.denominator.at(y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn determinants() {
        assert_eq!(determinant(vec![]), Some(1));
        assert_eq!(determinant(vec![vec![0, 2], vec![3, 5]]), Some(-6));
        assert_eq!(determinant(vec![vec![2, 0, 1], vec![1, 3, 2], vec![1, 1, 4]]), Some(18));
    }

    #[test]
    fn what_is_common_is_removed() {
        // (1 + x)(2 + y) / ((1 + x)(3 + y)): x goes away.
        let q = Quotient::new(Form(vec![2, 2, 1, 1]), Form(vec![3, 3, 1, 1])).unwrap();
        assert!(!q.depends_on(0) && q.depends_on(1));
        assert!((q.at(&[5.0, 1.0]) - 0.75).abs() < 1e-15);
        // x/x is one, also at zero.
        let q = Quotient::new(Form(vec![0, 2]), Form(vec![0, 2])).unwrap();
        assert_eq!(q, Quotient { numerator: Form(vec![1, 0]), denominator: Form(vec![1, 0]) });
    }
}
