//! Every code there is. A code is never reused for something else.

use std::borrow::Cow;
use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, Unexpected};
use serde::ser::{Serialize, Serializer};

use super::Severity;

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $code:ident $name:ident: $title:literal;)+) => {
        /// A stable diagnostic code: `E…` an error in the input, `W…` a warning, `N…` a note.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $($(#[doc = $doc])+ $name,)+
        }

        impl Code {
            /// Every code, in order.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// The code as it is printed, `E101`.
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$name => stringify!($code)),+ }
            }

            /// One line that names the matter.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$name => $title),+ }
            }

            /// What it means, why it matters and what to do.
            pub const fn explanation(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc, "\n"),+)),+ }
            }
        }
    };
}

codes! {
    /// The text is not TOML. The message is the TOML reader's own and stands at the place where
    /// reading stopped. A frequent cause: a name with a dot or a blank needs quotes, as in
    /// `speeds = { "P1.planet" = "10 rpm" }`.
    E001 Syntax: "the file is not valid TOML";
    /// The file, or one that it names, could not be read at all: it does not exist, is a directory,
    /// may not be read, is larger than 4 MiB (64 MiB for tables), or is not text in UTF-8.
    E002 Unreadable: "the file cannot be read";
    /// Every train file says which format it is written in: `format = 1`. The number changes only
    /// when an old file would be read differently.
    E003 Format: "the format number is missing or unknown";
    /// This table has no key of that name. Keys are never ignored: a misspelt
    /// one would silently drop a value. `willis schema` prints every key there is.
    E004 UnknownKey: "unknown key";
    /// This key has no default: add it.
    E005 MissingKey: "a required key is missing";
    /// The value is of another kind than the key takes, a text where a list belongs for example.
    E006 WrongType: "value of the wrong kind";
    /// A quantity is a text of a number and a unit, `"1450 rpm"`, `"350 N m"`, `"75 kW"`. A bare
    /// number is refused because a reader cannot know whether it is in rad/s or in rpm. NaN, infinities,
    /// unknown units and units of another kind of quantity are refused too.
    E007 Quantity: "not a quantity with a suitable unit";
    /// A number lies outside what is possible or sensible: tooth counts are integers from 1 to
    /// 100000, counts of planets or meshes from 1 to 1000, an efficiency is above 0 and at
    /// most 1.
    E008 OutOfRange: "number out of range";
    /// Nothing has this name. Members, shift elements and states are found by the
    /// exact name, upper and lower case included; `frame` always exists.
    E101 UnknownName: "unknown name";
    /// Two things of one kind have the same name, so that a reference could mean either: rename one of them.
    E102 DuplicateName: "name used twice";
    /// A name is empty, longer than 64 characters, contains a dot, or is the reserved word `frame`. (The
    /// dot separates a set from its planet in `P1.planet`.) Or it has a character that cannot be
    /// shown: a control character, one that turns the direction of writing, or a code point that is
    /// no character.
    E103 BadName: "name not allowed";
    /// The parts of a mesh or set do not make a pair of gears on a carrier: a gear meshes with
    /// itself, a gear is its own carrier, or both gears are internal.
    E104 ImpossibleMesh: "these parts cannot mesh";
    /// Each type of set has its own parts. `simple`: `sun`, `ring`, `planet`. `double-planet`: `sun`, `ring`,
    /// `inner_planet`, `outer_planet`. `stepped`: `suns`, `rings`, `planet`. `ravigneaux`: `small_sun`, `large_sun`,
    /// `ring`, `short_planet`, `long_planet`. `bevel`: `sides`, `planet`. Planets may be left out.
    E105 IncompleteSet: "the parts of a set do not make that type of set";
    /// Sun and ring of a simple set lie on one axis, so unshifted gears need
    /// `z_ring = z_sun + 2 z_planet`. Profile shift closes a difference of one or two teeth (a
    /// warning, W301); more than that is a typing error or another type of set.
    E106 NotCoaxial: "the gears of this set do not lie on one axis";
    /// A clutch joins two different members, a brake holds one, a one-way clutch has one or two.
    E107 ShiftElement: "a shift element joins the wrong members";
    /// A train beyond 128 meshes, 1024 members or shift elements, 256 states, 4096 operations or 256 scenarios is refused,
    /// so that time and memory stay bounded.
    E108 TooLarge: "the train is too large";
    /// Give only one of these keys: both set the same quantity, or one excludes the other.
    E109 Conflict: "these keys exclude each other";
    /// The teeth described cannot exist: the tip lies inside the base circle, the tooth is pointed,
    /// the centre distance leaves no contact, the planets of one set would need axes on different
    /// circles. The message has the numbers.
    E110 ImpossibleGeometry: "these teeth cannot exist";
    /// The dimensions of a bearing exclude each other or do not fit its shaft.
    E111 ImpossibleBearing: "the bearing cannot be built or does not fit";
    /// A table of points is empty, its first column does not rise, or a CSV file that a signal names
    /// has no such column, an empty cell or a cell that is no finite number. Points of a curve lie
    /// at different abscissae; in a signal two points of the same time are a jump. A CSV file has a
    /// header row, commas between columns, decimal points, and values in SI units. A profile of a
    /// duty cycle names the units in its header, `input.speed [rpm]`, has one column that weighs the
    /// rows in time, and its times rise.
    E112 BadTable: "a table of values cannot be used";
    /// A formula cannot be read, or uses a name that is neither the time `t` nor the speed of a
    /// member, `w_sun`. Names with other characters than letters, digits and `_` stand in braces:
    /// `{w_P1.planet}`. Its value is in SI units: N m, rad/s.
    E113 BadFormula: "a formula cannot be used";
    /// A variator joins two different members and has one efficiency (or one for each direction), or it has machines on a
    /// bus, each with a member and an efficiency of its own, and perhaps a store. `ratio` belongs to the former, `store`
    /// and `standby` to the latter. Limits are positive, and the least ratio is not above the greatest.
    E114 Variator: "a variator cannot be built";
    /// The prescribed speeds cannot all hold: the gears already tie some of them together. Give
    /// as many independent speeds as the train has degrees of freedom.
    E201 ContradictorySpeeds: "the prescribed speeds contradict each other";
    /// The torques cannot be found from what is given. As many terminals as there are degrees of
    /// freedom are left to balance the train; every other terminal needs a torque or a power
    /// (`"0 N m"` when nothing acts on it).
    E202 MissingTorque: "a torque or power is missing";
    /// Too many torques are prescribed: with every terminal loaded nothing is left to balance the
    /// train, and equilibrium would hold only by chance. Leave as many terminals open as there
    /// are degrees of freedom.
    E203 TooManyTorques: "too many torques are prescribed";
    /// An external torque is given on a member that is not a terminal. List it in `terminals`.
    E204 NotATerminal: "a torque acts on a member that is no terminal";
    /// A member is held and at the same time driven, loaded, or asked for twice.
    E205 HeldAndDriven: "a member is held and driven at once";
    /// At zero speed the power of any torque is zero. Prescribe a torque instead, or let the member turn.
    E206 PowerAtRest: "a power is given on a member at rest";
    /// The state or operation asked for is not in the file.
    E207 UnknownSelection: "there is no such state or operation";
    /// The question is for another kind of train: a table over all basic ratios needs one set with
    /// three terminals, a regime map two degrees of freedom and one independent torque, an
    /// operating point as many speeds and torques as are independent.
    E208 Unfit: "the question does not fit this train";
    /// In a simulation torques become accelerations by inertia. Some members can move together, along the
    /// gears, without any of them having a moment of inertia, and without a shaft, a damper or a slipping clutch that
    /// they could follow, so that no acceleration follows. Give one of them an inertia in `[inertias]`, prescribe a speed,
    /// or hold one of them.
    E209 NoInertia: "inertia is missing";
    /// An axis of a study is a quantity and its values, `input.speed=500 rpm..12000 rpm:100`. Ranges run upwards, say how
    /// many values they have or how far apart, and are written in a unit of the quantity.
    E210 BadAxis: "the values of an axis cannot be used";
    /// A long computation was told to stop before it was done, by Ctrl-C for example. Nothing is wrong with the question:
    /// asked again, it begins anew.
    E211 Cancelled: "the computation was stopped";
    /// How long a computation takes is counted before it begins: so many operating points, each as long as the train is
    /// large. What would take minutes is not begun unasked, and in a report such a part is left out. Allow it with `--yes`,
    /// or ask for fewer points.
    E212 TooLong: "the computation would take long";
    /// Profile shift (or another number of planet teeth) has to close a difference of one or two
    /// teeth between ring and sun plus planets. Ratios and efficiencies do not depend on it.
    W301 NearlyCoaxial: "the set closes only with profile shift";
    /// Planets at equal angles mesh only when (z_sun + z_ring) / planets is an integer; for
    /// stepped planets (z_1 y_2 - z_2 y_1) / (planets gcd(y_1, y_2)), ring gears negative. They
    /// can be assembled at unequal angles, at the price of balance and load sharing.
    W302 UnequalSpacing: "the planets cannot be spaced equally";
    /// The tip circles of neighbouring planets (addendum one module) overlap.
    W303 PlanetsTouch: "neighbouring planets touch";
    /// The planet's tooth number was not given and (z_ring - z_sun) / 2 is not an integer: the
    /// real planet differs, so planet speeds shown are nominal. Ratios and efficiencies come from
    /// sun and ring and do not depend on it.
    W304 NominalPlanet: "planet teeth taken as a nominal fraction";
    /// Nothing meshes with this member and no shift element touches it.
    W305 Unconnected: "member connected to nothing";
    /// The train has more freedoms than the prescribed speeds settle, or a part of it spins
    /// freely: the members named have no determined speed. Give one more speed, or hold a member.
    W306 Undetermined: "speeds are not determined";
    /// No member of a set can move: the shift elements or held members leave no motion.
    W307 KinematicallyLocked: "the train cannot turn";
    /// More gear pairs (or clutches) than independent constraints: the train is statically
    /// indeterminate. Stiffness decides the load sharing, and the model is rigid: remove a redundant mesh or
    /// clutch.
    W308 Indeterminate: "statically indeterminate";
    /// Friction holds the train: with the mesh losses given no equilibrium exists in which a load
    /// is driven. Check the signs of torques and speeds. Formulas that assume the power direction can return an
    /// efficiency below 0 or above 1 here.
    W309 SelfLocking: "the train locks by friction";
    /// With the same speeds and the same prescribed torques several equilibria exist, with
    /// different efficiencies. A rigid quasi-static model cannot choose between them (it is the
    /// gear form of the Painlevé paradox); all are reported. They occur close to self-locking:
    /// a better mesh efficiency makes the answer unique.
    W310 SeveralSolutions: "several equilibria exist";
    /// Every loaded member puts power in and none takes power out: all of it turns into heat.
    /// There is no efficiency to speak of.
    W311 AllDissipated: "all power is dissipated";
    /// A one-way clutch would have to transmit torque in the direction in which it runs free, or
    /// turn in the direction that it blocks. An operating point that asks for that is undetermined.
    W312 OneWay: "a one-way clutch cannot do that";
    /// The certificate failed and the train has too many interacting meshes to try every sign
    /// pattern, or more equilibria than are told; a solution that was found may not be the only one.
    W313 NotEnumerated: "uniqueness could not be decided";
    /// The teeth can exist, but something about them is unusual and makes results doubtful:
    /// undercut, a thin tip, a contact ratio close to one, a path of contact cut short.
    W314 DoubtfulGeometry: "unusual teeth";
    /// The dimensions of a bearing do not belong to its designation or series, or no constants are
    /// known for it. Its losses are computed with what was given.
    W315 DoubtfulBearing: "bearing data do not agree";
    /// A formula was used outside the range in which its source claims validity. The result is an
    /// extrapolation; `willis losses --compare FAMILY` shows what other laws of the family say.
    W316 OutsideLaw: "outside the range of a law";
    /// Losses and loads depend on each other and were not brought into agreement to 1e-9 of the
    /// loss. The numbers are those of the last step: do not use them.
    W317 NotConverged: "the operating point did not converge";
    /// The speeds that were prescribed contradict the gears, within the tolerance that was asked for:
    /// measured speeds do. The answer is that of speeds which the gears allow: those given first hold, the others
    /// follow. The deviation is the part of the largest of these speeds, as the gears tie them.
    W318 SpeedsYield: "prescribed speeds agree only within the tolerance";
    /// A machine or belt of a variator would have to run beyond what the train file says it can: torque, power, speed or
    /// ratio. The answer holds for a variator without that limit; the message has the limit and the excess.
    W319 BeyondLimit: "a limit of a variator is exceeded";
    /// A machine runs outside the map of its efficiency. The value at the edge of the map was taken.
    W320 OutsideMap: "outside the map of a machine";
    /// All members of a variator stand still. No power can pass it, and the torques of its machines have nothing to do
    /// with each other: none of them is known, and the variator was left out.
    W321 VariatorAtRest: "a variator stands still";
    /// A number of the answer cannot be right, though the formulas hold: a pressure that no steel bears, a load far
    /// beyond the rating of a bearing, thrust on a bearing that takes none, a force that no bearing of the file carries.
    /// The message has the number and its limit. Look at the sizes, the loads and the units in the file.
    W322 Implausible: "a number that cannot be right";
    /// Up to the limit of `[heat]` the losses are larger than what housing and cooler carry away, or the losses have no
    /// single value, so that the oil temperature is not known. The answer is that at the limit, or at the temperature of
    /// the oil in the file. Reduce the load, or let more heat out: a larger area, moving air, a cooler.
    W330 NoHeatBalance: "no oil temperature below the limit";
    /// Losses and heat flow agree at several oil temperatures, or it could not be decided whether they do. The answer is
    /// the one that a cold start reaches. A hot gearbox may stay at another one.
    W331 SeveralTemperatures: "the oil temperature is not the only one";
    /// A loaded mesh without relative motion: its friction may act in either direction, up to the
    /// sliding value, so torques behind it are known only within a range. Shown: the value
    /// without friction.
    N401 Stiction: "friction in a mesh at rest is not determined";
    /// The load on one mesh or the relative speed in it is close to zero: a small change of the
    /// operating point changes which gear drives, and with it the loss formula.
    N402 NearBoundary: "close to a change of the loss formula";
    /// The train has no input and output (or they are one member), so there is no ratio to print, and
    /// no operation either. Name `terminals`, or `input` and `output`, or add an operation.
    N403 NothingAsked: "nothing to analyse";
    /// The file gives teeth and an efficiency for one mesh: the efficiency is used, and the teeth
    /// only for speeds, pressures and film. Leave out the efficiency to have the loss computed.
    N404 GivenEfficiency: "a given efficiency is used instead of the teeth";
    /// A law jumps at the oil temperature at which losses and heat flow would agree: just below it the losses are larger
    /// than what is carried away, just above it smaller. The temperature is that of the step.
    N405 HeatStep: "the oil temperature rests on a step of a law";
}

impl Code {
    /// The severity that diagnostics with this code have.
    pub fn severity(self) -> Severity {
        match self.as_str().as_bytes()[0] {
            b'E' => Severity::Error,
            b'W' => Severity::Warning,
            _ => Severity::Note,
        }
    }

    /// The code with this text (`E101`, upper or lower case).
    pub fn parse(text: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|c| c.as_str().eq_ignore_ascii_case(text))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for Code {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        let wrong = || D::Error::invalid_value(Unexpected::Str(&text), &"a diagnostic code as in `E101`");
        Self::parse(&text).ok_or_else(wrong)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Code {
    fn schema_name() -> Cow<'static, str> {
        "Code".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A stable diagnostic code: `E…` an error, `W…` a warning, `N…` a note.",
            "type": "string",
            "pattern": "^[EWN][0-9]{3}$",
        })
    }
}
