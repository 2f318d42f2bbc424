"""Settings schema: metadata of keys in dataclass fields, and generic functions on such dataclasses.

A field that a file may hold is made by `key`, or by `one_of` if it has several variants. A field of another
dataclass is a section. A field of tuples of one is a list of tables. Other fields, such as the path of the
file itself, are not keys.
"""

from __future__ import annotations

import dataclasses
import functools
import operator
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from ...did_you_mean import suggestion
from ...toml_text import Where

Names = Mapping[str, str] | tuple[str, ...]


@dataclass(frozen=True)
class Key:
    """Metadata of a key.

    Attributes
    ----------
    help
        One line without unit and trailing period. Text after a semicolon is a remark.
    unit
        Unit such as "m"; empty for counts and texts.
    at_least, above, at_most
        Bounds of a number, or of each number of a list.
    choices
        Allowed names of a text, or of each text of a list: a tuple, a mapping to short descriptions, or a
        function that returns one of them.
    check
        Function that returns a further error, as words that follow the key's name, or None.
    affects
        Aspects of a product that the key affects; None: the aspects of its section, or its name.
    variants
        Dataclasses that are allowed here, by name. Their keys are in the same table as `tag`.
    tag, default_kind
        Key that selects the variant, and the default variant.
    """

    help: str
    unit: str = ""
    at_least: float | None = None
    above: float | None = None
    at_most: float | None = None
    choices: Names | Callable[[], Names] | None = None
    check: Callable[[Any], str | None] | None = None
    affects: tuple[str, ...] | None = None
    variants: Callable[[], Mapping[str, type]] | None = None
    tag: str = ""
    default_kind: str = ""

    def names(self) -> dict[str, str]:
        """Choices with their descriptions ("" without one)."""
        names = self.choices() if callable(self.choices) else self.choices or ()
        return dict(names) if isinstance(names, Mapping) else dict.fromkeys(names, "")

    def all_variants(self) -> Mapping[str, type]:
        """Return the variants by name; none for a key without variants."""
        return self.variants() if self.variants else {}

    def described(self) -> str:
        """Help with its unit: ``how far it is filled, m; 0 leaves it empty``."""
        head, mark, remark = self.help.partition(";")
        return (f"{head}, {self.unit}" if self.unit else head) + mark + remark

    def invalid(self, value: Any) -> str | None:
        """Error in a value of the right type, as words that follow the key's name; None if valid."""
        if value is None:
            return None
        for item in value if isinstance(value, tuple) else (value,):
            if reason := self._bounds(item) or self._choice(item, listed=isinstance(value, tuple)):
                return reason
        if self.choices and isinstance(value, tuple) and len(set(value)) < len(value):
            return f'names "{next(v for v in value if value.count(v) > 1)}" twice'
        return self.check(value) if self.check else None

    def _bounds(self, value: Any) -> str | None:
        low, above, high = self.at_least, self.above, self.at_most
        rules: tuple[tuple[float | None, Callable[[Any, Any], bool], str], ...] = (
            (low, operator.ge, "at least"),
            (above, operator.gt, "above"),
            (high, operator.le, "at most"),
        )
        known = [(bound, holds, word) for bound, holds, word in rules if bound is not None]
        if all(holds(value, bound) for bound, holds, _ in known):
            return None
        words = " and ".join(f"{word} {_number(bound)}" for bound, _, word in known)
        if low is not None and high is not None:
            words = f"from {_number(low)} to {_number(high)}"
        return f"must be {words}, not {value:{'' if isinstance(value, int) else '.12g'}}"

    def _choice(self, value: Any, listed: bool) -> str | None:
        if self.choices is None or value in (names := self.names()):
            return None
        must = f'holds "{value}"; each must be' if listed else "must be"
        return f"{must} {either(names)}" + ("" if listed else f', not "{value}"') + suggestion(value, names)


def _number(value: float) -> str:
    return f"{value:,}" if isinstance(value, int) else f"{value:,g}"


def either(names: Iterable[str]) -> str:
    """Join names: ``"a", "b" or "c"``."""
    *most, last = [f'"{name}"' for name in names]
    return f"{', '.join(most)} or {last}" if most else last


def key(
    default: Any = dataclasses.MISSING,
    help: str = "",
    *,
    default_factory: Any = dataclasses.MISSING,
    unit: str = "",
    at_least: float | None = None,
    above: float | None = None,
    at_most: float | None = None,
    choices: Names | Callable[[], Names] | None = None,
    check: Callable[[Any], str | None] | None = None,
    affects: tuple[str, ...] | None = None,
) -> Any:
    """Make the field of a key or a section; see `Key` for the arguments."""
    known = Key(help, unit, at_least, above, at_most, choices, check, affects)
    return dataclasses.field(default=default, default_factory=default_factory, metadata={"key": known})


def one_of(variants: Callable[[], Mapping[str, type]], help: str, *, tag: str, default_kind: str) -> Any:
    """Make the field of one of several dataclasses, with keys in the same table as the key `tag`."""
    known = Key(
        help, choices=lambda: tuple(variants()), variants=variants, tag=tag, default_kind=default_kind
    )
    return dataclasses.field(default_factory=lambda: variants()[default_kind](), metadata={"key": known})


class Field(NamedTuple):
    """Key of a dataclass."""

    field: dataclasses.Field
    key: Key
    type: Any  # as declared, without "| None"

    @property
    def name(self) -> str:
        """Name of the field."""
        return self.field.name

    @property
    def default(self) -> Any:
        """Default value if a file leaves the key out."""
        made = self.field.default_factory
        return self.field.default if made is dataclasses.MISSING else made()

    @property
    def table(self) -> type | None:
        """Dataclass of a section or of a list of tables."""
        inner = (self.type, *typing.get_args(self.type))
        return next((kind for kind in inner if dataclasses.is_dataclass(kind)), None)

    @property
    def tables(self) -> bool:
        """True if it is a list of tables."""
        return self.table is not None and self.table is not self.type


@functools.cache
def fields(kind: type) -> tuple[Field, ...]:
    """Keys of a dataclass in their order."""
    hints = typing.get_type_hints(kind)
    fields = [field for field in dataclasses.fields(kind) if "key" in field.metadata]
    return tuple(Field(field, field.metadata["key"], _declared(hints[field.name])) for field in fields)


def _declared(hint: Any) -> Any:
    return hint.__args__[0] if isinstance(hint, types.UnionType) else hint


def kind_of(known: Key, value: Any) -> str:
    """Name of a value's variant."""
    return next(name for name, kind in known.all_variants().items() if type(value) is kind)


def summary(kind: type) -> str:
    """First line of a dataclass's docstring, without its period and with a small first letter."""
    line = (kind.__doc__ or "").strip().partition("\n")[0].rstrip(".")
    return line[:1].lower() + line[1:]


def walk(kind: type, section: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Field]]:
    """Iterate over all keys of a dataclass and of nested ones, with their section.

    A key that several variants have (see `one_of`) comes once for each.
    """
    for part in fields(kind):
        yield section, part
        for inner in part.key.all_variants().values():
            yield from walk(inner, section)
        if part.table:
            yield from walk(part.table, (*section, part.name))


def validate(settings: Any, section: tuple[str, ...] = ()) -> tuple[Where, str] | None:
    """Validate settings of the right types: place and message of the first error, or None.

    A dataclass may have its own method `validate` for checks across keys. That of a variant (see `one_of`) is
    called by the dataclass that contains it.
    """
    own = getattr(settings, "validate", None)
    return _wrong_key(settings, section) or (own() if own else None)


def _wrong_key(settings: Any, section: tuple[str, ...]) -> tuple[Where, str] | None:
    for part in fields(settings.__class__):
        value, here = getattr(settings, part.name), (*section, part.name)
        if part.key.variants:
            if invalid := _wrong_key(value, section):
                return invalid
        elif reason := part.key.invalid(value):
            return (part.name,), f"{'.'.join(here)} {reason}"
        elif invalid := _wrong_inside(part, value, here):
            return (part.name, *invalid[0]), invalid[1]
    return None


def _wrong_inside(part: Field, value: Any, section: tuple[str, ...]) -> tuple[Where, str] | None:
    if not part.tables:
        return validate(value, section) if part.table else None
    for i, table in enumerate(value):
        if invalid := validate(table, section):
            return (i, *invalid[0]), invalid[1]
    return None


def select(settings: Any, affects: Iterable[str], camera: str | None = None) -> dict[str, Any]:
    """Keys that affect any of these aspects, in JSON form: equal if the settings are equal.

    Parameters
    ----------
    camera
        Name of the only table to take from lists of named tables.
    """
    return _chosen(settings, frozenset(affects), camera, ())


def _chosen(
    settings: Any, affects: frozenset[str], camera: str | None, inherited: tuple[str, ...]
) -> dict[str, Any]:
    selected: dict[str, Any] = {}
    for part in fields(settings.__class__):
        value = getattr(settings, part.name)
        aspects = part.key.affects if part.key.affects is not None else inherited
        if part.key.variants:
            tag = {part.key.tag: kind_of(part.key, value)} if affects & {*aspects} else {}
            selected |= tag | _chosen(value, affects, camera, aspects)
        elif part.table:
            aspects = aspects or (part.name,)
            tables = [t for t in (value if part.tables else (value,)) if camera in (None, _name(t, camera))]
            inner = [table for t in tables if (table := _chosen(t, affects, camera, aspects))]
            selected |= {part.name: inner if part.tables else inner[0]} if inner else {}
        elif affects & {*aspects}:
            selected[part.name] = plain(part.type, value)
    return selected


def _name(table: Any, otherwise: str | None) -> str | None:
    return getattr(table, "name", otherwise)


def plain(kind: Any, value: Any) -> Any:
    """JSON form of a value: equal for equal values, in any notation."""
    if isinstance(value, tuple):
        return list(value)
    if isinstance(value, datetime):
        return value.astimezone(UTC).isoformat()
    if isinstance(value, Path):
        return value.as_posix()
    if kind is float and value is not None:
        return float(value) + 0.0  # no -0.0, which has another JSON form
    return value


def items(kind: Any, count: int) -> tuple[Any, ...]:
    """Types of the `count` items of a tuple type `kind`, or of its fixed number of items."""
    inner = typing.get_args(kind)
    return inner[:1] * count if inner[-1] is Ellipsis else inner
