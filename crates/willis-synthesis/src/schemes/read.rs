//! The layout of a train file.

use willis::Train;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::train::{MemberId, MemberKind, Mesh};

use super::layout::{GROUND, INPUT, Layout, MAX_SETS, OUTPUT};
use super::wish::SetRatio;

impl Layout {
    /// The permanent connections of a train with the tooth ratio of every set; clutches and brakes are not looked at.
    ///
    /// # Errors
    /// Everything in the train that no layout can say: sets of other types, gear pairs, variators, elastic shafts, shafts
    /// that carry no member of a set, or no input and output.
    ///
    /// # Example
    /// ```
    /// use willis::train::{SetSpec, Train};
    /// use willis_synthesis::schemes::Layout;
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["in", "out"])
    ///     .terminals(["in", "out"])
    ///     .set(SetSpec::simple("P1", ("in", 30), ("frame", 70), "out"))
    ///     .build()?;
    /// let (layout, sets) = Layout::of_train(&train)?;
    /// // Sun 1 is the input, ring 1 the housing, carrier 1 the output.
    /// assert_eq!((layout.to_string().as_str(), sets[0].to_string().as_str()), ("021", "70/30"));
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn of_train(train: &Train) -> Result<(Self, Vec<SetRatio>), Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut say = |message: String, hint: &str| {
            wrong.push(Diagnostic::new(Code::Unfit, "", message).hint(hint));
        };
        const ONLY: &str = "a layout is made of simple sets alone: sun, planet, ring and carrier";
        let sets = train.sets();
        if !(1..=MAX_SETS).contains(&sets.len()) {
            say(format!("the train has {} sets", sets.len()), "a layout has one to five simple sets");
        }
        for set in sets.iter().filter(|s| s.kind != "simple") {
            say(format!("set `{}` is of type {}", set.name, set.kind), ONLY);
        }
        for mesh in train.meshes().iter().filter(|m| m.set.is_none()) {
            say(format!("the gear pair `{}` belongs to no set", mesh.name), ONLY);
        }
        for variator in train.variators() {
            let hint = "search the elements of the gears without the variator, or ask with --hybrid";
            say(format!("the train has the variator `{}`", variator.name), hint);
        }
        for shaft in train.shafts() {
            let hint = "write the members that it joins as one";
            say(format!("the shaft `{}` is elastic and joins members that turn differently", shaft.name), hint);
        }
        let ends = [train.input(), train.output()];
        if ends.contains(&None) {
            say("the train has no input and output".into(), "name both in `terminals`");
        }
        // The shafts in the order in which numbers are given; what is found of every set.
        let mut shafts: Vec<MemberId> = vec![];
        let mut blocks = vec![];
        let mut ratios = vec![];
        for (number, set) in sets.iter().enumerate().filter(|(_, s)| s.kind == "simple") {
            let own: Vec<&Mesh> = train.meshes().iter().filter(|m| m.set == Some(number)).collect();
            let Some(SunRingCarrier { sun, ring, carrier }) = members(train, &own) else {
                say(format!("set `{}` has no sun, ring and carrier", set.name), ONLY);
                continue;
            };
            for member in [sun.0, ring.0, carrier] {
                let is_frame = train.members()[member.index()].kind == MemberKind::Frame;
                let fixed = [(Some(member) == ends[0], INPUT), (Some(member) == ends[1], OUTPUT), (is_frame, GROUND)];
                blocks.push(fixed.iter().find(|(is, _)| *is).map_or_else(
                    || {
                        let known = shafts.iter().position(|s| *s == member);
                        3 + known.unwrap_or_else(|| {
                            shafts.push(member);
                            shafts.len() - 1
                        }) as u8
                    },
                    |(_, block)| *block,
                ));
            }
            match format!("{}/{}", ring.1, sun.1).parse::<SetRatio>() {
                Ok(ratio) => ratios.push(ratio),
                Err(why) => say(format!("set `{}`: {why}", set.name), "give teeth of sun and ring"),
            }
        }
        for (k, member) in train.members().iter().enumerate().filter(|(_, m)| m.kind == MemberKind::Shaft) {
            let is_end = ends.iter().flatten().any(|e| e.index() == k);
            if !is_end && wrong.is_empty() && !shafts.iter().any(|s| s.index() == k) {
                let message = format!("`{}` carries no sun, ring or carrier", member.name);
                let hint = "a shaft of a layout carries a member of a set, or it is input or output; leave it out";
                wrong.push(Diagnostic::new(Code::Unfit, "", message).hint(hint));
            }
        }
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let layout = Self::new(&blocks).map_err(|why| {
            Diagnostics::from(Diagnostic::new(Code::Unfit, "", format!("the train is no layout: {why}")).hint(ONLY))
        })?;
        Ok((layout, ratios))
    }
}

/// A central gear: its member and its teeth.
type Toothed = (MemberId, String);

/// What a simple set joins.
struct SunRingCarrier {
    sun: Toothed,
    ring: Toothed,
    carrier: MemberId,
}

/// Sun and ring with their teeth, and the carrier, of the meshes of a simple set.
fn members(train: &Train, meshes: &[&Mesh]) -> Option<SunRingCarrier> {
    let is_planet = |m: MemberId| train.members()[m.index()].kind == MemberKind::Planet;
    let central = |internal: bool| -> Option<Toothed> {
        let mut all = meshes.iter().flat_map(|m| &m.gears).filter(|g| !is_planet(g.member) && g.internal == internal);
        let gear = all.next().filter(|_| all.next().is_none())?;
        Some((gear.member, gear.teeth.to_string()))
    };
    Some(SunRingCarrier { sun: central(false)?, ring: central(true)?, carrier: meshes.first()?.carrier })
}
