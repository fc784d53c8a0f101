use super::equations::Equations;
pub(super) fn is_unique(_: &Equations) -> bool {
    true
}
