"""Past one machine: long work on engines that others wrote.

``willis.on(executor)`` takes an executor of :mod:`concurrent.futures`, a client of Dask (``distributed.Client``) or the module
``ray``. Work is cut where the library cuts it, so that the result has the bytes that one machine makes.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _willis
from ._answer import Answer
from ._errors import TrainError

if TYPE_CHECKING:
    from ._train import Train


@dataclass(frozen=True)
class Parts:
    """Parts of a sweep, a file each.

    ``files`` are those that are there, in order; ``unfinished`` says of each other one, by its number from 1, why it is not.
    """

    files: list[str]
    unfinished: dict[int, str] = field(default_factory=dict[int, str])

    @property
    def is_whole(self) -> bool:
        """Whether no part is missing."""
        return not self.unfinished


class On:
    """An engine that others wrote, for the long work of this package; made by :func:`on`."""

    def __init__(self, executor: Any, *, tries: int = 3) -> None:
        self._submit, self._result = _engine(executor)
        self._tries = max(1, tries)

    def sweep(
        self,
        train: Train,
        *,
        over: Mapping[str, object] | Sequence[str] | str,
        path: str | os.PathLike[str],
        shards: int,
        form: str = "parquet",
        progress: Callable[[int, int], object] | None = None,
        **request: Any,
    ) -> Parts:
        """A sweep of any size in so many shards, each a file in ``path``: a folder, or an address that ``fsspec`` knows.

        Files that are there already are kept: the same call goes on where another one ended, and ``sweep.json`` beside them says
        which call that is; a folder of another one is refused. A shard that fails is tried again, three times in all; those
        that do not end well are named. What a shard holds depends on the train, the request and its number only.
        """
        from ._quantity import axes

        if form not in ("parquet", "csv", "jsonl"):
            raise ValueError(f"form is parquet, csv or jsonl, and not {form!r}")
        if not 1 <= shards <= 1_000_000:
            raise ValueError(f"{shards} shards: from 1 to 1000000 are possible")
        words = _words(axes(over), request)
        parts, names = train._core.parts(), [f"part-{k:06}-of-{shards:06}.{form}" for k in range(1, shards + 1)]
        store = _Store(os.fspath(path))
        there = store.names()
        study = json.dumps({"willis": _willis.__version__, "train": parts, "sweep": words, "shards": shards, "form": form})
        own = json.dumps({"format": "willis-shards-1", "sha256": hashlib.sha256(study.encode()).hexdigest()}) + "\n"
        if _STUDY in there:
            if store.get(_STUDY) != own.encode():
                raise FileExistsError(f"{store.address(_STUDY)}: the folder holds the shards of another sweep; take another one")
        elif any(name.startswith("part-") for name in there):
            raise FileExistsError(f"{store.address('part-…')}: nothing says of which sweep these are; take another folder")
        else:
            store.put(_STUDY, own.encode())
        todo = [k for k, name in enumerate(names) if name not in there]
        done = shards - len(todo)
        waiting = {k: self._submit(shard, parts, words, k + 1, shards, form) for k in todo}
        unfinished: dict[int, str] = {}
        for k in todo:
            why = ""
            for attempt in range(self._tries):
                try:
                    store.put(names[k], self._result(waiting[k]))
                    why = ""
                    break
                except TrainError:
                    raise
                except Exception as error:  # noqa: BLE001 - whatever an engine raises where a worker is lost
                    why = f"{type(error).__name__}: {error}"
                    if attempt + 1 < self._tries:
                        try:
                            waiting[k] = self._submit(shard, parts, words, k + 1, shards, form)
                        except Exception as lost:  # noqa: BLE001
                            why = f"{type(lost).__name__}: {lost}"
                            break
            if why:
                unfinished[k + 1] = why
            else:
                done += 1
                if progress is not None:
                    progress(done, shards)
        return Parts([store.address(n) for k, n in enumerate(names) if k + 1 not in unfinished], unfinished)

    def ask(self, question: str, trains: Sequence[Train], **request: Any) -> Iterator[Answer]:
        """A question of many trains, one answer each, in their order: ``on(executor).ask("analyze", trains)``."""
        yield from self._each([(one, question, train, request) for train in trains])

    def uncertainty(self, train: Train, *, shards: int = 16, **request: Any) -> Answer:
        """How sure a number is, as :meth:`Train.uncertainty` tells it, its points cut into so many shards.

        The answer is that of one machine, bit for bit, whatever the number of shards. A shard that fails is tried again, three
        times in all.

        >>> from concurrent.futures import ThreadPoolExecutor
        >>> import willis
        >>> train = willis.read("examples/zf-8hp70.toml")
        >>> with ThreadPoolExecutor(2) as pool:
        ...     answer = willis.on(pool).uncertainty(train, state="3", samples=128, shards=4)
        >>> answer == train.uncertainty(state="3", samples=128)
        True
        """
        from ._request import fields

        if not 1 <= shards <= 1_000_000:
            raise ValueError(f"{shards} shards: from 1 to 1000000 are possible")
        words = json.dumps(fields("uncertainty", request))
        core = train._core
        found = self._each([(piece, "uncertainty", words, train, k, shards) for k in range(shards)])
        return Answer(_willis.gather("uncertainty", words, core, list(found)), [train])

    def _each(self, work: Sequence[tuple[Any, ...]]) -> Iterator[Any]:
        """The results of calls, in their order, each tried again where a worker is lost."""
        waiting = [self._submit(*call) for call in work]
        for k, call in enumerate(work):
            yield self._one(waiting[k], call)
            waiting[k] = None

    def _one(self, future: Any, call: tuple[Any, ...]) -> Any:
        tries = self._tries
        while True:
            try:
                return self._result(future)
            except TrainError:
                raise
            except Exception:
                tries -= 1
                if not tries:
                    raise
                future = self._submit(*call)


def on(executor: Any, *, tries: int = 3) -> On:
    """Long work on an engine: an executor of :mod:`concurrent.futures`, ``distributed.Client``, or the module ``ray``.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> import willis
    >>> trains = [willis.simple("P", sun=s, ring=70) for s in (20, 30)]
    >>> with ThreadPoolExecutor(2) as pool:
    ...     [round(a.ratio, 3) for a in willis.on(pool).ask("analyze", trains)]
    [4.5, 3.333]
    """
    return On(executor, tries=tries)


def _engine(executor: Any) -> tuple[Callable[..., Any], Callable[[Any], Any]]:
    """How to submit work to an engine, and how to get its result."""

    def result(future: Any) -> Any:
        return future.result()

    if getattr(executor, "__name__", "") == "ray":
        remote: dict[Callable[..., Any], Any] = {}

        def by_ray(work: Callable[..., Any], *args: Any) -> Any:
            if work not in remote:
                remote[work] = executor.remote(max_retries=3)(work)
            return remote[work].remote(*args)

        return by_ray, executor.get
    if hasattr(executor, "scheduler_info") and hasattr(executor, "submit"):

        def by_dask(work: Callable[..., Any], *args: Any) -> Any:
            return executor.submit(work, *args, pure=False, retries=3)

        return by_dask, result
    if hasattr(executor, "submit"):
        return executor.submit, result
    raise TypeError(
        f"{type(executor).__name__} is no engine: an executor of concurrent.futures, distributed.Client, or the module ray"
    )


def one(question: str, train: Train, request: Mapping[str, Any]) -> Answer:
    """One question of one train, by a worker."""
    answer: Answer = getattr(train, question)(**request)
    return answer


def piece(question: str, request: str, train: Train, k: int, n: int) -> bytes:
    """A piece of the work of a question, by a worker."""
    return _willis.piece(question, request, train._core, k, n)


def shard(parts: Sequence[Any], words: Sequence[str], k: int, n: int, form: str) -> bytes:
    """A shard of a sweep as the bytes of its file, by a worker: those of the command's ``--shard k/n``."""
    _, text, files, laws, tolerance, _ = parts
    with tempfile.TemporaryDirectory() as folder:
        # Deep enough that tables beside or above the train file stay in this folder.
        above = max((name.replace("\\", "/").split("/").count("..") for name in files), default=0)
        home = Path(folder, *["in"] * above)
        home.mkdir(parents=True, exist_ok=True)
        file, out = home / "train.toml", Path(folder, f"part.{form}")
        file.write_text(text, encoding="utf-8")
        for name, table in files.items():
            place = Path(os.path.normpath(home / name))
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(table, encoding="utf-8")
        own = ["--allow", folder] + [w for family, law in laws for w in ("--law", f"{family}={law}")]
        if tolerance is not None:
            own += ["--speed-tolerance", repr(tolerance)]
        own += ["--shard", f"{k}/{n}", "--threads", "1", "--yes", "-o", str(out)]
        wrong = _willis.command_told(["willis", "sweep", str(file), *words, *own])
        if wrong is not None:
            raise TrainError(wrong.rstrip("\n"))
        return out.read_bytes()


#: The file that says which sweep a folder holds.
_STUDY = "sweep.json"

#: Fields of the request that the command has as options of the same name.
_OPTIONS = ("study", "operation", "state", "hold")


def _words(over: Sequence[str], request: Mapping[str, Any]) -> list[str]:
    words = [w for a in over for w in ("--over", a)]
    for name, value in request.items():
        if value is None or value is False:
            continue
        if name in _OPTIONS:
            words += [f"--{name}", str(value)]
        elif name == "columns":
            words += ["--columns", value if isinstance(value, str) else ",".join(value)]
        elif name == "fast":
            words.append("--fast")
        else:
            raise TypeError(f"a sweep has no `{name}`")
    return words


class _Store:
    """A folder, here or where ``fsspec`` finds it."""

    def __init__(self, path: str) -> None:
        self._path = path.rstrip("/")
        self._far: Any = None
        if "://" in path:
            import fsspec

            self._far, self._path = fsspec.core.url_to_fs(path)
            self._far.makedirs(self._path, exist_ok=True)
        else:
            os.makedirs(path, exist_ok=True)

    def names(self) -> set[str]:
        if self._far is None:
            return set(os.listdir(self._path))
        return {str(name).rsplit("/", 1)[-1] for name in self._far.ls(self._path, detail=False)}

    def address(self, name: str) -> str:
        return f"{self._path}/{name}"

    def get(self, name: str) -> bytes:
        if self._far is not None:
            return bytes(self._far.cat_file(self.address(name)))
        return Path(self.address(name)).read_bytes()

    def put(self, name: str, data: bytes) -> None:
        """Whole or not at all."""
        if self._far is not None:
            with self._far.open(self.address(name + ".part"), "wb") as file:
                file.write(data)
            self._far.mv(self.address(name + ".part"), self.address(name))
            return
        part = self.address(name + ".part")
        Path(part).write_bytes(data)
        os.replace(part, self.address(name))
