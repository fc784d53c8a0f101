//! Linear inequalities, exactly: is there a point, and how large can a sum be?

use super::Rational;

/// `x ≥ 0` over equations, at a vertex.
#[derive(Clone, Debug)]
pub(crate) struct Polyhedron {
    /// Coefficients over all unknowns, and the right side, which is the value of the basic one.
    rows: Vec<Vec<Rational>>,
    basis: Vec<usize>,
    /// Unknowns that are zero.
    pub banned: Vec<bool>,
}

impl Polyhedron {
    /// From equations with their right sides last; none if it is empty.
    pub fn new(mut rows: Vec<Vec<Rational>>, unknowns: usize) -> Option<Self> {
        let m = rows.len();
        for (i, row) in rows.iter_mut().enumerate() {
            let right = row.pop().expect("a right side");
            if right.sign() < 0 {
                row.iter_mut().for_each(|x| *x = -&*x);
            }
            row.extend((0..m).map(|k| if k == i { Rational::ONE } else { Rational::ZERO }));
            row.push(right.abs());
        }
        let basis = (unknowns..unknowns + m).collect();
        let mut start = Self { rows, basis, banned: vec![false; unknowns + m] };
        if !(unknowns..unknowns + m).all(|artificial| start.ban(artificial)) {
            return None;
        }
        // Equations that follow from the others say nothing.
        let (basis, rows) = std::mem::take(&mut start.basis)
            .into_iter()
            .zip(std::mem::take(&mut start.rows))
            .filter(|(basic, _)| *basic < unknowns)
            .unzip();
        (start.basis, start.rows) = (basis, rows);
        for row in &mut start.rows {
            row.drain(unknowns..unknowns + m);
        }
        Some(start)
    }

    /// How many numbers it is made of.
    pub fn size(&self) -> usize {
        self.rows.iter().map(Vec::len).sum()
    }

    fn value(&self, row: usize) -> &Rational {
        self.rows[row].last().expect("a right side")
    }

    fn pivot(&mut self, at: usize, unknown: usize) {
        let inverse = self.rows[at][unknown].recip();
        self.rows[at].iter_mut().filter(|x| !x.is_zero()).for_each(|x| *x = &*x * &inverse);
        let top = std::mem::take(&mut self.rows[at]);
        for row in self.rows.iter_mut().filter(|row| !row.is_empty() && !row[unknown].is_zero()) {
            let factor = row[unknown].clone();
            for (x, t) in row.iter_mut().zip(&top).filter(|(_, t)| !t.is_zero()) {
                *x = &*x - &(&factor * t);
            }
        }
        self.rows[at] = top;
        self.basis[at] = unknown;
    }

    /// The row that an unknown meets first; `preferred` if it is among several.
    fn blocking(&self, unknown: usize, preferred: Option<usize>) -> Option<usize> {
        let rows = (0..self.rows.len()).filter(|&i| self.rows[i][unknown].sign() > 0);
        let ratio = |i: usize| self.value(i) / &self.rows[i][unknown];
        rows.map(|i| (ratio(i), preferred != Some(i), self.basis[i], i)).min().map(|(.., i)| i)
    }

    /// Makes an unknown zero for good. False if it cannot be.
    pub fn ban(&mut self, unknown: usize) -> bool {
        self.banned[unknown] = true;
        while let Some(at) = self.basis.iter().position(|&j| j == unknown) {
            let open = |j: &usize| !self.banned[*j];
            let columns = self.rows[at].len() - 1;
            // Bland's rule: the first that helps. It ends.
            match (0..columns).filter(open).find(|&j| self.rows[at][j].sign() > 0) {
                Some(j) => {
                    let leaving = self.blocking(j, Some(at)).expect("this row at least");
                    self.pivot(leaving, j);
                }
                None if !self.value(at).is_zero() => return false,
                None => match (0..columns).filter(open).find(|&j| !self.rows[at][j].is_zero()) {
                    Some(j) => self.pivot(at, j),
                    // Nothing moves it.
                    None => return true,
                },
            }
        }
        true
    }

    /// Raises a sum over the unknowns until it is beyond a limit, or no more. `Ok` with its largest value; `Err` where it
    /// went beyond the limit, or grows without end.
    fn raise(&mut self, of: &[Rational], limit: Option<&Rational>) -> Result<Rational, ()> {
        loop {
            let mut reduced = of.to_vec();
            let mut value = Rational::ZERO;
            for (i, &j) in self.basis.iter().enumerate().filter(|(_, j)| !of[**j].is_zero()) {
                value += &of[j] * self.value(i);
                for (r, x) in reduced.iter_mut().zip(&self.rows[i]).filter(|(_, x)| !x.is_zero()) {
                    *r = &*r - &(&of[j] * x);
                }
            }
            if limit.is_some_and(|limit| value > *limit) {
                return Err(());
            }
            let rises = |j: &usize| !self.banned[*j] && reduced[*j].sign() > 0 && !self.basis.contains(j);
            let Some(j) = (0..reduced.len()).find(rises) else { return Ok(value) };
            let at = self.blocking(j, None).ok_or(())?;
            self.pivot(at, j);
        }
    }

    /// Whether a sum over the unknowns can be beyond `limit`; then the vertex is one from which it grows beyond.
    pub fn exceeds(&mut self, of: &[Rational], limit: &Rational) -> bool {
        self.raise(of, Some(limit)).is_err()
    }

    /// The largest value of a sum over the unknowns, and the vertex is where it has it; none where it grows without end.
    pub fn maximum(&mut self, of: &[Rational]) -> Option<Rational> {
        self.raise(of, None).ok()
    }

    /// The vertex: values of the first `unknowns`.
    pub fn point(&self, unknowns: usize) -> Vec<Rational> {
        let mut x = vec![Rational::ZERO; unknowns];
        for (i, &j) in self.basis.iter().enumerate().filter(|(_, j)| **j < unknowns) {
            x[j] = self.value(i).clone();
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&[i64]]) -> Vec<Vec<Rational>> {
        rows.iter().map(|r| r.iter().map(|x| Rational::from(*x)).collect()).collect()
    }

    #[test]
    fn largest_values_and_vertices() {
        // x + y + s = 4, x − y + t = 1.
        let mut p = Polyhedron::new(of(&[&[1, 1, 1, 0, 4], &[1, -1, 0, 1, 1]]), 4).expect("not empty");
        assert_eq!(p.maximum(&of(&[&[2, 1, 0, 0]])[0]), Some(Rational::new(13, 2)));
        assert_eq!(p.point(2), [Rational::new(5, 2), Rational::new(3, 2)]);
        assert_eq!(p.maximum(&of(&[&[-1, 0, 0, 0]])[0]), Some(Rational::ZERO));
    }

    #[test]
    fn equations_that_follow_from_others_say_nothing() {
        let rows = [&[1, -1, 2][..], &[2, -2, 4], &[-1, 1, -2]];
        let mut p = Polyhedron::new(of(&rows), 2).expect("not empty");
        assert_eq!(p.maximum(&of(&[&[0, 1]])[0]), None, "it grows without end");
        assert_eq!(p.maximum(&of(&[&[-1, 0]])[0]), Some(Rational::from(-2)));
        assert_eq!(p.point(2), [Rational::from(2), Rational::ZERO]);
        let contradicting = [&[1, -1, 2][..], &[2, -2, 3]];
        assert!(Polyhedron::new(of(&contradicting), 2).is_none());
        assert!(Polyhedron::new(of(&[&[1, 1, -1]]), 2).is_none());
    }
}
