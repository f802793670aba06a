"""Whether values that came as JSON have the types that `fleetplan.types` declares."""

import functools
import types
import typing
from collections.abc import Callable, Mapping
from typing import Any, Literal, Union

_MAX = 1e15  # of a number of the service: none is larger

_Check = Callable[[object], None]


class Misshapen(Exception):
    """A value is not of its type."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.path: list[str] = []  # from the value to where it is wrong, reversed

    def __str__(self) -> str:
        return f"/{'/'.join(reversed(self.path))} {self.args[0]}"


def check(value: object, kind: Any) -> None:
    """Raises Misshapen unless the value is of this type. A newer service may have more members and words. So other
    members of objects are ignored, and any word is accepted where words are listed."""
    _check_of(kind)(value)


def is_number(value: object) -> bool:
    """Whether it is a finite number that the service could have sent."""
    return isinstance(value, int | float) and not isinstance(value, bool) and -_MAX < value < _MAX


@functools.cache
def _check_of(kind: Any) -> _Check:
    origin = typing.get_origin(kind)
    if kind in (Any, object):
        return lambda _: None
    if kind is float:
        return _is("a number", is_number)
    if kind is int:
        return _is("a whole number", lambda value: is_number(value) and isinstance(value, int))
    if kind in (str, bool, type(None)):
        return _is(f"a {kind.__name__}", lambda value: isinstance(value, kind))
    if origin is Literal:
        return _one_of([_check_of(typing.cast(Any, one)) for one in {type(word) for word in typing.get_args(kind)}])
    if origin in (Union, types.UnionType):
        return _one_of([_check_of(one) for one in typing.get_args(kind)])
    if origin is list:
        return functools.partial(_list, _check_of(typing.get_args(kind)[0]))
    if origin is dict or not typing.is_typeddict(kind):
        return _is("an object", lambda value: isinstance(value, dict))
    members = {name: (_check_of(of), name in kind.__required_keys__) for name, of in typing.get_type_hints(kind).items()}
    return functools.partial(_object, members)


def _is(name: str, holds: Callable[[object], bool]) -> _Check:
    def look(value: object) -> None:
        if not holds(value):
            raise Misshapen(f"is not {name}")
    return look


def _one_of(checks: list[_Check]) -> _Check:
    def look(value: object) -> None:
        for one in checks[:-1]:
            try:
                return one(value)
            except Misshapen:
                pass
        checks[-1](value)
    return look


def _list(item: _Check, value: object) -> None:
    if not isinstance(value, list):
        raise Misshapen("is not a list")
    for index, one in enumerate(value):
        _inside(str(index), item, one)


def _object(members: Mapping[str, tuple[_Check, bool]], value: object) -> None:
    if not isinstance(value, dict):
        raise Misshapen("is not an object")
    for name, (look, is_required) in members.items():
        if name in value:
            _inside(name, look, value[name])
        elif is_required:
            raise Misshapen(f"has no {name}")


def _inside(name: str, look: _Check, value: object) -> None:
    try:
        look(value)
    except Misshapen as error:
        error.path.append(name)
        raise
