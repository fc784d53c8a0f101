use willis::dynamics::*;
struct R;
impl Recorder for R {
    fn event(&mut self, e: &Event) -> std::ops::ControlFlow<()> { println!("{:.15} {} {:?}", e.time_s, e.cause, e.modes); std::ops::ControlFlow::Continue(()) }
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let train = willis::Train::from_toml(&text).unwrap_or_else(|d| panic!("{d}"));
    let name = train.scenarios()[0].name.clone();
    let mut o = Options::default();
    if let Some(t) = a.get(2) { o.tolerance = t.parse().unwrap(); }
    let now = std::time::Instant::now();
    let r = simulate(&train, &name, &o, &mut R).unwrap_or_else(|d| panic!("{d}"));
    println!("{r:#?} {:?}", now.elapsed());
}
