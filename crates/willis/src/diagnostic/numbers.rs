//! Numbers in messages.

/// Two numbers that differ, each as `shown` writes it, or with as many digits as tell them apart.
pub(crate) fn apart(a: f64, b: f64, shown: impl Fn(f64) -> String) -> [String; 2] {
    let texts = [shown(a), shown(b)];
    if texts[0] != texts[1] || a == b {
        return texts;
    }
    // One digit more than the first that differs.
    let digits = (1..17).find(|&d| format!("{a:.d$e}") != format!("{b:.d$e}")).unwrap_or(16) + 1;
    let decimals = (digits as i32 - a.abs().max(b.abs()).log10().floor() as i32).clamp(0, 300) as usize;
    [a, b].map(|x| format!("{x:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn numbers_that_differ_are_written_so() {
        let shown = |x: f64| format!("{x:.4}");
        assert_eq!(apart(300.0, 301.0, shown), ["300.0000", "301.0000"]);
        for (a, b) in [
            (2894.1176, 2894.1176 * (1.0 + 2e-9)),
            (1.0, 1.0 + f64::EPSILON),
            (-0.03, -0.030000001),
            (1e300, 1e300 * (1.0 + 1e-12)),
        ] {
            let [x, y] = apart(a, b, shown);
            assert_ne!(x, y);
        }
    }
}
