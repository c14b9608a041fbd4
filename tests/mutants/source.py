"""Alterations of source text: one operator, constant, member, element or entry at a time.

What is altered, and to what:

comparison   <  <=  >  >=  become their neighbour with or without equality; == != , is, in: negated
logic        and <-> or; `not` dropped
arithmetic   + <-> -, * <-> /; a minus sign dropped
choice       min <-> max, any <-> all
constant     0 -> 1, an index to its neighbour, other integers + 1 (from 10 on: * 1.5), floats
             * 1.5, True <-> False; defaults of arguments and of fields among them
enum member  to the next member of its enumeration
element      removed from a set, from a tuple on the right of `in`, from arguments that are all
             enum members
entry        the value of a mapping's entry to the next different value in that mapping

What is not: docstrings and sentences (formatted strings, `say`), annotations of arguments and
results (those of fields may hold limits), assertions, decorators, base classes, `__str__` and
`__repr__`, and the switches of `zip`, `field` and `sorted`.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, MutableSequence, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, TypeVar, cast

from tests.mutants.mutant import Kind, Mutant

COMPARISONS: Final[Mapping[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
ARITHMETIC: Final[Mapping[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
}
CHOICES: Final = {"min": "max", "max": "min", "any": "all", "all": "any"}
SILENT_CALLS: Final = frozenset({"say", "field", "TypeVar", "NewType"})
SILENT_KEYWORDS: Final = frozenset({"strict", "reverse"})
SILENT_FUNCTIONS: Final = frozenset({"__str__", "__repr__"})
TEXT_MAX: Final = 60
"""The expression around an alteration is shown up to this length."""

Node = TypeVar("Node", bound=ast.AST)

Enums = Mapping[str, tuple[str, ...]]
"""The members of each enumeration, in order."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where the walk is: the scope, the lines that run, the names that a statement defines."""

    scope: tuple[str, ...] = ()
    lines: tuple[int, ...] = ()
    names: tuple[str, ...] = ()
    around: tuple[ast.AST, ...] = ()
    in_function: bool = False


@dataclass(frozen=True, slots=True)
class Site:
    """One alteration: `apply` makes it in the tree that was walked, `undo` takes it back."""

    place: Place
    line: int
    kind: Kind
    before: str
    after: str
    apply: Callable[[], None]


def enums_of(trees: Sequence[ast.Module]) -> dict[str, tuple[str, ...]]:
    """Members of every class whose base is called ...Enum."""
    found = {}
    for tree in trees:
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef) and any(
                isinstance(base, ast.Name) and base.id.endswith("Enum") for base in node.bases
            ):
                found[node.name] = tuple(
                    target.id
                    for line in node.body
                    if isinstance(line, ast.Assign)
                    for target in line.targets
                    if isinstance(target, ast.Name)
                )
    return found


def mutants_of(path: Path, root: Path, module: str, enums: Enums) -> list[Mutant]:
    """Every alteration of one file."""
    file = path.relative_to(root).as_posix()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    met: Counter[str] = Counter()
    mutants = []
    for number, site in enumerate(sites(tree, enums)):
        scope = ".".join(site.place.scope) or "module"
        key = f"{file} {scope}: {site.before} -> {site.after}"
        met[key] += 1
        mutants.append(
            Mutant(
                key if met[key] == 1 else f"{key} #{met[key]}",
                file,
                site.line,
                site.kind,
                site.before,
                site.after,
                number,
                module,
                lines=site.place.lines if site.place.in_function else (),
                names=() if site.place.in_function else site.place.names,
            )
        )
    return mutants


def altered(path: Path, number: int, enums: Enums) -> ast.Module:
    """The tree of `path` with its alteration of that number."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for i, site in enumerate(sites(tree, enums)):
        if i == number:
            site.apply()
            return ast.fix_missing_locations(tree)
    raise IndexError(f"{path} has no alteration {number}")


def sites(tree: ast.Module, enums: Enums) -> Iterator[Site]:
    """Every alteration, in the order of the text; the tree is whole again after each."""
    return _Walk(enums).statements(tree.body, Place())


# ------------------------------------------------------------------------------------- the walk


class _Walk:
    def __init__(self, enums: Enums) -> None:
        self.enums = enums

    def statements(self, body: Sequence[ast.stmt], place: Place) -> Iterator[Site]:
        for statement in body:
            yield from self.statement(statement, place)

    def statement(self, node: ast.stmt, place: Place) -> Iterator[Site]:
        match node:
            case ast.FunctionDef():
                if node.name not in SILENT_FUNCTIONS:
                    yield from self.function(node, place)
            case ast.ClassDef():
                inside = replace(place, scope=(*place.scope, node.name))
                yield from self.statements(node.body, inside)
            case ast.Import() | ast.ImportFrom() | ast.Assert():
                return
            case ast.Expr(value=ast.Constant()):
                return
            case _:
                yield from self.plain(node, place)

    def function(self, node: ast.FunctionDef, place: Place) -> Iterator[Site]:
        scope = (*place.scope, node.name)
        lines = tuple(range(node.body[0].lineno, (node.end_lineno or node.lineno) + 1))
        defaults = replace(place, scope=scope, lines=lines, around=(), in_function=True)
        yield from self.fields(node.args, defaults, ("defaults", "kw_defaults"))
        inside = replace(place, scope=scope, in_function=True)
        yield from self.statements(node.body, inside)

    def plain(self, node: ast.stmt, place: Place) -> Iterator[Site]:
        """A statement that is no definition; of a compound one the head and then its body."""
        names: tuple[str, ...] = ()
        if isinstance(node, ast.Assign):
            names = tuple(
                n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name)
            )
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names = (node.target.id,)
        heads = [f for f in node._fields if f not in ("body", "orelse", "finalbody", "handlers")]
        heads = [f for f in heads if f not in ("cases", "items")]
        last = node.end_lineno or node.lineno
        body = getattr(node, "body", None) or getattr(node, "cases", None)
        if isinstance(body, list):
            first = body[0].pattern if isinstance(body[0], ast.match_case) else body[0]
            last = max(node.lineno, first.lineno - 1)
        lines = tuple(range(node.lineno, last + 1))
        yield from self.fields(node, replace(place, lines=lines, names=names, around=()), heads)
        for part in ("body", "orelse", "finalbody"):
            yield from self.statements(getattr(node, part, []), place)
        for handler in getattr(node, "handlers", []):
            yield from self.statements(handler.body, place)
        for case in getattr(node, "cases", []):
            if case.guard is not None:
                guard_lines = tuple(range(case.guard.lineno, case.guard.end_lineno + 1))
                yield from self.fields(case, replace(place, lines=guard_lines), ("guard",))
            yield from self.statements(case.body, place)

    def fields(self, node: ast.AST, place: Place, names: Sequence[str]) -> Iterator[Site]:
        for name in names:
            value = getattr(node, name)
            if isinstance(value, ast.AST):
                yield from self.expression(value, place, _setter(node, name))
            elif isinstance(value, list):
                for i, item in enumerate(value):
                    if isinstance(item, ast.AST):
                        yield from self.expression(item, place, _list_setter(value, i))

    def expression(
        self, node: ast.AST, place: Place, put: Callable[[ast.AST], None]
    ) -> Iterator[Site]:
        if _is_silent(node):
            return
        if isinstance(node, ast.Lambda):
            lines = tuple(range(node.body.lineno, (node.body.end_lineno or 0) + 1))
            place = replace(place, lines=lines, in_function=True)
        for kind, new in self.alterations(node, place):
            yield _site(node, new, kind, place, put)
        inside = replace(place, around=(*place.around, node))
        match node:
            case ast.Dict(keys, values):
                entries = _all_members([key for key in keys if key is not None])
                for i, value in enumerate(values):
                    if not (entries and _all_members([value])):
                        yield from self.expression(value, inside, _list_setter(values, i))
            case ast.Call(func, args, _) if _takes_members(func, args):
                yield from self.fields(node, inside, ("func", "keywords"))
            case ast.Set(elts) if len(elts) > 1 and _all_members(elts):
                return
            case ast.Tuple(elts) if _right_of_in(node, place) and _all_members(elts):
                return
            case _:
                yield from self.fields(node, inside, node._fields)

    # ------------------------------------------------------------------------ what is altered

    def alterations(self, node: ast.AST, place: Place) -> Iterator[tuple[Kind, ast.AST]]:
        match node:
            case ast.Compare():
                for i, op in enumerate(node.ops):
                    ops = list(node.ops)
                    ops[i] = COMPARISONS[type(op)]()
                    yield Kind.COMPARISON, ast.Compare(node.left, ops, node.comparators)
            case ast.BoolOp(op=op, values=values):
                joint = ast.Or() if isinstance(op, ast.And) else ast.And()
                yield Kind.LOGIC, ast.BoolOp(joint, values)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                yield Kind.LOGIC, operand
            case ast.UnaryOp(op=ast.USub(), operand=operand) if not _is_number(operand):
                yield Kind.ARITHMETIC, operand
            case ast.BinOp(left, op, right) if type(op) in ARITHMETIC:
                if not any(isinstance(side, ast.Set | ast.JoinedStr) for side in (left, right)):
                    yield Kind.ARITHMETIC, ast.BinOp(left, ARITHMETIC[type(op)](), right)
            case ast.Name(id=name) if name in CHOICES and _is_called(node, place):
                yield Kind.CHOICE, ast.Name(CHOICES[name], ast.Load())
            case ast.Constant(value=value) if isinstance(value, bool | int | float):
                other = other_constant(value, index=_is_index(node, place))
                yield Kind.CONSTANT, ast.Constant(other)
            case ast.Attribute(value=ast.Name(id=enum), attr=name) if name in self._members(enum):
                members = self.enums[enum]
                after = members[(members.index(name) + 1) % len(members)]
                yield Kind.MEMBER, ast.Attribute(ast.Name(enum, ast.Load()), after, ast.Load())
            case ast.Set(elts) if len(elts) > 1:
                for i in range(len(elts)):
                    yield Kind.ELEMENT, ast.Set(_without(elts, i))
            case ast.Tuple(elts) if len(elts) > 1 and _right_of_in(node, place):
                for i in range(len(elts)):
                    yield Kind.ELEMENT, ast.Tuple(_without(elts, i), ast.Load())
            case ast.Call(func, args, keywords) if _takes_members(func, args):
                for i in range(len(args)):
                    yield Kind.ELEMENT, ast.Call(func, _without(args, i), keywords)
            case ast.Dict(keys, values) if _all_members([k for k in keys if k is not None]):
                for i in range(len(values)):
                    other_value = _next_different(values, i)
                    if keys[i] is not None and other_value is not None:
                        changed = list(values)
                        changed[i] = other_value
                        yield Kind.ENTRY, ast.Dict(keys, changed)

    def _members(self, enum: str) -> tuple[str, ...]:
        members = self.enums.get(enum, ())
        return members if len(members) > 1 else ()


def _site(
    node: ast.AST, new: ast.AST, kind: Kind, place: Place, put: Callable[[ast.AST], None]
) -> Site:
    before, after = _difference(node, new)
    outer = node if kind in (Kind.ELEMENT, Kind.ENTRY) else _shown(node, place)
    if outer is not node:
        before = ast.unparse(outer)
        put(new)
        after = ast.unparse(outer)
        put(node)
    ast.copy_location(new, node)
    return Site(place, getattr(node, "lineno", 0), kind, before, after, lambda: put(new))


def _shown(node: ast.AST, place: Place) -> ast.AST:
    """The largest expression around `node` that is still short."""
    shown = node
    for outer in reversed(place.around):
        if not isinstance(outer, ast.expr | ast.keyword):
            break
        if (outer.end_lineno or 0) - outer.lineno > 2 or len(ast.unparse(outer)) > TEXT_MAX:
            break
        shown = outer
    return shown


def _difference(node: ast.AST, new: ast.AST) -> tuple[str, str]:
    """The two as text; of long lists and mappings only what differs."""
    match node, new:
        case ast.Dict(keys, values), ast.Dict(_, changed):
            for key, value, other in zip(keys, values, changed, strict=True):
                if value is not other and key is not None:
                    name = ast.unparse(key)
                    return f"{name}: {ast.unparse(value)}", f"{name}: {ast.unparse(other)}"
        case (ast.Set(elts), ast.Set(rest)) | (ast.Tuple(elts), ast.Tuple(rest)):
            (gone,) = [e for e in elts if e not in rest]
            return f"with {ast.unparse(gone)}", "without"
        case ast.Call(func, args, _), ast.Call(_, rest, _):
            (gone,) = [e for e in args if e not in rest]
            return f"{ast.unparse(func)} with {ast.unparse(gone)}", "without"
        case _:
            pass
    return ast.unparse(node), ast.unparse(new)


def other_constant(value: bool | int | float, *, index: bool = False) -> bool | int | float:
    if isinstance(value, bool):
        return not value
    if value == 0:
        return type(value)(1)
    if isinstance(value, float):
        return value * 1.5
    if index:
        return value - 1
    return value + 1 if value < 10 else value + value // 2


def _next_different(values: Sequence[ast.expr], i: int) -> ast.expr | None:
    """The next value, around the end, that is another; None for sentences."""
    if isinstance(values[i], ast.Constant | ast.JoinedStr):
        return None
    own = ast.dump(values[i])
    order = [*values[i + 1 :], *values[:i]]
    return next((value for value in order if ast.dump(value) != own), None)


def _is_silent(node: ast.AST) -> bool:
    match node:
        case ast.JoinedStr():
            return True
        case ast.keyword(arg=name):
            return name in SILENT_KEYWORDS
        case ast.Subscript(value=ast.Name(id=name)):
            return name == "Literal"
        case ast.Call(func=ast.Attribute(attr=name)) | ast.Call(func=ast.Name(id=name)):
            return name in SILENT_CALLS
        case _:
            return False


def _is_number(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant)


def _is_called(node: ast.AST, place: Place) -> bool:
    return bool(place.around) and getattr(place.around[-1], "func", None) is node


def _is_index(node: ast.AST, place: Place) -> bool:
    return bool(place.around) and getattr(place.around[-1], "slice", None) is node


def _right_of_in(node: ast.AST, place: Place) -> bool:
    outer = place.around[-1] if place.around else None
    if not isinstance(outer, ast.Compare):
        return False
    pairs = zip(outer.ops, outer.comparators, strict=True)
    return any(right is node and isinstance(op, ast.In | ast.NotIn) for op, right in pairs)


def _all_members(nodes: Sequence[ast.expr]) -> bool:
    """Each is written as `Name.MEMBER`."""
    return bool(nodes) and all(
        isinstance(n, ast.Attribute) and isinstance(n.value, ast.Name) and n.attr.isupper()
        for n in nodes
    )


def _takes_members(func: ast.expr, args: Sequence[ast.expr]) -> bool:
    """A call of a function (not of a class) with several enum members and nothing else."""
    name = func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")
    return len(args) > 1 and _all_members(args) and name.lstrip("_")[:1].islower()


def _without(items: Sequence[ast.expr], i: int) -> list[ast.expr]:
    return [*items[:i], *items[i + 1 :]]


def _setter(node: ast.AST, name: str) -> Callable[[ast.AST], None]:
    return lambda new: setattr(node, name, new)


def _list_setter(items: MutableSequence[Node], i: int) -> Callable[[ast.AST], None]:
    """Puts in what the grammar allows there: an expression for an expression."""

    def put(new: ast.AST) -> None:
        items[i] = cast(Node, new)

    return put
