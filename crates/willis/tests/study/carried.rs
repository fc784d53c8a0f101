use crate::common::examples;
use willis::model::Model;
use willis::study::export::{ExportRequest, KINDS, export};
#[test]
fn scratch() {
    for (name, text) in examples() {
        let Ok(model) = Model::from_toml(&text) else {
            eprintln!("skip {name}");
            continue;
        };
        for kind in KINDS.iter().map(|k| k.id) {
            let request = ExportRequest {
                all_states: kind != "modelica" && !model.train().states().is_empty(),
                ..Default::default()
            };
            let t = std::time::Instant::now();
            let out = export(&model, kind, &request);
            let dt = t.elapsed();
            match out {
                Ok(out) => {
                    eprintln!("{name} {kind} {dt:?}: {:?}", out.notes.iter().find(|n| n.starts_with("not carried")))
                }
                Err(e) => eprintln!("{name} {kind} {dt:?} ERR {}", e.iter().next().unwrap().message),
            }
        }
    }
}
