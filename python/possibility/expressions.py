"""Functions of quantities, as expressions that C++ evaluates and differentiates exactly.

The functions below take numbers, arrays and expressions; NumPy's do as well.
"""

from __future__ import annotations

import math
import numbers
from typing import Any, Callable, Dict, Hashable, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _possibility as _ext

Operand = Union["Expression", float]

# Our operations are named like NumPy's functions, apart from these.
_BINARY = ("add", "subtract", "multiply", "divide", "arctan2")
_UNARY = ("negative", "sin", "cos", "tan", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh",
          "exp", "log", "sqrt", "absolute")


class Expression:
    """A number that depends on the quantities of a problem."""

    __slots__ = ("_operation", "_operands", "_constant")

    def __init__(self, operation: str, operands: Tuple["Expression", ...] = (),
                 constant: float = 0.0):
        self._operation = operation
        self._operands = operands
        self._constant = constant

    def __add__(self, other: Any) -> Any:
        return _binary("add", self, other)

    def __radd__(self, other: Any) -> Any:
        return _binary("add", other, self)

    def __sub__(self, other: Any) -> Any:
        return _binary("subtract", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _binary("subtract", other, self)

    def __mul__(self, other: Any) -> Any:
        return _binary("multiply", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _binary("multiply", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _binary("divide", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _binary("divide", other, self)

    def __pow__(self, other: Any) -> Any:
        return _binary("power", self, other)

    def __rpow__(self, other: Any) -> Any:
        return _binary("power", other, self)

    def __neg__(self) -> "Expression":
        return Expression("negative", (self,))

    def __pos__(self) -> "Expression":
        return self

    def __abs__(self) -> "Expression":
        return Expression("absolute", (self,))

    def __bool__(self) -> bool:
        raise TypeError("an expression has no value yet, so code cannot branch on it")

    def __float__(self) -> float:
        raise TypeError("an expression has no value yet: use functions that take expressions, "
                        "such as numpy.sin")

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            return NotImplemented
        if any(isinstance(each, np.ndarray) and each.ndim > 0 for each in inputs):
            return _elementwise(ufunc, inputs)
        return _apply(ufunc.__name__, inputs)

    def __repr__(self) -> str:
        if self._operation == "constant":
            return f"{self._constant:g}"
        return f"{self._operation}({', '.join(map(repr, self._operands))})"


class Leaf(Expression):
    """A quantity of a problem."""

    __slots__ = ("variable", "key", "name", "share")

    def __init__(self, variable: _ext.Variable, name: str, share: Optional[float] = None):
        super().__init__("input")
        self.variable = variable
        self.key: Hashable = (variable.key, share)
        self.name = name
        self.share = share
        """At which share of its phase's duration; None: at every instant."""

    def at(self, when: Union[str, float]) -> "Leaf":
        """The quantity at the start, the end, or a share of its phase's duration."""
        share = {"start": 0.0, "end": 1.0}.get(when) if isinstance(when, str) else float(when)
        if share is None or not 0 <= share <= 1:
            raise ValueError(f"at: expected 'start', 'end' or a share from 0 to 1, got {when!r}")
        return Leaf(self.variable, self.name, share)

    def __repr__(self) -> str:
        return self.name if self.share is None else f"{self.name}.at({self.share:g})"


def _elementwise(ufunc: np.ufunc, inputs: Sequence[Any]) -> np.ndarray:
    arrays = np.broadcast_arrays(*[_object_array(each) for each in inputs])
    result = np.empty(arrays[0].shape, dtype=object)
    for index in np.ndindex(result.shape):
        result[index] = _apply(ufunc.__name__, [array[index] for array in arrays])
    return result


def _object_array(value: Any) -> np.ndarray:
    if isinstance(value, np.ndarray):
        return value.astype(object)
    array = np.empty((), dtype=object)
    array[()] = value
    return array


_OTHER_NAMES: Dict[str, str] = {"true_divide": "divide", "float_power": "power", "abs": "absolute",
                                "fabs": "absolute"}


def _apply(name: str, operands: Sequence[Any]) -> Any:
    name = _OTHER_NAMES.get(name, name)
    operands = [each.item() if isinstance(each, np.ndarray) and each.ndim == 0 else each
                for each in operands]
    if name in _UNARY:
        return _unary(name, operands[0])
    if name in _BINARY or name == "power":
        return _binary(name, *operands)
    if name == "square":
        return operands[0] * operands[0]
    if name == "reciprocal":
        return 1 / operands[0]
    if name == "positive":
        return operands[0]
    raise TypeError(f"an expression has no function '{name}', expected an arithmetic operator or "
                    f"one of {', '.join(_UNARY + _BINARY)}, power, square, reciprocal")


def as_expression(value: Any) -> Expression:
    """A number as an expression; expressions as they are."""
    if isinstance(value, Expression):
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return as_expression(value.item())
    if isinstance(value, (numbers.Real, np.number)) and not isinstance(value, (bool, np.bool_)):
        number = float(value)
        if math.isfinite(number):
            return Expression("constant", constant=number)
        raise ValueError(f"expected a finite number or an expression, got {number}")
    raise TypeError(f"expected a number or an expression, got {type(value).__name__}")


def _binary(name: str, a: Any, b: Any) -> Any:
    for each in (a, b):
        if isinstance(each, np.ndarray) and each.ndim > 0:
            return _elementwise(getattr(np, name), (a, b))
    a, b = as_expression(a), as_expression(b)
    if name != "power":
        return Expression(name, (a, b))
    if b._operation != "constant":
        return Expression("exponentiate", (a, b))
    return a * a if b._constant == 2 else Expression("power", (a,), b._constant)


def _unary(name: str, a: Any) -> Any:
    return Expression(name, (as_expression(a),))


def _function(name: str) -> Callable[[Any], Any]:
    ufunc = getattr(np, name)

    def function(x: Any) -> Any:
        return _unary(name, x) if isinstance(x, Expression) else ufunc(x)

    function.__name__ = name
    function.__doc__ = ufunc.__doc__.splitlines()[2] if ufunc.__doc__ else None
    return function


sin, cos, tan = _function("sin"), _function("cos"), _function("tan")
arcsin, arccos, arctan = _function("arcsin"), _function("arccos"), _function("arctan")
sinh, cosh, tanh = _function("sinh"), _function("cosh"), _function("tanh")
exp, log, sqrt = _function("exp"), _function("log"), _function("sqrt")

# NumPy calls these methods of the elements of arrays of objects.
for _name in _UNARY:
    if _name not in ("negative", "absolute"):
        setattr(Expression, _name, (lambda name: lambda self: _unary(name, self))(_name))
Expression.arctan2 = lambda self, x: _binary("arctan2", self, x)  # type: ignore[attr-defined]


def arctan2(y: Any, x: Any) -> Any:
    """The angle of (x, y), rad."""
    return np.arctan2(y, x)


def smooth_max(a: Operand, b: Operand, width: float) -> Any:
    """The greater of two, rounded off where they are closer than about `width`, and above both."""
    return 0.5 * (a + b + sqrt((a - b) ** 2 + width * width))


def smooth_min(a: Operand, b: Operand, width: float) -> Any:
    """The smaller of two likewise, and below both."""
    return 0.5 * (a + b - sqrt((a - b) ** 2 + width * width))


class Tape:
    """Expressions as a list of operations; equal operations on equal operands occur once."""

    def __init__(self, outputs: Sequence[Expression]):
        self.leaves: List[Leaf] = []
        self._rows: List[Tuple[str, int, int, float]] = []
        self._index: Dict[Hashable, int] = {}
        self._seen: Dict[int, int] = {}
        places = [self._place(output) for output in outputs]
        self.tape = _ext.Tape(len(self.leaves), self._rows, places)

    def __len__(self) -> int:
        return len(self._rows)

    def _place(self, root: Expression) -> int:
        # Without recursion: sums may be long.
        stack = [root]
        while stack:
            expression = stack[-1]
            missing = [each for each in expression._operands if id(each) not in self._seen]
            if missing:
                stack.extend(reversed(missing))
                continue
            stack.pop()
            if id(expression) not in self._seen:
                self._seen[id(expression)] = self._add(expression)
        return self._seen[id(root)]

    def _add(self, expression: Expression) -> int:
        operands = [self._seen[id(each)] for each in expression._operands]
        first, second = (operands + [0, 0])[:2]
        row = (expression._operation, first, second, expression._constant)
        key: Hashable = expression.key if isinstance(expression, Leaf) else row
        if key not in self._index:
            if isinstance(expression, Leaf):
                row = ("input", len(self.leaves), 0, 0.0)
                self.leaves.append(expression)
            self._index[key] = len(self._rows)
            self._rows.append(row)
        return self._index[key]


def evaluate(expression: Any, value_of: Callable[[Leaf], Any]) -> Any:
    """An expression's value by NumPy, given those of its leaves."""
    root = as_expression(expression)
    values: Dict[int, Any] = {}
    stack = [root]
    while stack:
        each = stack[-1]
        missing = [operand for operand in each._operands if id(operand) not in values]
        if missing:
            stack.extend(reversed(missing))
            continue
        stack.pop()
        values[id(each)] = _value(each, [values[id(operand)] for operand in each._operands],
                                  value_of)
    return values[id(root)]


def _value(expression: Expression, operands: Sequence[Any], value_of: Callable[[Leaf], Any]) -> Any:
    if isinstance(expression, Leaf):
        return value_of(expression)
    if expression._operation == "constant":
        return expression._constant
    if expression._operation == "power":
        return np.power(operands[0], expression._constant)
    name = "power" if expression._operation == "exponentiate" else expression._operation
    return getattr(np, name)(*operands)
