fn main() { for f in std::env::args().skip(1) { let t = std::fs::read_to_string(&f).unwrap(); let r = willis::train::Train::read_toml(&t);
 println!("{f}: {} meshes", r.train.as_ref().map_or(0,|t|t.meshes().len())); print!("{}", r.diagnostics.render(&f,&t,false)); } }
