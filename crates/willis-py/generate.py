"""Writes what the package has of every question: methods with their documentation, and the types of all answers.

The list of questions is that of the library: ``python crates/willis-py/generate.py`` after a build, ``--check`` to compare
only.
"""

from __future__ import annotations

import importlib.util
import json
import keyword
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
PACKAGE = HERE / "python" / "willis"
WIDTH = 120

#: What an argument may be beside the field of the request.
FORMS = {
    "over": ' A mapping from quantities to values, `{"input.speed": "500..6000 rpm:12", "input.torque": [50.0, 100.0]}`, with numbers '
    "in SI units; or a list of texts.",
}

#: Fields that are given by position.
POSITIONAL = {
    "draw": ["kind"],
    "simulate": ["scenario"],
    "explain": ["code"],
    "new": ["kind"],
    "validate": ["case"],
    "laws": ["family"],
    "export": ["kind"],
    "import": ["file"],
}

#: Classes of answers that have more than their data.
KINDS = {
    "analyze": "Analysis",
    "sweep": "Sweep",
    "cycle": "Cycle",
    "simulate": "Simulation",
    "draw": "Drawing",
    "report": "Report",
    "formula": "Formula",
}

ROWS = {"sweep", "cycle", "simulate"}

#: An example of every question; they run in the tests, in the root of the repository.
EXAMPLES = {
    "analyze": """
>>> train = willis.read("examples/zf-8hp70.toml")
>>> row = train.analyze(state="3").state()
>>> row.exact, round(row.drive.efficiency, 4), row.drive.verdict
('162/77', 0.982, 'unique')
""",
    "table": """
>>> table = willis.read("examples/zf-8hp70.toml").table(state="3", speed="1000 rpm")
>>> table.tables["members"]["speed_rad_s"][:3].round(1)
array([104.7, 104.7,   0. ])
""",
    "new": """
>>> text = willis.new("set").files("toml").popitem()[1].decode()
>>> willis.Train(text).analyze().state().drive.verdict
'unique'
""",
    "check": """
>>> willis.read("examples/zf-8hp70.toml").check().data.states
9
""",
    "flow": """
>>> flow = willis.read("examples/zf-8hp70.toml").flow(operation="motorway cruise")
>>> flow.data.operations[0].name
'motorway cruise'
""",
    "losses": """
>>> stage = willis.read("examples/fva-planetary-stage.toml")
>>> points = stage.losses(speeds=["500 rpm", "1000 rpm"]).tables["points"]
>>> bool(points["loss_w"][1] > points["loss_w"][0])
True
""",
    "heat": """
>>> warm = willis.read("examples/industrial-planetary-heat.toml").heat(operation="rated")
>>> warm.data.operations[0].verdict
'unique'
""",
    "calibrate": """
>>> stage = willis.read("examples/fva-planetary-stage.toml")
>>> fitted = stage.calibrate(data="examples/tests-fva-planetary-stage.csv")
>>> fitted.data.tests, fitted.data.learnt, fitted.data.converged
(23, 3, True)
""",
    "sensitivity": """
>>> stage = willis.read("examples/fva-planetary-stage.toml")
>>> stage.sensitivity().tables["quantities"]["quantity"][0]
'P1.geometry.pressure_angle'
""",
    "uncertainty": """
>>> stage = willis.read("examples/fva-planetary-stage.toml")
>>> band = stage.uncertainty(samples=128).tables["results"]
>>> bool(band["p05"][0] < band["nominal"][0] < band["p95"][0])
True
""",
    "sweep": """
>>> train = willis.read("examples/zf-8hp70.toml")
>>> points = train.sweep(over={"input.speed": "500..6000 rpm:12", "input.torque": [100.0, 200.0]}, state="3")
>>> len(points), points["loss_w"].shape
(24, (24,))
""",
    "cycle": """
>>> train = willis.read("examples/zf-8hp70.toml")
>>> day = {"state": ["3", "8"], "duration_s": [10, 20], "input.speed_rpm": [2000, 1800], "output.torque_n_m": [300, 100]}
>>> train.cycle(profile=day).data.format
'willis-cycle-1'
""",
    "compare": """
>>> train = willis.read("examples/zf-8hp70.toml")
>>> "b_less_a" in train.compare(train.with_(**{"P1.sun.teeth": 46})).tables["states"]
True
""",
    "regimes": """
>>> split = willis.read("examples/prius-p112.toml")
>>> len(split.regimes(terminals=["engine", "ring", "mg1"]).tables["regimes"])
28
""",
    "formula": """
>>> willis.read("examples/zf-8hp70.toml").formula(state="3").data.formulas[0].speed_ratio.text
'(1 - i_P1)*(1 - i_P4)/(1 - i_P1 - i_P4)'
""",
    "locate": """
>>> split = willis.read("examples/prius-p112.toml")
>>> split.locate(speeds={"engine": 200.0, "ring": 150.0}, torques={"engine": 80.0}).data.region
2
""",
    "simulate": """
>>> run = willis.read("examples/launch.toml").simulate(samples=11)
>>> run.data.outcome.verdict, bool(run["wheels.speed"][-1] > 20)
('finished', True)
""",
    "modes": """
>>> modes = willis.read("examples/galvagno.toml").modes().tables["modes"]
>>> "frequency_hz" in modes
True
""",
    "design": """
>>> found = willis.design(kind="3k", ratio=100, ring=0.09, module=0.0008, sort="forward")
>>> found.data.waterfall[0].trains, found.data.completeness.complete
(1064, True)
>>> willis.Train(found.files("train").popitem()[1].decode()).analyze().state().drive.verdict
'unique'
""",
    "schemes": """
>>> wish = {"elements": 4, "closed": 2, "forward": 3, "step": "1.15..2.2", "forward_range": "0.5..5", "reverse_range": "1.2..5"}
>>> found = willis.schemes(sets=2, **wish)
>>> found.data.found.schemes, found.data.completeness.complete
(653, True)
""",
    "draw": """
>>> willis.read("examples/zf-8hp70.toml").draw("lever", state="3").svg[:4]
'<svg'
""",
    "report": """
>>> willis.read("examples/zf-8hp70.toml").report().html[:15]
'<!DOCTYPE html>'
""",
    "export": """
>>> list(willis.read("examples/zf-8hp70.toml").export("csv", state="3").files("files"))
['zf-8hp70-3.csv']
""",
    "import": """
>>> found = willis.import_("examples/planetary-stage.rexs")
>>> train = willis.Train(found.files("train").popitem()[1].decode())
>>> len(train.analyze().data.operations)
2
""",
    "laws": """
>>> willis.laws("film").tables["laws"]["family"][0]
'film'
""",
    "validate": """
>>> willis.validate().data.cases[0].name
'wang-2020'
""",
    "explain": """
>>> willis.explain("E207").text.splitlines()[0]
'E207: there is no such state or operation'
""",
}

UNITS = "_rad_s2 _n_per_m _rad_s _kg_m3 _kg_m2 _m2_s _n_m _m_s _rad _pa _hz _w _j _k _n _m _s".split()


def extension() -> Any:
    """The built extension, without the package around it."""
    # That of the checkout, or of the package that is installed, which is not run: what it imports may be written only now.
    installed = importlib.util.find_spec("willis")
    folders = [PACKAGE, *map(Path, (installed and installed.submodule_search_locations) or [])]
    candidates = [file for folder in folders for end in ("so", "pyd") for file in sorted(folder.glob(f"_willis*.{end}"))]
    assert candidates, "the extension is not built"
    spec = importlib.util.spec_from_file_location("_willis", candidates[0])
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def resolve(schema: dict[str, Any], root: dict[str, Any]) -> dict[str, Any]:
    """What a reference stands for."""
    while "$ref" in schema:
        schema = root["$defs"][schema["$ref"].rsplit("/", 1)[-1]]
    return schema


def literals(schema: dict[str, Any]) -> list[str]:
    """The words that a schema allows; none where it is no list of words."""
    if "enum" in schema:
        return [v for v in schema["enum"] if isinstance(v, str)]
    if "const" in schema and isinstance(schema["const"], str):
        return [schema["const"]]
    parts = schema.get("oneOf") or schema.get("anyOf") or []
    words = [literals(p) for p in parts]
    return [w for ws in words for w in ws] if words and all(words) else []


def argument(name: str, schema: dict[str, Any], root: dict[str, Any]) -> tuple[str, bool]:
    """The type of a field of a request as an argument, and whether it may be left out as ``None``."""
    options = schema.get("anyOf")
    if options:
        rest = [o for o in options if o.get("type") != "null"]
        kind, _ = argument(name, rest[0], root)
        return kind, len(rest) < len(options)
    own = resolve(schema, root)
    types = own.get("type")
    null = isinstance(types, list) and "null" in types
    if isinstance(types, list):
        types = next(t for t in types if t != "null")
    if set(own.get("properties", {})) == {"name", "text"}:
        return "str | os.PathLike[str] | object", null
    words = literals(own)
    if words:
        return "Literal[" + ", ".join(json.dumps(w) for w in dict.fromkeys(words)) + "]", null
    if name == "over":
        return "Mapping[str, object] | Sequence[str] | str", null
    if types == "string":
        # Numbers of a wish, and two ends of a range.
        if name in ("ratio", "tolerance", "forward", "backward"):
            return "float | str | tuple[float, float]", null
        return ("Quantity" if name in ("from", "to", "fixed_step", "speed", "ring") else "str"), null
    if types == "integer":
        return "int", null
    if types == "number":
        return "float", null
    if types == "boolean":
        return "bool", null
    if types == "array":
        items, _ = argument("", own.get("items", {}), root)
        if name == "module":
            return "Sequence[Quantity] | Quantity", null
        if name in ("speeds", "torques", "powers", "temperature"):
            return "Mapping[str, Quantity] | Sequence[Quantity] | Quantity", null
        if own.get("minItems") and own.get("minItems") == own.get("maxItems"):
            return f"Sequence[{items}]", null
        return f"Sequence[{items}] | {items}" if items == "str" else f"Sequence[{items}]", null
    return "Any", null


def by_name(option: re.Match[str]) -> str:
    """An option with its value as an argument with its."""
    value = option[2].strip('"')
    return f'{python_name(option[1].replace("-", "_"))}="{value}"'


def listed(same: re.Match[str]) -> str:
    """An argument that is given several times, once with all its values."""
    return f"{same[1]}=[{', '.join(value for value in same.groups()[1:] if value)}]"


def paragraphs(text: str, indent: int) -> str:
    """A text of the library in the width of this file; lines that are indented stay."""
    out = []
    # Options of the command are arguments here: --over "A=B" is over="A=B", --vary is `vary`.
    text = re.sub(r'(?<!`)--([a-z][a-z-]*) ("[^"]*"|[^\s`"]+=[^\s`"]+)', by_name, text)
    # What the command takes several times is a list here.
    text = re.sub(r"([.;]) ([Ss])everal times for ", lambda m: f"{m[1]} {'A' if m[2] == 'S' else 'a'} list for ", text)
    # One name with several values is a list.
    text = re.sub(r'\b([a-z_]+)=("[^"\n]*")[ ]+\1=("[^"\n]*")(?:[ ]+\1=("[^"\n]*"))?', listed, text)
    text = re.sub(r"(?<!`)--([a-z][a-z-]*)", lambda option: f"`{python_name(option[1].replace('-', '_'))}`", text)
    text = text.replace("`", "``").replace("\\", "\\\\")
    for part in text.split("\n\n"):
        if part.startswith("On the command line"):
            continue
        if part.startswith("  "):
            out.append(textwrap.indent("::\n\n" + textwrap.indent(part.strip("\n"), "    "), " " * indent))
        else:
            out.append(textwrap.fill(part, WIDTH - 4, initial_indent=" " * indent, subsequent_indent=" " * indent))
    return "\n\n".join(out)


def python_name(name: str) -> str:
    """A field as a name of Python."""
    return name + "_" if keyword.iskeyword(name) else name


def question(entry: dict[str, Any]) -> str:
    """The method, or function, of a question."""
    name, root = entry["name"], entry["request"]
    of = entry["of"]
    method = of != "nothing"
    indent = 4 if method else 0
    pad = " " * indent
    fields = root.get("properties", {})
    first = [f for f in POSITIONAL.get(name, []) if f in fields]
    order = first + [f for f in fields if f not in first and f != "summary_only"]
    required = set(root.get("required", []))
    arguments, docs, build = (["self"] if method else []), [], []
    if of == "trains":
        arguments.append("*others: Train")
    marked = False
    for field in order:
        schema = fields[field]
        kind, null = argument(field, schema, root)
        if field not in first and not marked and of != "trains":
            arguments.append("*")
            marked = True
        own = python_name(field)
        must = field in required
        if must:
            arguments.append(f"{own}: {kind}")
        else:
            arguments.append(f"{own}: {kind} | None = None")
        docs.append(f"{pad}{own}\n" + paragraphs(schema.get("description", "").strip() + FORMS.get(field, ""), indent + 4))
        build.append(f'"{field}": {own}')
    if not marked and of != "trains":
        arguments.append("*")
    arguments += ["threads: int | None = None", "yes: bool = False", "progress: bool | Progress | None = None"]
    result = f"contracts.{contract_class(entry)}"
    trains = {"trains": "[self, *others]", "nothing": "[]"}.get(of, "[self]")
    trains = trains.replace("self", "cast(Any, self)")
    lines = [f"{pad}def {python_name(name)}("]
    lines += [f"{pad}    {a}," for a in arguments]
    lines += [f'{pad}) -> "{result}":']
    body = paragraphs(root.get("description", "").strip(), indent + 4).lstrip()
    shared = (
        f"{pad}    threads, yes, progress\n"
        f"{pad}        Threads for long work (all cores); whether it may take as long as it takes; ``True`` for a bar, or what is\n"
        f"{pad}        called with a word, how much is done and how much there is."
    )
    docs_text = "\n".join(textwrap.indent(d, "    ") for d in docs)
    lines.append(f'{pad}    """{body}')
    lines.append("")
    lines.append(f"{pad}    Parameters\n{pad}    ----------")
    if docs_text:
        lines.append(docs_text)
    lines.append(shared)
    lines.append("")
    lines.append(f"{pad}    Examples\n{pad}    --------")
    lines.append(textwrap.indent(EXAMPLES[name].strip(), pad + "    "))
    lines.append(f'{pad}    """')
    lines.append(f"{pad}    return cast(")
    lines.append(f'{pad}        "{result}",')
    lines.append(f"{pad}        _ask(")
    lines.append(f'{pad}            "{name}",')
    lines.append(f"{pad}            {trains},")
    lines.append(f"{pad}            {{{', '.join(build)}}},")
    lines.append(f"{pad}            threads=threads,\n{pad}            yes=yes,\n{pad}            progress=progress,")
    lines.append(f"{pad}        ),\n{pad}    )")
    return "\n".join(lines)


def contract_class(entry: dict[str, Any]) -> str:
    """The name of the class of an answer."""
    return entry["name"].title().replace("-", "") + "Answer"


HEAD = '''"""{about}

Written by ``generate.py``; changes belong to the library.
"""

'''


def questions(entries: list[dict[str, Any]]) -> str:
    """The module of all questions."""
    methods = [question(e) for e in entries if e["of"] != "nothing"]
    functions = [question(e) for e in entries if e["of"] == "nothing"]
    names = [python_name(e["name"]) for e in entries if e["of"] == "nothing"]
    return (
        HEAD.format(about="Every question of the library, as methods of a train and as functions.")
        + '''from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, cast

from ._request import Quantity
from ._request import ask as _ask
from ._work import Progress

if TYPE_CHECKING:
    from . import _contracts as contracts
    from ._train import Train

'''
        + f"__all__ = {json.dumps(names)}\n\n\n"
        + "class Questions:\n    \"\"\"The questions that are asked of a train.\"\"\"\n\n    __slots__ = ()\n\n"
        + "\n\n".join(methods)
        + "\n\n\n"
        + "\n\n\n".join(functions)
        + "\n"
    )


class Types:
    """Classes of the contracts, as stubs."""

    def __init__(self) -> None:
        self.out: list[str] = []
        self.made: dict[str, str] = {}

    def of(self, name: str, schema: dict[str, Any], root: dict[str, Any], prefix: str) -> str:
        """The type of a value."""
        if "$ref" in schema:
            target = schema["$ref"].rsplit("/", 1)[-1]
            return self.definition(target, root, prefix)
        options = schema.get("anyOf") or schema.get("oneOf")
        if options:
            words = literals(schema)
            if words:
                return "Literal[" + ", ".join(json.dumps(w) for w in dict.fromkeys(words)) + "]"
            return " | ".join(dict.fromkeys(self.of(name, o, root, prefix) for o in options))
        words = literals(schema)
        if words:
            return "Literal[" + ", ".join(json.dumps(w) for w in dict.fromkeys(words)) + "]"
        types = schema.get("type")
        if isinstance(types, list):
            parts = [self.of(name, {**schema, "type": t}, root, prefix) for t in types]
            return " | ".join(dict.fromkeys(parts))
        if types == "null":
            return "None"
        if types == "string":
            return "str"
        if types == "integer":
            return "int"
        if types == "number":
            return "float"
        if types == "boolean":
            return "bool"
        if types == "array":
            items = schema.get("items")
            return f"list[{self.of(name, items, root, prefix) if isinstance(items, dict) else 'Any'}]"
        if types == "object" and schema.get("properties"):
            return self.klass(prefix + name.title().replace("_", ""), schema, root, prefix)
        if types == "object" and isinstance(schema.get("additionalProperties"), dict):
            return f"Named[{self.of(name, schema['additionalProperties'], root, prefix)}]"
        return "Any"

    def definition(self, target: str, root: dict[str, Any], prefix: str) -> str:
        """The type that a definition stands for."""
        schema = root["$defs"][target]
        if schema.get("type") == "object" and schema.get("properties"):
            return self.klass(prefix + target, schema, root, prefix)
        key = f"{prefix}{target}"
        if key in self.made:
            return self.made[key]
        # What refers to itself is told in general.
        self.made[key] = "Any"
        self.made[key] = self.of(target, schema, root, prefix)
        return self.made[key]

    def klass(self, name: str, schema: dict[str, Any], root: dict[str, Any], prefix: str, base: str = "Record") -> str:
        """A class with the fields of an object."""
        if name in self.made:
            return self.made[name]
        self.made[name] = name
        lines = [f"class {name}({base}):"]
        about = schema.get("description", "").strip()
        if about:
            lines.append(f'    """{paragraphs(about, 4).strip()}"""')
        names = list(schema.get("properties", {}))
        bare_names = [bare(n) for n in names]
        for field, short in zip(names, bare_names):
            kind = self.of(field, schema["properties"][field], root, prefix)
            if not field.isidentifier() or keyword.iskeyword(field) or (base == "Answer" and field == "text"):
                continue
            told = schema["properties"][field].get("description", "").strip()
            for attribute in dict.fromkeys([field, short]):
                unique = attribute == field or (short not in names and bare_names.count(short) == 1)
                if unique and attribute.isidentifier() and not keyword.iskeyword(attribute):
                    lines.append(f"    @property\n    def {attribute}(self) -> {kind}: ...")
                    if told and attribute == field:
                        lines[-1] = lines[-1].removesuffix(" ...")
                        lines.append(f'        """{paragraphs(told, 8).strip()}"""')
        if len(lines) == 1:
            lines.append("    ...")
        self.out.append("\n".join(lines))
        return name


def bare(name: str) -> str:
    """A name without its unit."""
    for unit in UNITS:
        if name.endswith(unit) and len(name) > len(unit):
            return name[: -len(unit)]
    return name


def contracts(entries: list[dict[str, Any]]) -> str:
    """The stubs of all answers."""
    types = Types()
    for entry in entries:
        schema = entry["answer"]
        name = contract_class(entry)
        base = f"_answer.{KINDS[entry['name']]}" if entry["name"] in KINDS else "Answer"
        prefix = entry["name"].title()
        own = dict(schema)
        if not own.get("properties"):
            options = [resolve(o, schema) for o in own.get("anyOf", own.get("oneOf", []))]
            merged: dict[str, Any] = {}
            for option in options:
                merged.update(option.get("properties", {}))
            own["properties"] = merged
        taken = {"question", "request", "trains", "data", "json", "text", "tables", "notes", "save", "files", "extra"}
        if base.startswith("_answer."):
            taken |= {"efficiency", "ratio", "verdict", "members", "table", "columns", "svg", "html"}
        own["properties"] = {k: v for k, v in own["properties"].items() if k not in taken}
        types.klass(name, own, schema, prefix, base)
    return (
        HEAD.format(about="The types of all answers, as the contracts of the library say them.")
        + '''from collections.abc import Iterator
from typing import Any, Generic, Literal, TypeVar

from . import _answer
from ._answer import Answer
from ._record import Record

_T = TypeVar("_T", covariant=True)

class Named(Generic[_T]):
    """Things by their names; a name that is an identifier is an attribute too."""

    def __getattr__(self, name: str) -> _T: ...
    def __getitem__(self, name: str) -> _T: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...
    def keys(self) -> list[str]: ...
    def values(self) -> list[_T]: ...
    def items(self) -> list[tuple[str, _T]]: ...
    def get(self, name: str, default: Any = None) -> _T | Any: ...
    def to_dict(self) -> dict[str, Any]: ...

'''
        + "\n\n".join(types.out)
        + "\n"
    )


def main() -> int:
    """Writes the files, or compares them."""
    entries = json.loads(extension().questions())
    made = {"_questions.py": questions(entries), "_contracts.pyi": contracts(entries)}
    stale = []
    for name, text in made.items():
        path = PACKAGE / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        if "--check" in sys.argv:
            stale.append(name)
        else:
            path.write_text(text, encoding="utf-8")
    if stale:
        print(f"not as generated: {', '.join(stale)}; run: python crates/willis-py/generate.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
