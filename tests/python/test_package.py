# SPDX-License-Identifier: MIT
"""What editors and help() show: stubs that name everything, docstrings with units."""
import ast
import enum
import inspect
from pathlib import Path

import pytest

import pinnquad
from pinnquad import _core

PACKAGE = Path(pinnquad.__file__).parent


def stubbed():
    """Names of the stub, and of each of its classes."""
    names = {}
    for node in ast.parse((PACKAGE / "_core.pyi").read_text()).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            members = getattr(node, "body", []) if isinstance(node, ast.ClassDef) else []
            names[node.name] = {m.name if isinstance(m, ast.FunctionDef) else
                                (m.target if isinstance(m, ast.AnnAssign) else m.targets[0]).id
                                for m in members if isinstance(m, (ast.FunctionDef, ast.AnnAssign, ast.Assign))}
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = set()
    return names


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


def test_the_stub_names_everything():
    assert (PACKAGE / "py.typed").exists()
    names = stubbed()
    assert public(_core) <= set(names)
    for name, members in names.items():
        thing = getattr(_core, name)
        if not inspect.isclass(thing) or name in ("Error", "FlightEnded"):
            continue
        ours = public(thing) - {"name", "value"} if name in ("Spin", "Status") else public(thing)
        assert ours == {member for member in members if not member.startswith("_")}, name


@pytest.mark.parametrize("name", pinnquad.__all__)
def test_everything_is_documented(name):
    thing = getattr(pinnquad, name)
    if name == "ground_effects":
        return
    assert len(thing.__doc__) > 20
    for member in public(thing) if inspect.isclass(thing) else ():
        value = inspect.getattr_static(thing, member)
        if callable(getattr(thing, member)) or isinstance(value, property):
            of = value if isinstance(value, property) else getattr(thing, member)
            documented = of.__doc__ or getattr(getattr(of, "fget", None), "__doc__", None)
            assert documented or member in ("name", "effects", "feature_names"), f"{name}.{member}"


@pytest.mark.parametrize("name", pinnquad.__all__)
def test_signatures(name):
    """inspect.signature() knows every function, class and method, with the stub's arguments and defaults."""
    thing = getattr(pinnquad, name)
    made_by_others = ("Error", "FlightEnded", "Identification", "Model", "Rotor", "Training")  # not by a call
    if callable(thing) and name not in made_by_others and not issubclass(type(thing), enum.EnumMeta):
        assert "self" not in inspect.signature(thing).parameters, name
    for member in public(thing) if inspect.isclass(thing) else ():
        value = getattr(thing, member)
        if callable(value) and not isinstance(value, thing):
            signature = inspect.signature(value)
            static = isinstance(inspect.getattr_static(thing, member), (staticmethod, classmethod))
            assert static or next(iter(signature.parameters)) == "self", f"{name}.{member}"


def test_signatures_are_those_of_the_stub():
    for node in ast.parse((PACKAGE / "_core.pyi").read_text()).body:
        members = node.body if isinstance(node, ast.ClassDef) else [node]
        for member in members:
            if not isinstance(member, ast.FunctionDef) or (member.name.startswith("__") and member.name != "__init__"):
                continue
            owner = getattr(_core, node.name) if isinstance(node, ast.ClassDef) else _core
            if isinstance(inspect.getattr_static(owner, member.name), property):
                continue
            real = inspect.signature(getattr(owner, member.name))
            arguments = member.args.posonlyargs + member.args.args + member.args.kwonlyargs
            assert [one.arg for one in arguments] == list(real.parameters), f"{node.name}.{member.name}"
            defaults = [None] * (len(member.args.args) - len(member.args.defaults)) + member.args.defaults + member.args.kw_defaults
            for one, default in zip(arguments, defaults):
                found = real.parameters[one.arg].default
                if default is None:
                    assert found is inspect.Parameter.empty, f"{node.name}.{member.name}: {one.arg}"
                else:
                    wanted = ast.literal_eval(default)
                    assert found == wanted or list(found) == list(wanted), f"{node.name}.{member.name}: {one.arg}"
