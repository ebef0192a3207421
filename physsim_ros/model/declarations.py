# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Values whose fields are declared: name, type, check, sentence and default in one statement each.

    friction: Annotated[float | None, Within(0.0, 10.0), 'coefficient of friction'] = None

Notes may follow the sentence, such as `Words`, by which people call it. The check of a value that
is made, its docstring, the keys of markers and world files, ROS parameters, and the tables of
`docs/interface` and `config/physsim.yaml` (`tools/tables`) follow from the declaration.

Law: a value that exists has passed its checks, in the order of its fields.

Modules that declare fields do without `from __future__ import annotations`: its texts would be
compiled at each start (5 ms). A check is not named as a field.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, Field, MISSING
from inspect import get_annotations
from typing import Any, ClassVar, Generic, Self, TypeVar

from physsim_ros.model.checks import Check, LONGEST_SHOWN, must_be, shown
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.texts import hint_of, no_kind, Words
from physsim_ros.model.translation import Text


@dataclass(frozen=True, slots=True)
class Declaration:
    """
    The declaration of a field, of its annotation `Annotated[type, check, 'sentence', *notes]`.

    :param name: of the field
    :param sentence: what it is, in Markdown
    :param check: None where the class itself checks it
    :param default: MISSING for a field that must be set
    :param notes: what else its users need, as its default among ROS parameters, or everyday words
    """

    name: str
    sentence: str
    check: Check | None
    default: Any
    notes: tuple[Any, ...]

    @property
    def words(self) -> Words:
        """Return the everyday words for it."""
        return next((note for note in self.notes if isinstance(note, Words)), Words())

    @property
    def span(self) -> str:
        """Return the range of a number with its unit, or the words that it can be, or ''."""
        return str(getattr(self.check, 'span', ''))

    @property
    def text(self) -> str:
        """Return the sentence, and the range or the words unless the sentence has them."""
        is_told = all(word in self.sentence for word in self.span.split(', '))
        return self.sentence if is_told else f'{self.sentence}; {self.span}'


class Checked:
    """
    The base of values with declared fields, which are frozen dataclasses.

    None is not checked where it is the default.

    :cvar KIND: word for the class among others of its base; '' for a class that is alone
    :cvar KIND_WORDS: everyday words for it
    :cvar FIELDS: declarations of the fields, by name
    :cvar WORDS: everyday words for each of them
    :raises Refusal: a check raised it
    """

    __slots__ = ()
    KIND: ClassVar[str] = ''
    KIND_WORDS: ClassVar[Words] = Words()
    FIELDS: ClassVar[Mapping[str, Declaration]] = {}
    WORDS: ClassVar[Mapping[str, Words]] = {}
    # Name, check, and whether None is not checked, of each field that has a check.
    _CHECKS: ClassVar[tuple[tuple[str, Check, bool], ...]] = ()

    def __init_subclass__(cls) -> None:
        # A dataclass with slots is made twice, the second time with what the first one has.
        if 'FIELDS' in cls.__dict__:
            return
        cls.FIELDS = {**cls.FIELDS, **{each.name: each for each in _declarations(cls)}}
        cls.WORDS = {each.name: each.words for each in cls.FIELDS.values()}
        cls._CHECKS = tuple(
            (each.name, each.check, each.default is None)
            for each in cls.FIELDS.values()
            if each.check is not None
        )
        body, raises, end = (cls.__doc__ or '').partition('\n    :raises ')
        lines = ''.join(f'\n    :param {each.name}: {each.text}' for each in cls.FIELDS.values())
        cls.__doc__ = f'{body.rstrip()}\n{lines}{raises or chr(10)}{end}' if lines else body

    def __post_init__(self) -> None:
        for name, check, is_optional in self._CHECKS:
            value = getattr(self, name)
            if value is None and is_optional:
                continue
            kept = check(value, name)
            if kept is not value:
                # Frozen for everyone but its own constructor.
                object.__setattr__(self, name, kept)

    def explicit(self) -> dict[str, Any]:
        """Return the fields that are set, by name, in their order."""
        pairs = ((name, getattr(self, name)) for name in self.FIELDS)
        return {name: value for name, value in pairs if value is not None}

    def noted(self, *notes: object) -> Iterator[Any]:
        """Yield the values at fields with some notes; of a list of `Checked`, those within."""
        for each in self.FIELDS.values():
            if all(note in each.notes for note in notes):
                value = getattr(self, each.name)
                for part in value if isinstance(value, tuple) else (value,):
                    yield from part.noted(*notes) if isinstance(part, Checked) else (part,)

    def entry(self) -> Any:
        """Return the mapping that `from_mapping` makes it of, without what has no value."""
        values = {name: entry_of(value) for name, value in self.explicit().items()}
        kind = {'kind': self.KIND} if self.KIND else {}
        return kind | {name: value for name, value in values.items() if value not in ([], {})}

    @classmethod
    def from_mapping(cls, mapping: Mapping[Any, Any]) -> Self:
        """
        Return the value of a YAML mapping.

        :raises UnknownProperty: a key is no field; the nearest one is named
        :raises Malformed: a number is not finite or an array has the wrong length
        :raises BadProperty: a value is missing, null, of the wrong kind, or out of range
        """
        cls.check_keys(mapping)
        for each in cls.FIELDS.values():
            if each.default is MISSING and each.name not in mapping:
                raise BadProperty('{field} is missing', field=each.name)
        return cls(**mapping)

    @classmethod
    def from_value(cls, value: object, name: str) -> Self:
        """
        Return a value of this class as it is, and that of a mapping as `from_mapping`.

        :param name: of the field, for the refusal
        :raises BadProperty: it is neither; and as `from_mapping`
        """
        if isinstance(value, cls):
            return value
        if not isinstance(value, dict):
            raise must_be('a mapping', value, name)
        return cls.from_mapping(value)

    @classmethod
    def check_keys(cls, mapping: Mapping[Any, Any]) -> None:
        """
        Refuse keys that are no fields, and keys without a value.

        :raises UnknownProperty: a key is no field; the nearest one is named
        :raises BadProperty: a value is null
        """
        for key, value in mapping.items():
            check_key(key, cls.WORDS)
            if value is None:
                raise BadProperty('{key} has no value', field=str(key), key=key)


def without_unset(
    mapping: Mapping[Any, Any], kind: type[Checked]
) -> tuple[dict[Any, Any], tuple[str, ...]]:
    """
    Return a YAML mapping without the properties that are null, and their names.

    :param kind: of the properties
    """
    unset = tuple(name for name in kind.FIELDS if mapping.get(name, name) is None)
    return {key: mapping[key] for key in mapping if key not in unset}, unset


def entry_of(value: Any) -> Any:
    """Return a value as YAML and JSON have it."""
    if isinstance(value, Checked):
        return value.entry()
    return [entry_of(each) for each in value] if isinstance(value, tuple) else value


def _declarations(cls: type[Checked]) -> Iterator[Declaration]:
    """Yield the declarations of a class, and those of its bases that have another default here."""
    for name, hint in get_annotations(cls).items():
        default = cls.__dict__.get(name, MISSING)
        if isinstance(default, Field):
            factory = default.default_factory
            default = default.default if factory is MISSING else factory()
        if str(hint).startswith('Annotated['):
            raise TypeError(f'{cls.__module__} declares fields as texts')
        metadata = getattr(hint, '__metadata__', None)
        if metadata is None:
            if name in cls.FIELDS:
                base = cls.FIELDS[name]
                yield Declaration(name, base.sentence, base.check, default, base.notes)
            continue
        check, sentence, *notes = metadata if callable(metadata[0]) else (None, *metadata)
        if not isinstance(sentence, str):
            # As where a check has the name of a field above it, whose default is meant then.
            raise TypeError(f'{cls.__name__}.{name} needs a check or none, and a sentence')
        yield Declaration(name, sentence, check, default, tuple(notes))


def check_key(key: object, known: Mapping[str, Collection[str]]) -> None:
    """
    Refuse an unknown key, and name the known one that is meant or similar, else all of them.

    :param known: everyday words for each of the keys that there are
    :raises UnknownProperty: the key is not one of the known
    """
    if key in known:
        return
    word = str(key)
    hint = hint_of(word, known)
    if known and not hint:
        hint = Text('; there are {names}', names=', '.join(known))
    raise UnknownProperty(
        'there is no property {key}{hint}', field=word[:LONGEST_SHOWN], key=shown(word), hint=hint
    )


def known_mapping(value: object, name: str, known: Collection[str]) -> dict[Any, Any]:
    """
    Return a mapping with no other keys than the known ones.

    :param name: of the field, for the refusal
    :raises BadProperty: it is no mapping
    :raises UnknownProperty: a key is not known; the nearest known one is named
    """
    if not isinstance(value, dict):
        raise must_be('a mapping', value, name)
    for key in value:
        check_key(key, dict.fromkeys(known, ()))
    return value


_Value = TypeVar('_Value', bound=Checked)


@dataclass(frozen=True, slots=True)
class OfKind(Generic[_Value]):
    """
    A check of values of several kinds, whose mapping says by the key `kind` which one it is.

    :param noun: for such a value, for messages
    :param kinds: classes by the words for them
    """

    noun: str
    kinds: Mapping[str, type[_Value]]

    @property
    def everyday(self) -> Mapping[str, Words]:
        """Return the everyday words for each kind, by the word for it."""
        return {kind: each.KIND_WORDS for kind, each in self.kinds.items()}

    def __call__(self, value: object, name: str) -> _Value:
        """
        Return a value of one of the kinds as it is, and that of a mapping as `from_mapping`.

        :raises BadProperty: it is neither, or there is no such kind; and as `from_mapping`
        :raises UnknownProperty: a key is one of other kinds alone; and as `from_mapping`
        """
        for each in self.kinds.values():
            if isinstance(value, each):
                return value
        if not isinstance(value, dict):
            raise must_be('a mapping', value, name)
        kind, words = value.get('kind'), ', '.join(self.kinds)
        if kind is None:
            raise BadProperty(
                '{name} has no kind, which is one of {kinds}', field='kind', name=name, kinds=words
            )
        if not isinstance(kind, str) or kind not in self.kinds:
            word = shown(kind).strip("'")
            hint = hint_of(word, self.everyday)
            raise BadProperty(no_kind(self.noun, shown(kind), hint, words), field='kind')
        rest, known = {key: value[key] for key in value if key != 'kind'}, self.kinds[kind].FIELDS
        for key in rest:
            if key not in known and any(key in each.FIELDS for each in self.kinds.values()):
                raise UnknownProperty(
                    '{noun}s of kind {kind} have no {field}; they have {known}',
                    field=key,
                    noun=self.noun,
                    kind=kind,
                    known=', '.join(known),
                )
        return self.kinds[kind].from_mapping(rest)
