//! The question `design`: parts of a search are the whole, rows are trains, what is wrong is said.

use serde_json::{Value, json};
use willis::work::{Serial, Work};
use willis_ask::{Answer, Entry, Given, Refusal, Request};

fn design() -> &'static Entry {
    willis_ask::question("design").unwrap()
}

fn joint() -> Value {
    let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/design/joint.toml"));
    json!({ "name": "joint.toml", "text": text })
}

fn answer(request: Value) -> Box<dyn Answer + Send + Sync> {
    let request = design().request(request).unwrap();
    request.ask_for_good(std::sync::Arc::new([]), &Serial).unwrap()
}

fn refused(request: Value) -> Refusal {
    let request = design().request(request).unwrap();
    request.ask(&[], &Serial).err().unwrap_or_else(|| panic!("{} was answered", request.to_json()))
}

fn progress(request: Value) -> String {
    String::from_utf8(answer(request).extra("progress").unwrap().remove(0).bytes).unwrap()
}

#[test]
fn parts_are_the_whole_bit_for_bit() {
    let whole = answer(json!({ "file": joint() })).json();
    let part = |k: &str| json!({ "name": k, "text": progress(json!({ "file": joint(), "shard": k })) });
    let parts = ["2/3", "1/3", "3/3"].map(part);
    assert_eq!(answer(json!({ "file": joint(), "resume": parts })).json(), whole);
    // What is missing is searched.
    assert_eq!(answer(json!({ "file": joint(), "resume": [part("3/5")] })).json(), whole);
    // Pieces of other machines.
    let request: Box<dyn Request> = design().request(json!({ "file": joint() })).unwrap();
    let pieces: Vec<Vec<u8>> = (0..4).map(|k| request.piece(&[], k, 4, &Serial).unwrap()).collect();
    let of: std::sync::Arc<[Given]> = std::sync::Arc::new([]);
    assert_eq!(request.gather(of.clone(), &pieces).unwrap().json(), whole);
    assert!(request.gather(of, &[pieces[0].clone(), pieces[0].clone()]).is_err());
}

#[test]
fn rows_are_written_as_trains() {
    let two = answer(json!({ "file": joint(), "write": [1, 3] })).write("train").unwrap();
    assert_eq!(two.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["design-1.toml", "design-3.toml"]);
    for file in two {
        let given = Given::read(&file.name, std::str::from_utf8(&file.bytes).unwrap()).unwrap();
        let request = willis_ask::question("analyze").unwrap().request(json!({})).unwrap();
        assert!(request.ask(&[given], &Serial).unwrap().text().contains("sun → ring"));
    }
    // More rows than are shown by default.
    let many = json!({ "kind": "3k", "ratio": "90..110", "all": true, "write": [40] });
    assert_eq!(answer(many).write("train").unwrap()[0].name, "design-40.toml");
    // The design file that options stand for is one.
    let start = answer(json!({ "kind": "3k", "ratio": "100" }));
    let file = start.write("design-file").unwrap().remove(0);
    let again = json!({ "file": { "name": "d", "text": String::from_utf8(file.bytes).unwrap() } });
    assert_eq!(answer(again).json(), start.json());
}

/// By its teeth a row is the same train file, and nothing is searched for it.
#[test]
fn teeth_are_written_without_a_search() {
    let searched = answer(json!({ "file": joint(), "write": [2] })).write("train").unwrap().remove(0).bytes;
    let given = answer(json!({ "file": joint(), "teeth": ["12/41/93/35/87"] }));
    assert_eq!(given.write("train").unwrap().remove(0).bytes, searched);
    assert!(given.text().contains("nothing was searched") && !given.is_partial());
    let request = design().request(json!({ "file": joint(), "teeth": ["12/41/93/35/87"] })).unwrap();
    let pieces: Vec<Vec<u8>> = (0..2).map(|k| request.piece(&[], k, 2, &Serial).unwrap()).collect();
    assert_eq!(request.gather(std::sync::Arc::new([]), &pieces).unwrap().json(), given.json());
    for (teeth, says) in [
        (json!(["12/41/93/35"]), "is not the teeth of set `P1`"),
        (json!(["12/41/93/35/x"]), "is not the teeth of set `P1`"),
        (json!(["12/41/93/35/0"]), "is not the teeth of set `P1`"),
        (json!(["12/41/93/35/87", "1/2/3"]), "teeth of 2 sets are given, but 1 set is designed"),
        (json!(["12/41/93/35/99"]), "are not in the space"),
        (json!(["11/41/92/35/86"]), "are not in the space"),
    ] {
        let text = refused(json!({ "file": joint(), "teeth": teeth })).render(&[], false);
        assert!(text.contains(says), "{teeth}: {text}");
    }
    let both = design().request(json!({ "file": joint(), "teeth": ["12/41/93/35/87"], "write": [1] }));
    assert!(both.is_err() || both.unwrap().ask(&[], &Serial).is_err());
}

/// Laws of friction rank where the file has them, and the words say which losses did.
#[test]
fn what_ranked_is_said() {
    // Lines are broken where they end.
    let flat = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let text = flat(answer(json!({ "file": joint() })).text());
    assert!(text.contains("Efficiencies that rank: the mesh efficiencies of the file"), "{text}");
    let lawful = joint()["text"].as_str().unwrap().replace(
        "mesh_efficiency = { external = 0.98, internal = 0.99 }",
        "geometry = { module = \"0.8 mm\", width = \"8 mm\", roughness = \"0.8 um\" }\n\
         [[operation]]\nname = \"lift\"\nspeeds = { sun = \"3000 rpm\" }\ntorques = { sun = \"0.1 N m\" }\n",
    );
    let lawful = json!({ "name": "lawful.toml", "text": lawful });
    let answered = answer(json!({ "file": lawful }));
    let (text, report) = (flat(answered.text()), serde_json::from_str::<Value>(&answered.json()).unwrap());
    assert_eq!((&report["ranked_by"]["by"], &report["ranked_by"]["recomputed"]), (&json!("laws"), &json!("all")));
    assert!(text.contains("under the laws of friction") && text.contains("by laws"), "{text}");
    assert!(report["rows"][0]["laws"]["forward"].as_f64().unwrap() < 1.0);
}

#[test]
fn what_was_stopped_says_how_far_it_came() {
    struct Stops;
    impl Work for Stops {
        fn cancelled(&self) -> bool {
            true
        }
        fn run(&self, _: usize, _: &(dyn Fn(usize) + Sync)) {}
    }
    let request = design().request(json!({ "file": joint() })).unwrap();
    let answer = request.ask(&[], &Stops).unwrap();
    assert!(answer.is_partial() && answer.text().contains("0.0 % of the space is done"), "{}", answer.text());
}

#[test]
fn rows_that_were_stopped_are_missing_and_the_counts_stay() {
    /// Does everything but what is cut into few parts: the rows.
    struct Few;
    impl Work for Few {
        fn cancelled(&self) -> bool {
            true
        }
        fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
            if parts > 20 {
                (0..parts).for_each(job);
            }
        }
    }
    for all in [false, true] {
        let request = design().request(json!({ "file": joint(), "all": all })).unwrap();
        let answer = request.ask(&[], &Few).unwrap();
        let report: Value = serde_json::from_str(&answer.json()).unwrap();
        let told = report["completeness"]["statement"].as_str().unwrap();
        assert!(answer.is_partial() && told.contains("Rows are missing"), "{told}");
        assert_eq!((&report["rows"], &report["waterfall"][0]["trains"]), (&json!([]), &json!(1064)));
    }
}

#[test]
fn an_empty_answer_says_what_must_give() {
    let text = answer(json!({ "kind": "3k", "ratio": "100", "ring": "20mm", "module": ["0.5mm"] })).text();
    assert!(text.contains("must give: ") && text.contains("0 sets of tooth numbers satisfy"), "{text}");
    assert!(
        answer(json!({ "kind": "3k", "ratio": "100", "ring": "20mm", "module": ["0.5mm"] })).extra("plot").is_err()
    );
}

#[test]
fn what_is_wrong_is_said() {
    let file = |text: &str| json!({ "file": { "name": "mine.toml", "text": text } });
    let joint_with = |a: &str, b: &str| {
        let text = joint()["text"].as_str().unwrap().replace(a, b);
        json!({ "file": { "name": "mine.toml", "text": text } })
    };
    let resumed = |text: &str| json!({ "file": joint(), "resume": [{ "name": "p.json", "text": text }] });
    let good = progress(json!({ "file": joint(), "shard": "1/2" }));
    for (request, says) in [
        (json!({}), "nothing says what is to be designed"),
        (json!({ "kind": "4k", "ratio": "3" }), "there is no kind of drive `4k`"),
        (json!({ "kind": "3k", "ratio": "100", "ring": "90" }), "the unit is missing"),
        (json!({ "kind": "3k", "ratio": "100", "planets": "none" }), "design.planets"),
        (json!({ "kind": "3k", "ratio": "100", "backward": "1.2" }), "no efficiency is above 1"),
        (json!({ "kind": "3k", "ratio": "100", "module": ["-1 mm"] }), "must be above 0"),
        (json!({ "file": joint(), "sort": "cheapest" }), "nothing that a design is judged by"),
        (json!({ "file": joint(), "shard": "0/3" }), "no part 0 of 3"),
        (json!({ "file": joint(), "write": [0] }), "counted from 1"),
        (file(""), "no ratio is asked for"),
        (file("[design"), "mine.toml"),
        (joint_with("\"12..60\"", "\"60..12\""), "60..12"),
        (joint_with("\"..120\"", "\"..12000000000\""), "12000000000"),
        (joint_with("ratio = [99, 101]", "ratio = [101, 99]"), "the window from 101 to 99 is empty"),
        (joint_with("\"hunting\"", "\"huntin\""), "there is no rule `huntin`"),
        (joint_with("any_sign", "state = \"9\", any_sign"), "no state `9`"),
        (joint_with("0.8 mm", "0.8"), "the unit is missing"),
        (resumed("{}"), "is not the progress of a search"),
        (resumed("[1, 2"), "is not the progress of a search"),
        (resumed(&good.replace("P1", "P2")), "another design"),
        (resumed(&good.replacen("[[", "[[-1,", 1)), "progress"),
        (resumed(&good.replacen("\"front\":[[[", "\"front\":[[[9,", 1)), "was not written by a search"),
        (json!({ "like": { "name": "l", "text": "x" } }), "l"),
        (json!({ "file": joint(), "like": { "name": "l", "text": "format = 1" } }), "members"),
    ] {
        let refusal = refused(request.clone());
        let text = refusal.render(&[], false);
        assert!(text.contains(says), "{request}: {text}");
    }
    let rows = answer(json!({ "file": joint(), "write": [9] })).write("train").unwrap_err();
    assert!(rows.to_string().contains("there is no row 9"));
}
