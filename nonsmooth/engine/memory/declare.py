"""The field table: one declaration for every number of the engine.

A declaration has the type and unit of a number, its :class:`Life` (how long it keeps its meaning), and one sentence.
Its owner is the class that declares it. From declarations follow the records of compiled and of plain mode, allocation,
checkpoints, the comparison of models, checks that no number is read after its life, and the page of the internals.

An owner is a :class:`Record`, of which there are many (``ws.contacts[c].gap``), or a :class:`Singleton`, of which
there is one (``ws.tolerance.gap``). A class of declarations is also what editors and type checkers see:
``contact.gap`` is a float, and "find usages" works.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, ClassVar, Protocol, TypeAlias

from nonsmooth.engine.memory.sizes import Size, per


class Life(Enum):
    """When a number loses its meaning."""

    PARAMETER = "parameter"
    """With the model. It never changes in a run."""
    REQUEST = "request"
    """With the call that asks for a run."""
    STATE = "state"
    """With the run."""
    REUSED = "reused"
    """With the next step, which starts from it instead of evaluating it again."""
    DERIVED = "derived"
    """With the modes. It follows from the state, and is evaluated again when a run continues."""
    STEP = "step"
    """With the step that wrote it."""
    EVENT = "event"
    """With the event that wrote it."""
    IMPACT = "impact"
    """With the impact that wrote it."""
    SOLUTION = "solution"
    """With the contact problem that wrote it."""
    OUTPUT = "output"
    """When Python has read it."""


@dataclass(eq=False)
class Declaration:
    """One number, or a few, of an owner.

    Attributes
    ----------
    kind : type
        float, int, bool or an IntEnum.
    life : Life
        When it loses its meaning.
    unit : str
        Unit in SI; "1" for a pure number, "" if there is none.
    sentence : str
        What it is.
    numbers : int
        How many there are of each record.
    is_vector : bool
        True if the numbers are read and written as a tuple, False if they are read one by one.
    size : Size or None
        Length of an array of a part, as a function of the counts of a system.
    begin : float
        Value before any run.
    inside : tuple of str and int
        Name of the storage that it is a view of, and its first number there for each record; "" for its own storage.
    behind : str
        Key of the scalar that is the position of the first record in the array; "" if that is 0.
    has_end : bool
        True for starts of ranges: one entry more is the end of the last range.
    is_late : bool
        True for an array that most runs leave unused. It comes last, and costs no memory before it is written.
    is_of_slot : bool
        True for a parameter or a state of the record itself, whichever declared contact it holds.
    is_of_row : bool
        True for a parameter that all contacts of two declared shapes share.
    is_address : bool
        True for the address of a function, which is another one in every process.
    below : Size or None
        Least number above all values of an integer, as a function of the counts of a system. Checkpoints from files are
        checked against it.
    owner : type
        Class that declares it.
    name : str
        Its name there.
    """

    kind: type
    life: Life
    unit: str
    sentence: str
    numbers: int = 1
    is_vector: bool = False
    size: Size | None = None
    begin: float = 0
    inside: tuple[str, int] = ("", 0)
    behind: str = ""
    has_end: bool = False
    is_late: bool = False
    is_of_slot: bool = False
    is_of_row: bool = False
    is_address: bool = False
    below: Size | None = None
    owner: Any = None
    name: str = ""

    def __set_name__(self, owner: type, name: str) -> None:
        """Set name and owner, from the class body. Python calls it for each declaration when the class is made."""
        self.owner, self.name = owner, name

    @functools.cached_property
    def is_scalar(self) -> bool:
        """True if it is one number of a part, False if it is an array or a number of each record."""
        return self.size is None and issubclass(self.owner, Singleton)

    @property
    def is_float(self) -> bool:
        """True if it is among the floats of the workspace, False if among its integers."""
        return self.kind is float

    @property
    def outlives_a_step(self) -> bool:
        """True if a step may read it from an earlier step, so that a checkpoint holds it. Else each step writes it."""
        return self.life in (Life.STATE, Life.REUSED)

    @functools.cached_property
    def key(self) -> str:
        """Key of the storage that holds it, such as "contacts.gap": its own, or that of which it is a view."""
        storage, _first = self.inside
        # a storage without an owner in its name belongs to the same owner
        if not storage:
            return f"{self.owner.key}.{self.name}"
        return storage if "." in storage else f"{self.owner.key}.{storage}"


Vector2: TypeAlias = tuple[float, float]
Vector3: TypeAlias = tuple[float, float, float]
Vector4: TypeAlias = tuple[float, float, float, float]


class FloatRow(Protocol):
    """An array of floats of the workspace."""

    start: int
    """Its offset among all floats."""

    def __getitem__(self, index: int, /) -> float: ...

    def __setitem__(self, index: int, value: float, /) -> None: ...


class IntegerRow(Protocol):
    """An array of integers of the workspace."""

    start: int
    """Its offset among all integers."""

    def __getitem__(self, index: int, /) -> int: ...

    def __setitem__(self, index: int, value: int, /) -> None: ...


class Owner:
    """Base of the classes of declarations.

    Attributes
    ----------
    key : str
        Name of the owner in the workspace.
    """

    key: ClassVar[str]


class Record(Owner):
    """Base of the owners of which there are many.

    Attributes
    ----------
    capacity : Size
        Number of records that are allocated, as a function of the counts of a system.
    length : str
        Key of the scalar that is the present number of records.
    index : int
        Number of the record.
    """

    capacity: ClassVar[Size]
    length: ClassVar[str]
    index: int

    def __init_subclass__(
        cls, key: str, capacity: str | Size, length: str, copies: Mapping[str, Declaration] | None = None
    ) -> None:
        """Set key, capacity and length from the class statement; ``capacity`` may be the name of a count.

        ``copies`` are declarations of another owner, by name, that the class declares again.
        """
        cls.key, cls.length = key, length
        # a function in a class would otherwise be a method
        cls.capacity = staticmethod(per(1, capacity) if isinstance(capacity, str) else capacity)
        for name, declared in (copies or {}).items():
            setattr(cls, name, replace(declared, owner=cls))


class Singleton(Owner):
    """Base of the owners of which there is one."""

    def __init_subclass__(cls, key: str) -> None:
        """Set the key, the name of the part in the workspace, from the class statement."""
        cls.key = key


def real(life: Life, unit: str, sentence: str, **options: Any) -> Any:
    """Declare a float. ``options`` are further attributes of the :class:`Declaration`.

    The result is Any, so that a type checker takes ``gap: float = real(...)`` for a float.
    """
    # 0.0 and not 0: a scalar is stored with the type of its value before any run
    return Declaration(float, life, unit, sentence, **{"begin": 0.0, **options})


def vector(life: Life, numbers: int, unit: str, sentence: str, **options: Any) -> Any:
    """Declare ``numbers`` floats of each record that are read and written as a tuple."""
    return Declaration(float, life, unit, sentence, numbers, is_vector=True, **options)


def row(life: Life, numbers: int, unit: str, sentence: str, **options: Any) -> Any:
    """Declare ``numbers`` floats of each record that are read and written one by one."""
    return Declaration(float, life, unit, sentence, numbers, **options)


def whole(life: Life, sentence: str, **options: Any) -> Any:
    """Declare an integer: a count, the number of another record, or an offset in the workspace."""
    return Declaration(int, life, "", sentence, **options)


def address(life: Life, sentence: str, **options: Any) -> Any:
    """Declare the address of a function."""
    return Declaration(int, life, "", sentence, is_address=True, **options)


def question(life: Life, sentence: str, **options: Any) -> Any:
    """Declare a boolean."""
    return Declaration(bool, life, "", sentence, **options)


def one_of(kind: type, life: Life, sentence: str, **options: Any) -> Any:
    """Declare a member of an enumeration."""
    return Declaration(kind, life, "", sentence, **options)


def end_of(start: str, sentence: str, **options: Any) -> Any:
    """Declare the end of the range that begins at ``start``: a view of the start of the next record's range."""
    return Declaration(int, Life.PARAMETER, "", sentence, inside=(start, 1), **options)


def array(life: Life, size: Size, kind: type, unit: str, sentence: str, **options: Any) -> Any:
    """Declare an array of a part, of floats or integers."""
    return Declaration(kind, life, unit, sentence, size=size, **options)


def floats(life: Life, size: Size, unit: str, sentence: str, **options: Any) -> Any:
    """Declare an array of floats of a part."""
    return array(life, size, float, unit, sentence, **options)


def integers(life: Life, size: Size, sentence: str, **options: Any) -> Any:
    """Declare an array of integers of a part."""
    return array(life, size, int, "", sentence, **options)


def declarations(owner: type) -> Mapping[str, Declaration]:
    """Declarations in the class of an owner, by name. The class is searched once, as each layout needs them."""
    if owner not in _declarations:
        _declarations[owner] = {name: value for name, value in vars(owner).items() if isinstance(value, Declaration)}
    return _declarations[owner]


_declarations: dict[type, Mapping[str, Declaration]] = {}
"""The declarations found so far, by owner."""
