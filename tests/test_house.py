"""The plan of the house: imports run downwards, rooms are small, names say what is inside."""

import ast
from pathlib import Path

import pytest

import propmdao

# Imports run from a floor to lower ones, never up or across.
FLOORS = [
    {"runtime"},
    {"records"},
    {"propeller"},
    {"geometry"},
    {"aerodynamics", "acoustics", "structures"},
    {"formats"},
    {"analysis"},
    {"figures", "components"},
    {"commands", "studies"},
]
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
MOST_MODULES = 12
MOST_ARGUMENTS = 7


@pytest.fixture(scope="module")
def modules(checkout: Path) -> dict[str, ast.Module]:
    """Source of every module by its dotted name; studies as `studies.name`."""
    found = {}
    for folder, package in (
        ("propmdao", "propmdao"),
        ("components", "propmdao.components"),
        ("studies", "studies"),
    ):
        for path in sorted((checkout / folder).rglob("*.py")):
            inside = path.relative_to(checkout / folder).with_suffix("").parts
            if folder == "propmdao" and inside[0] == "components":
                continue  # the same files as components/, through the link
            name = ".".join((package, *inside)).removesuffix(".__init__")
            if name == "propmdao.__main__":
                continue  # the front door of the command line, as propmdao itself is of scripts
            found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def imports(tree: ast.Module) -> list[str]:
    """Modules of ours that a module imports, wherever in it."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return [name for name in names if name.startswith("propmdao.")]


def room_of(name: str) -> str:
    parts = name.removesuffix(".__main__").split(".")
    return parts[0] if parts[0] == "studies" else (parts[1] if len(parts) > 1 else "")


def test_there_are_at_most_twelve_rooms_and_each_has_its_floor(modules):
    rooms = {room_of(name) for name in modules} - {""}
    assert rooms == FLOOR.keys()
    assert len(rooms - {"studies"}) <= 12


def test_imports_run_downwards_only(modules):
    upwards = [
        f"{name} imports {imported}"
        for name, tree in modules.items()
        if room_of(name)  # the front door opens every room, when a name is used
        for imported in imports(tree)
        if room_of(imported) in FLOOR
        and room_of(imported) != room_of(name)
        and FLOOR[room_of(imported)] >= FLOOR[room_of(name)]
    ]
    assert not upwards


def test_no_circle_of_imports_between_the_folders_of_a_room(modules):
    """Folder by folder: what stands beside each other in a room has an order, too."""
    beside: dict[str, dict[str, set[str]]] = {}
    for name, tree in modules.items():
        if name == "propmdao":
            continue
        for imported in imports(tree):
            a, b = name.split("."), imported.split(".")
            while b and ".".join(b) not in modules:
                b = b[:-1]
            common = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), None)
            if common:
                folder = ".".join(a[:common])
                beside.setdefault(folder, {}).setdefault(a[common], set()).add(b[common])
    for folder, graph in beside.items():
        left = {name: set(needs) for name, needs in graph.items()}
        while left:
            free = [name for name, needs in left.items() if not needs & left.keys()]
            assert free, f"{folder}: {left} import each other in a circle"
            for name in free:
                del left[name]


def test_folders_have_at_most_a_dozen_modules(modules):
    count: dict[str, int] = {}
    for name in modules:
        if name not in ("propmdao", "propmdao.components"):
            folder = name.rpartition(".")[0]
            count[folder] = count.get(folder, 0) + 1
    assert {folder: n for folder, n in count.items() if n > MOST_MODULES} == {}


def test_modules_are_not_named_like_their_folder_or_the_front_door(modules):
    wrong = [
        name
        for name in modules
        if len(name.split(".")) > 2
        and (name.split(".")[-1] == name.split(".")[-2] or name.split(".")[-1] in propmdao.__all__)
    ]
    assert not wrong


def test_functions_take_at_most_seven_arguments(modules):
    """Who needs more lacks a record; compiled kernels take arrays."""
    wide = []
    for name, tree in modules.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and not any(
                "compiled" in ast.unparse(decorator) for decorator in node.decorator_list
            ):
                arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                names = [a.arg for a in arguments if a.arg not in ("self", "cls")]
                if len(names) > MOST_ARGUMENTS:
                    wide.append(f"{name}.{node.name}: {len(names)}")
    assert not wide


def test_whoever_imports_jax_has_it_set_up(modules):
    """64-bit floats have to be asked for before the first array is made."""
    needs = {
        name: {
            module
            for imported in imports(tree)
            for module in (imported, imported.rpartition(".")[0])
            if module in modules
        }
        | {name.rsplit(".", k)[0] for k in range(1, name.count(".") + 1)}
        for name, tree in modules.items()
    }
    needs["propmdao"] = set()  # nothing is imported before it is used
    for name, tree in modules.items():
        reached, left = {name}, [name]
        while left:
            new = needs.get(left.pop(), set()) - reached
            reached |= new
            left += new
        if "jax" in _roots(tree):
            assert "propmdao.runtime.jax_setup" in reached, name


def _roots(tree: ast.Module) -> list[str]:
    """Packages that a module imports from."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names.append(node.module or "")
    return [name.split(".")[0] for name in names]


def test_linear_systems_are_solved_in_one_place(modules):
    """Batches of JAX's own functions can wait for each other for ever, see `linear_algebra`."""
    harmless = {"norm", "cross", "matrix_norm", "vector_norm"}
    found = [
        f"{name}: {ast.unparse(node)}"
        for name, tree in modules.items()
        if name != "propmdao.runtime.linear_algebra"
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and ast.unparse(node.value) in {"jnp.linalg", "jax.numpy.linalg", "jax.lax.linalg"}
        and node.attr not in harmless
        or isinstance(node, ast.ImportFrom)
        and (node.module or "").startswith(("jax.scipy", "jax.numpy.linalg", "jax.lax.linalg"))
    ]
    assert not found
