//! A train in the studio: read once, laid out once, shown at many points.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use wasm_bindgen::prelude::wasm_bindgen;
use willis::analysis::{self, Analysis, Selection};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::hypergraph::{FlowReport, flow_of, flows_seen_from};
use willis::kinematics::Configuration;
use willis::model::Model;
use willis::train::{AS_DRAWN, MemberId, State, Train};
use willis_ask::{Attachment, Given, Refusal};
use willis_figure::{
    Columns, LeverLayout, LeverRequest, LeverScale, SankeyPaper, Stick, StickLayout, lever_panel, sankey, stick_panel,
};

use crate::point::{Entries, Point};
use crate::refused;
use crate::surroundings::Browser;

/// A train file with its tables, read and laid out.
#[wasm_bindgen]
pub struct Session {
    name: String,
    files: BTreeMap<String, String>,
    model: Model,
    stick: Result<StickLayout, Diagnostics>,
    lever: Result<LeverLayout, Diagnostics>,
    /// The last point with the train file that it makes.
    shown: Option<(Point, Given, Entries)>,
    /// The schematic that the page has.
    scheme: Option<Scheme>,
    /// Where the flow of power is drawn, kept while something is dragged.
    paper: Option<SankeyPaper>,
    /// Pictures of the levers and of the flow of power that the page has.
    seen: [String; 2],
}

/// A schematic that the page has: it depends on what is closed, and not on speeds and torques.
struct Scheme {
    state: Option<String>,
    engaged: Option<Vec<String>>,
    stick: Stick,
    size: [f64; 2],
}

/// Sizes of the panels, px, and scales that are kept.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Boxes {
    /// The width of schematic and levers.
    pub width: f64,
    /// The height of the schematic; 0 where it is not seen.
    pub stick: f64,
    /// The height of the levers; 0 where they are not seen.
    pub lever: f64,
    /// Width and height of the flow of power; 0 where it is not seen.
    pub power: [f64; 2],
    /// Least and greatest speed of the levers' scale, rad/s, and torque of the longest arrow, N m.
    pub scale: Option<[f64; 3]>,
    /// Which of several equilibria is shown; 0 is the first.
    pub answer: usize,
    /// The member from which powers are seen; else the housing.
    pub seen_from: Option<String>,
    /// How many times wider losses are drawn than power; else as wide as they can be seen.
    pub losses: Option<f64>,
}

/// What all panels show of one point.
#[derive(Clone, Debug, Default)]
#[wasm_bindgen(getter_with_clone)]
pub struct Shown {
    /// The answer to `analyze` of this point, or the refusal, as JSON.
    pub analysis: String,
    /// The operation's name, where there is one.
    pub operation: Option<String>,
    /// The state's name, where there is one.
    pub state: Option<String>,
    /// The schematic as SVG, or a refusal as JSON; empty where it is as it was before, or not seen.
    pub stick: String,
    /// The levers, likewise.
    pub lever: String,
    /// The flow of power, likewise.
    pub power: String,
    /// Columns and scale of the levers, and how many times wider than power losses are drawn, as JSON.
    pub frame: String,
}

#[wasm_bindgen]
impl Session {
    /// Reads a train file. `files` are the tables that it names, as a JSON object of names and texts.
    ///
    /// # Errors
    /// Everything that is wrong with it, as a refusal in JSON.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, text: &str, files: &str) -> Result<Session, String> {
        let files: BTreeMap<String, String> = serde_json::from_str(files).unwrap_or_default();
        let model = read(name, text, &files)?;
        let stick = StickLayout::new(model.train());
        let lever = LeverLayout::new(model.train());
        Ok(Self {
            name: name.to_owned(),
            files,
            model,
            stick,
            lever,
            shown: None,
            scheme: None,
            paper: None,
            seen: Default::default(),
        })
    }

    /// What the page needs to know of the train, as JSON: members, sets, elements, states, operations, quantities.
    pub fn facts(&self) -> String {
        let train = self.model.train();
        let specification = serde_json::to_value(self.model.specification()).unwrap_or_default();
        let name = |m: &willis::train::MemberId| train.member_name(*m).to_owned();
        let end = |state: Option<usize>| train.ends(state).map(|m| m.map(|m| train.member_name(m).to_owned()));
        let state = |(k, s): (usize, &State)| {
            let engaged: Vec<&str> =
                s.engaged.iter().map(|e| train.shift_elements()[e.index()].name.as_str()).collect();
            json!({ "name": s.name, "engaged": engaged, "ends": end(Some(k)) })
        };
        let element = |e: &willis::train::ShiftElement| {
            let members: Vec<String> = e.members.iter().map(name).collect();
            json!({ "name": e.name, "kind": specification_kind(&specification, &e.name), "members": members })
        };
        let quantity = |(path, key): (String, willis::train::Key)| json!({ "path": path, "value": self.model.document().value(&key) });
        // The first member is the frame: it has no colour, and nothing of the page takes hold of it.
        let members: Vec<&str> = train.members()[1..].iter().map(|m| m.name.as_str()).collect();
        json!({
            "name": train.name(),
            "asDrawn": AS_DRAWN,
            "members": members,
            "terminals": train.terminals().iter().map(name).collect::<Vec<_>>(),
            "ends": end(None),
            "states": train.states().iter().enumerate().map(state).collect::<Vec<_>>(),
            "elements": train.shift_elements().iter().map(element).collect::<Vec<_>>(),
            "sets": specification.get("set").cloned().unwrap_or(Value::Array(vec![])),
            "operations": specification.get("operation").cloned().unwrap_or(Value::Array(vec![])),
            "scenarios": train.scenarios().iter().map(|s| s.name.clone()).collect::<Vec<_>>(),
            "sources": sources(&specification),
            "quantities": self.model.document().quantities().into_iter().map(quantity).collect::<Vec<_>>(),
            "warnings": self.model.warnings(),
        })
        .to_string()
    }

    /// What the train is with these elements closed, as JSON: the gear of the shift table, its input and output, members
    /// whose speeds settle all others, and terminals of which a torque is given while the others balance the train. Members
    /// whose speeds are `known` are taken before others; the input is the first of both.
    ///
    /// # Errors
    /// There is no such element, as a refusal in JSON.
    pub fn closed(&self, engaged: Vec<String>, known: Vec<String>) -> Result<String, String> {
        let train = self.model.train();
        let find = |name: &String| train.find_shift_element(name).map_err(|wrong| self.refused((*wrong).into()));
        let mut closed = engaged.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        closed.sort_unstable();
        closed.dedup();
        let is_same = |s: &State| {
            let mut own = s.engaged.clone();
            own.sort_unstable();
            own == closed
        };
        let state = train.states().iter().position(is_same);
        let ends = train.ends(state);
        let [input, output] = ends;
        let all: Vec<MemberId> = train.members()[1..].iter().filter_map(|m| train.member(&m.name)).collect();
        let c = Configuration::new(train, &closed, &[], &all);
        let mut wish: Vec<MemberId> = input.into_iter().chain(train.terminals().iter().copied()).chain(all).collect();
        wish.sort_by_key(|m| !known.iter().any(|name| name == train.member_name(*m)));
        // What moves a train may be no terminal of it, as a machine of a variator.
        let mut terminals = train.terminals().to_vec();
        terminals.sort_by_key(|m| (Some(*m) != input, Some(*m) == output));
        let names = |all: Vec<MemberId>| all.into_iter().map(|m| train.member_name(m)).collect::<Vec<_>>();
        Ok(json!({
            "state": state.map(|k| train.states()[k].name.clone()),
            "ends": ends.map(|m| m.map(|m| train.member_name(m).to_owned())),
            "speeds": names(c.settling(&wish)),
            "torques": names(c.loading(&terminals)),
        })
        .to_string())
    }

    /// The train file with the entries that a point stands for, the text for which the command line gives the same answers.
    ///
    /// # Errors
    /// The point is no JSON of one.
    pub fn text(&self, point: &str) -> Result<String, String> {
        Ok(with_entries(self.model.to_toml(), &parsed::<Point>(point)?.entries(&self.model)))
    }

    /// Shows a point in all panels. A picture that is as it was before is left out.
    ///
    /// # Errors
    /// The point or the boxes are no JSON of such. What is wrong with the train at this point stands in the answer.
    pub fn show(&mut self, point: &str, boxes: &str) -> Result<Shown, String> {
        let mut boxes: Boxes = parsed(boxes)?;
        let at: Point = parsed(point)?;
        let moved = boxes.scale.and_then(|_| at.moved(self.model.train()));
        let (train, state, operation, engaged) = match moved {
            Some((train, operation)) => (train, at.state.clone(), Some(operation), None),
            None => match self.at(point)? {
                Ok(()) => {
                    let (at, given, entries) = self.shown.as_ref().expect("just put there");
                    let train = given.model.train().clone();
                    (train, entries.state.clone(), entries.operation.clone(), at.engaged.clone())
                }
                Err(refusal) => return Ok(Shown { analysis: refusal, ..Shown::default() }),
            },
        };
        let selection = match (&operation, &state) {
            (Some(_), _) => Selection { state: None, operation: operation.clone() },
            (None, _) => Selection { state: state.clone(), operation: None },
        };
        let found = analysis::analyze(&train, &selection);
        let analysis = match &found {
            Ok(analysis) => willis_ask::json(analysis),
            Err(wrong) => self.refused(wrong.clone()),
        };
        let found = found.ok().filter(|a| !a.operations.is_empty());
        // What was chosen of another point may be no answer of this one.
        let answers = found.as_ref().map_or(0, |a| a.operations[0].solutions.len());
        boxes.answer = boxes.answer.min(answers.saturating_sub(1));
        let mut shown = Shown { analysis, operation, state, ..Shown::default() };
        let frame = self.columns(&train, engaged, &boxes, found.as_ref(), &mut shown);
        if boxes.power[0] > 0.0 {
            shown.power = self.power(&train, &selection, found.as_ref(), &boxes);
        }
        shown.frame = match (frame, &self.paper) {
            (Some(mut frame), Some(paper)) => {
                frame["widened"] = paper.widened().into();
                frame.to_string()
            }
            (frame, _) => frame.unwrap_or_default().to_string(),
        };
        for (picture, seen) in [&mut shown.lever, &mut shown.power].into_iter().zip(&mut self.seen) {
            match picture == seen {
                true => picture.clear(),
                false => seen.clone_from(picture),
            }
        }
        Ok(shown)
    }

    /// Answers a question about the train at a point, as JSON.
    ///
    /// # Errors
    /// The refusal as JSON.
    pub fn ask(&mut self, question: &str, request: &str, point: &str) -> Result<String, String> {
        self.at(point)??;
        let (_, given, _) = self.shown.as_ref().expect("just put there");
        answer(given, question, parsed(request)?)
    }

    /// The same in another form: `text`, `csv`, or one of the question's own. A JSON list of files with name and text.
    ///
    /// # Errors
    /// The refusal as JSON.
    pub fn tell(&mut self, question: &str, request: &str, form: &str, point: &str) -> Result<String, String> {
        self.at(point)??;
        let (_, given, _) = self.shown.as_ref().expect("just put there");
        told(given, question, parsed(request)?, form, &self.files)
    }

    /// The train file with another value of a quantity.
    ///
    /// # Errors
    /// The refusal as JSON.
    pub fn set(&self, path: &str, value: &str) -> Result<String, String> {
        self.set_all(vec![path.to_owned()], vec![value.to_owned()])
    }

    /// The same of several quantities at once, such as a ring and the planets that follow it.
    ///
    /// # Errors
    /// The refusal as JSON.
    #[wasm_bindgen(js_name = setAll)]
    pub fn set_all(&self, paths: Vec<String>, values: Vec<String>) -> Result<String, String> {
        let changed = self.model.with(paths.iter().map(String::as_str).zip(values.iter().map(String::as_str)));
        changed.map(|m| m.to_toml().to_owned()).map_err(|wrong| self.refused(wrong))
    }

    /// The train file with two members made one, which has the name of the first.
    ///
    /// # Errors
    /// The refusal as JSON: there is no such member, or the train cannot be then.
    pub fn join(&self, one: &str, other: &str) -> Result<String, String> {
        self.edited(|document| document.join(one, other))
    }

    /// The train file with another name of a member.
    ///
    /// # Errors
    /// The refusal as JSON.
    pub fn rename(&self, from: &str, to: &str) -> Result<String, String> {
        self.edited(|document| document.rename(from, to))
    }

    /// The train file without an entry of a list, such as `set` or `shift_element`; what names it goes with it.
    ///
    /// # Errors
    /// The refusal as JSON.
    pub fn remove(&self, list: &str, name: &str) -> Result<String, String> {
        self.edited(|document| document.remove(list, name))
    }

    /// The train file with a set more, whose members are new.
    ///
    /// # Errors
    /// The refusal as JSON.
    #[wasm_bindgen(js_name = addSet)]
    pub fn add_set(&self, name: &str, sun: u32, ring: u32) -> Result<String, String> {
        self.edited(|document| document.add_set(name, sun, ring))
    }

    /// The train file with a clutch between two members, or a brake on one.
    ///
    /// # Errors
    /// The refusal as JSON.
    #[wasm_bindgen(js_name = addElement)]
    pub fn add_element(&self, name: &str, members: Vec<String>) -> Result<String, String> {
        self.edited(|document| document.add_element(name, &members))
    }

    /// How a scenario presses its elements, as JSON: tables with their knots.
    pub fn ramps(&self, scenario: &str) -> String {
        let ramps = self.model.document().ramps(scenario);
        let all = ramps.iter().map(|r| json!({ "element": r.element, "knots": r.knots }));
        Value::from_iter(all).to_string()
    }

    /// The train file with a knot of such a table moved.
    ///
    /// # Errors
    /// The refusal as JSON.
    #[wasm_bindgen(js_name = setKnot)]
    pub fn set_knot(
        &self,
        scenario: &str,
        element: &str,
        knot: usize,
        time: &str,
        value: &str,
    ) -> Result<String, String> {
        self.edited(|document| document.set_knot(scenario, element, knot, [time, value]))
    }

    /// The train file with a state more.
    ///
    /// # Errors
    /// The refusal as JSON.
    #[wasm_bindgen(js_name = addState)]
    pub fn add_state(&self, name: &str, engaged: Vec<String>) -> Result<String, String> {
        self.edited(|document| document.add_state(name, &engaged))
    }
}

impl Session {
    /// The train file at a point, read unless it is what was shown last. The outer error is about the request, the inner one
    /// about the train.
    fn at(&mut self, point: &str) -> Result<Result<(), String>, String> {
        let point: Point = parsed(point)?;
        if self.shown.as_ref().is_some_and(|s| s.0 == point) {
            return Ok(Ok(()));
        }
        let entries = point.entries(&self.model);
        let given = match entries.text.is_empty() {
            true => Given::new(self.name.clone(), self.model.clone()),
            false => match read(&self.name, &with_entries(self.model.to_toml(), &entries), &self.files) {
                Ok(model) => Given::new(self.name.clone(), model),
                Err(refusal) => return Ok(Err(refusal)),
            },
        };
        self.shown = Some((point, given, entries));
        Ok(Ok(()))
    }

    /// Schematic and levers, and where their columns are.
    fn columns(
        &mut self,
        train: &Train,
        engaged: Option<Vec<String>>,
        boxes: &Boxes,
        found: Option<&Analysis>,
        shown: &mut Shown,
    ) -> Option<Value> {
        let kept = self.scheme.take().filter(|s| s.state == shown.state && s.engaged == engaged);
        let unfit = |wrong: &Diagnostics| self.refused(wrong.clone());
        let stick = match (kept, &self.stick) {
            (Some(kept), _) => Ok((kept.stick, kept.size)),
            (None, Ok(layout)) => {
                layout.show(train, shown.state.as_deref()).map(|s| (s, [0.0; 2])).map_err(|w| unfit(&w))
            }
            (None, Err(wrong)) => Err(unfit(wrong)),
        };
        let request = match (&shown.operation, &shown.state) {
            (Some(operation), _) => LeverRequest::Operation(operation.clone()),
            (None, Some(state)) => LeverRequest::State(state.clone()),
            (None, None) => LeverRequest::First,
        };
        let lever = match &self.lever {
            Ok(layout) => match found {
                Some(found) => layout.show_report(train, &found.operations[0], boxes.answer),
                None => layout.show(train, &request),
            }
            .map_err(|w| unfit(&w)),
            Err(wrong) => Err(unfit(wrong)),
        };
        let ((stick, drawn), lever) = match (stick, lever) {
            (Ok(stick), Ok(lever)) => (stick, lever),
            (stick, lever) => {
                shown.stick = stick.err().unwrap_or_default();
                shown.lever = lever.err().unwrap_or_default();
                return None;
            }
        };
        let columns = Columns::new(&stick, &lever, boxes.width);
        let scale = boxes.scale.map(|[low, high, torque]| LeverScale { speeds: [low, high], torque });
        let scale = scale.unwrap_or_else(|| LeverScale::of(&lever));
        let sets: Vec<Value> =
            columns.all().iter().map(|c| json!({ "name": c.name, "x": c.x, "span": c.span })).collect();
        let frame = json!({
            "width": columns.width,
            "aligned": columns.aligned(),
            "columns": sets,
            "reach": scale.reach(&columns),
            "scale": [scale.speeds[0], scale.speeds[1], scale.torque],
        });
        let size = [boxes.width, boxes.stick];
        if boxes.stick > 0.0 && drawn != size {
            shown.stick = stick_panel(&stick, &columns, boxes.stick);
        }
        if boxes.lever > 0.0 {
            shown.lever = lever_panel(&lever, &columns, boxes.lever, Some(scale));
        }
        self.scheme = Some(Scheme { state: shown.state.clone(), engaged, stick, size });
        Some(frame)
    }

    /// The flow of power of a point. Its scale and columns are kept while something is dragged.
    fn power(&mut self, train: &Train, selection: &Selection, found: Option<&Analysis>, boxes: &Boxes) -> String {
        let asked = || -> Result<FlowReport, Diagnostics> {
            let seen_from = boxes.seen_from.as_deref();
            match found {
                Some(found) => Ok(FlowReport::of(found, vec![flow_of(train, &found.operations[0], seen_from)?])),
                None => flows_seen_from(train, selection, seen_from),
            }
        };
        let flows = match asked() {
            Ok(flows) => flows,
            Err(wrong) => return self.refused(wrong),
        };
        let figure = sankey(&flows);
        let size = boxes.power.map(|x| x.clamp(120.0, 4000.0));
        if boxes.scale.is_none() || self.paper.is_none() {
            let losses = boxes.losses.map(|x| x.clamp(1.0, 50.0));
            self.paper = Some(SankeyPaper::of_panel([&figure], size, losses));
        }
        let drawn = self.paper.as_mut().and_then(|p| p.draw_alone(&figure, boxes.answer, size));
        drawn.unwrap_or_else(|| self.refused(Diagnostic::new(Code::Unfit, "", "no power flows at this point").into()))
    }

    fn refused(&self, wrong: Diagnostics) -> String {
        let of = [Given::new(self.name.clone(), self.model.clone())];
        refused(&Refusal::Wrong(wrong, 0), &of)
    }

    /// The text after an edit; the train must be one then.
    fn edited(
        &self,
        edit: impl FnOnce(&mut willis::train::Document) -> Result<(), Diagnostics>,
    ) -> Result<String, String> {
        let mut document = self.model.document().clone();
        edit(&mut document).map_err(|wrong| self.refused(wrong))?;
        let text = document.text();
        read(&self.name, &text, &self.files)?;
        Ok(text)
    }
}

/// What acts in each scenario, and on which member.
fn sources(specification: &Value) -> Value {
    let list = |of: &Value, key: &str| of.get(key).and_then(Value::as_array).cloned().unwrap_or_default();
    let source = |s: &Value| json!({ "name": s["name"], "member": s["member"] });
    let own = |s: &Value| {
        let name = s["name"].as_str().unwrap_or_default().to_owned();
        (name, Value::from_iter(list(s, "source").iter().map(source)))
    };
    list(specification, "scenario").iter().map(own).collect::<serde_json::Map<_, _>>().into()
}

/// What kind of shift element an entry of the file is.
fn specification_kind(specification: &Value, name: &str) -> Value {
    let all = specification.get("shift_element").and_then(Value::as_array);
    let own = all.into_iter().flatten().find(|e| e["name"] == name);
    own.map_or(Value::Null, |e| e["kind"].clone())
}

/// JSON from the page.
fn parsed<T: serde::de::DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_str(text).map_err(|e| {
        let wrong = Diagnostic::new(Code::WrongType, "", format!("the page asks wrongly: {e}"));
        refused(&wrong.into(), &[])
    })
}

fn read(name: &str, text: &str, files: &BTreeMap<String, String>) -> Result<Model, String> {
    let mut load =
        |file: &str| files.get(file).cloned().ok_or_else(|| "it is not among the files of the page".to_owned());
    Model::read(text, &mut load).map_err(|wrong| {
        let file = Attachment { name: name.to_owned(), text: text.to_owned() };
        refused(&Refusal::File(wrong, file), &[])
    })
}

/// A train file and what follows it.
fn with_entries(text: &str, entries: &Entries) -> String {
    let end = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    format!("{text}{end}{}", entries.text)
}

fn answer(given: &Given, question: &str, request: Value) -> Result<String, String> {
    let all = std::slice::from_ref(given);
    let ask = || -> Result<String, Refusal> {
        let entry = entry(question)?;
        let request = entry.request(request)?;
        let answer = request.ask(asked_of(entry, all), &Browser)?;
        Ok(answer.json())
    };
    ask().map_err(|refusal| refused(&refusal, all))
}

/// A question about Willis itself is asked of no train.
fn asked_of<'g>(entry: &willis_ask::Entry, all: &'g [Given]) -> &'g [Given] {
    if entry.of == willis_ask::Of::Nothing { &[] } else { all }
}

fn told(
    given: &Given,
    question: &str,
    request: Value,
    form: &str,
    files: &BTreeMap<String, String>,
) -> Result<String, String> {
    let all = std::slice::from_ref(given);
    let ask = || -> Result<String, Refusal> {
        let entry = entry(question)?;
        let mut request = entry.request(request)?;
        for (file, _) in request.attachments().into_iter().filter(|(f, _)| f.text.is_empty()) {
            if let Some(text) = files.get(&file.name) {
                file.text = text.clone();
            }
        }
        let answer = request.ask(asked_of(entry, all), &Browser)?;
        let one = |name: String, text: String| json!([{ "name": name, "text": text }]);
        let files = match form {
            "json" => one(format!("{question}.json"), answer.json()),
            // A picture and its data, for a page that has handles on it.
            "svg+json" => {
                let mut all = one(format!("{question}.json"), answer.json());
                let svg =
                    answer.write("svg")?.into_iter().next().map(|f| String::from_utf8_lossy(&f.bytes).into_owned());
                all.as_array_mut()
                    .expect("a list")
                    .insert(0, json!({ "name": format!("{question}.svg"), "text": svg }));
                all
            }
            "text" => one(format!("{question}.txt"), willis_ask::style::plain(&answer.text())),
            "csv" => one(format!("{question}.csv"), willis_ask::table::csv(&answer.tables())),
            other => {
                let file = |f: willis_ask::File| json!({ "name": f.name, "text": String::from_utf8_lossy(&f.bytes) });
                answer.write(other)?.into_iter().map(file).collect()
            }
        };
        Ok(files.to_string())
    };
    ask().map_err(|refusal| refused(&refusal, all))
}

fn entry(question: &str) -> Result<&'static willis_ask::Entry, Refusal> {
    willis_ask::question(question)
        .ok_or_else(|| Diagnostic::new(Code::UnknownSelection, "", format!("there is no question `{question}`")).into())
}
