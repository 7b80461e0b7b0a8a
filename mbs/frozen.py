"""Mappings of frozen values: nobody changes them, and they can be pickled."""

from __future__ import annotations

import copyreg
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

_K = TypeVar("_K")
_V = TypeVar("_V")


def frozen(mapping: Mapping[_K, _V]) -> MappingProxyType[_K, _V]:
    """Return a copy of a mapping that cannot be changed.

    Parameters
    ----------
    mapping : mapping
        What is copied.

    Examples
    --------
    >>> import pickle
    >>> pickle.loads(pickle.dumps(frozen({"a": 1.0})))
    mappingproxy({'a': 1.0})
    """
    return MappingProxyType(dict(mapping))


# Python has no way to pickle one
copyreg.pickle(MappingProxyType, lambda found: (frozen, (dict(found),)))
