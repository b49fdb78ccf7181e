"""Values that public functions and types refuse, in one line, and those that they convert exactly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.voxelize import (
    EMPTY,
    Appearance,
    BoxCollider,
    Grid,
    HullCollider,
    Material,
    Mesh,
    MeshCollider,
    PointLight,
    Scene,
    SceneObject,
    SphereCollider,
    SurfaceAppearance,
    Texture,
    Viewpoint,
    arguments,
    assign_colours,
    authoring,
    fit_grid,
    load,
    voxelize,
)

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
MESH = Mesh(CORNERS, [[0, 1, 2]], [1])
SCENE = Scene("test", [SceneObject("a", MESH)], [EMPTY, Material("m", (1, 2, 3))])
GRID = Grid(2, (0, 0, 0), 0.25)
NAN = float("nan")


def mesh_with(appearance):
    return Mesh(CORNERS, [[0, 1, 2]], [1], appearance)


TYPE_ERRORS = [
    (lambda: Material(3, (0, 0, 0)), "Material.name must be a string, not 3"),
    (lambda: Material("a", (0.5, 0.5, 1.0)), "three integers 0 … 255, not (0.5, 0.5, 1.0): multiply by 255"),
    (lambda: Material("a", (1.0, 0.0, 0.0)), "multiply by 255 and round"),
    (lambda: Material("a", "#ffffff"), "Material.colour must be three integers"),
    (lambda: Material("a", (1, 2, 3), mirror=1), "Material.mirror must be True or False, not 1"),
    (lambda: Mesh([["a"] * 3], [[0, 0, 0]], [1]), "Mesh.positions must be an array of real numbers, not of text"),
    (lambda: Mesh(CORNERS, [[0, 1, 2]], [True]), "Mesh.materials must be an array of integers, not of booleans"),
    (lambda: mesh_with("red"), "Mesh.appearance must be a SurfaceAppearance, not str"),
    (lambda: SceneObject("a", CORNERS), "SceneObject.mesh must be a Mesh, not list"),
    (lambda: SceneObject("a", MESH, colliders=[1]), "SceneObject.colliders[0] must be a collider, not int"),
    (lambda: Scene("a", [MESH], [EMPTY]), "Scene.objects[0] must be a SceneObject, not Mesh"),
    (lambda: Grid("3", (0, 0, 0), 1), "Grid.depth must be an integer 1 … 16, not '3'"),
    (lambda: fit_grid(SCENE, depth=True), "depth must be an integer 1 … 16, not True"),
    (lambda: fit_grid(MESH, depth=3), "scene must be a Scene, not Mesh"),
    (lambda: voxelize(SCENE, 3), "grid must be a Grid, not int"),
    (lambda: load(3), "path must be a string or a Path, not 3"),
    (lambda: load("a.glb", animation=1), "animation must be a string, not 1"),
    (lambda: load("a.glb", variants="red"), "variants must be a sequence of strings, not a string: pass ('red',)"),
    (lambda: authoring.sphere("1"), "radius must be a finite number, not '1'"),
    (lambda: authoring.Author("a").material("m", (0.5, 0, 0)), "multiply by 255 and round"),
    (lambda: authoring.Author("a").add("b", MESH), "solid must be a Solid, not Mesh"),
    (lambda: authoring.Author("a").add_asset("b", MESH, np.eye(4)), "asset must be a Scene, not Mesh"),
]
VALUE_ERRORS = [
    (lambda: Material("a", (1, 2, 256)), "Material.colour must be three integers 0 … 255"),
    (lambda: Material("a", (1, 2)), "Material.colour must be three integers 0 … 255, not (1, 2)"),
    (lambda: Mesh([[0, 0], [1, 1]], [[0, 1, 1]], [1]), "Mesh.positions must have shape (V, 3), not (2, 2)"),
    (lambda: Mesh([[0, 0, 0], [1]], [[0, 0, 0]], [1]), "Mesh.positions must be an array of real numbers: its rows"),
    (lambda: Mesh([[0, 0, NAN], *CORNERS], [[0, 1, 2]], [1]), "Mesh.positions[0] must be finite, not [0.0, 0.0, nan]"),
    (lambda: Mesh([[0, 0, np.inf], *CORNERS], [[0, 1, 2]], [1]), "Mesh.positions[0] must be finite"),
    (lambda: Mesh(CORNERS, [[0, 1, 3]], [1]), "Mesh.triangles[0, 2] must be an integer 0 … 2, not 3"),
    (lambda: Mesh(CORNERS, [[0, 1, -1]], [1]), "Mesh.triangles[0, 2] must be an integer 0 … 2, not -1"),
    (lambda: Mesh(CORNERS, [[0, 1, 0.5]], [1]), "Mesh.triangles[0, 2] must be an integer 0 … 2, not 0.5"),
    (lambda: Mesh([], [[0, 0, 0]], [1]), "Mesh.positions has no vertices"),
    (lambda: Mesh(CORNERS, [[0, 1, 2]], [300]), "Mesh.materials[0] must be an integer 1 … 255, not 300"),
    (lambda: Mesh(CORNERS, [[0, 1, 2]], [0]), "Mesh.materials[0] must be an integer 1 … 255, not 0"),
    (lambda: Mesh(CORNERS, [[0, 1, 2]], [1, 1]), "Mesh.materials must have shape (1,), not (2,)"),
    (
        lambda: mesh_with(SurfaceAppearance([Appearance("a")], [0, 0], np.zeros((2, 3, 2)), np.ones((2, 3, 4)))),
        "Mesh.appearance is for 2 triangles, and the mesh has 1",
    ),
    (
        lambda: SurfaceAppearance([Appearance("a")], [1], np.zeros((1, 3, 2)), np.ones((1, 3, 4))),
        "SurfaceAppearance.rows[0] must be an integer -1 … 0, not 1",
    ),
    (lambda: Appearance("a", factor=(1, 1, 1)), "Appearance.factor must have shape (4,), not (3,)"),
    (lambda: Texture(np.zeros((2, 2, 3), np.uint8)), "Texture.pixels must have shape (H, W, 4)"),
    (lambda: Texture(np.full((1, 1, 4), 0.5)), "Texture.pixels[0, 0, 0] must be an integer 0 … 255, not 0.5"),
    (lambda: Texture(np.zeros((1, 1, 4)), ("repeat", "x")), "Texture.wrap must be 'repeat', 'mirror' or 'clamp'"),
    (lambda: BoxCollider([0, 0], [1, 1, 1]), "BoxCollider.minimum must have shape (3,), not (2,)"),
    (lambda: BoxCollider([2, 0, 0], [1, 1, 1]), "is below its minimum"),
    (lambda: BoxCollider([0, 0, 0], [1, 1, NAN]), "BoxCollider.maximum[2] must be a finite number"),
    (lambda: SphereCollider([0, 0, 0], -1), "SphereCollider.radius must not be negative"),
    (lambda: SphereCollider([0, 0, 0], np.inf), "SphereCollider.radius must be a finite number"),
    (lambda: HullCollider([]), "HullCollider.positions must hold one point or more"),
    (lambda: MeshCollider(CORNERS, [[0, 1, 9]]), "MeshCollider.triangles[0, 2] must be an integer 0 … 2"),
    (lambda: SceneObject("a", MESH, np.eye(3)), "SceneObject.transform must have shape (4, 4), not (3, 3)"),
    (lambda: SceneObject("a", MESH, np.eye(4) * NAN), "SceneObject.transform[0, 0] must be a finite number"),
    (lambda: SceneObject("a", MESH, np.ones((4, 4))), "SceneObject.transform must be affine"),
    (lambda: SceneObject("a", MESH, collider_material=300), "must be an integer 1 … 255, not 300"),
    (lambda: Viewpoint((0, 0, 0), (0, 0, 0)), "Viewpoint.eye and Viewpoint.target must differ"),
    (lambda: Viewpoint((0, 0, 0), (0, 0, 1), 180), "above 0 and below 180, not 180"),
    (lambda: PointLight((0, 0)), "PointLight.position must have shape (3,), not (2,)"),
    (lambda: Scene("a", [SceneObject("b", MESH)], [EMPTY]), "object 'b' uses material 1"),
    (lambda: Scene("a", [], []), "Scene.materials must have 1 … 256 entries, not 0"),
    (lambda: Scene("a", [], [EMPTY] * 257), "Scene.materials must have 1 … 256 entries, not 257"),
    (lambda: Grid(17, (0, 0, 0), 1), "Grid.depth must be an integer 1 … 16, not 17"),
    (lambda: Grid(2.5, (0, 0, 0), 1), "Grid.depth must be an integer 1 … 16, not 2.5"),
    (lambda: Grid(3, (0, 0, 0), 0), "Grid.voxel_size must be a finite number above 0, not 0"),
    (lambda: Grid(3, (0, 0, NAN), 1), "Grid.origin[2] must be a finite number, not nan"),
    (lambda: fit_grid(SCENE), "one of depth and voxel_size"),
    (lambda: fit_grid(SCENE, depth=3, voxel_size=1), "one of depth and voxel_size"),
    (lambda: fit_grid(SCENE, depth=0), "depth must be an integer 1 … 16, not 0"),
    (lambda: fit_grid(SCENE, voxel_size=-1), "voxel_size must be a finite number above 0, not -1"),
    (lambda: fit_grid(SCENE, depth=3, geometry="x"), "geometry must be 'auto', 'render' or 'collider', not 'x'"),
    (lambda: fit_grid(SCENE, depth=3, pow2="x"), "pow2 must be 'box' or 'none', not 'x'"),
    (lambda: voxelize(SCENE, GRID, fill="x"), "fill must be 'solid', 'surface' or 'auto', not 'x'"),
    (lambda: voxelize(SCENE, GRID, geometry="x"), "geometry must be 'auto', 'render' or 'collider'"),
    (lambda: voxelize(SCENE, GRID, pow2=True), "pow2 must be 'box' or 'none', not True"),
    (lambda: voxelize(SCENE, GRID, threads=-1), "threads must be an integer 0 … 1024, not -1"),
    (lambda: assign_colours(SCENE, GRID, colours=2.5), "colours must be an integer 1 … 254, not 2.5"),
    (lambda: assign_colours(SCENE, GRID, geometry="x"), "geometry must be 'auto', 'render' or 'collider'"),
    (lambda: load("a.obj", up="w"), "up must be 'x', 'y' or 'z', not 'w'"),
    (lambda: load("a.obj", unit=0), "unit must be a finite number from 1e-12 to 1e+12, not 0"),
    (lambda: load("a.glb", time=NAN), "time must be a finite number, not nan"),
    (lambda: authoring.box((1, 1, 1), centre=(0, NAN, 0)), "centre[1] must be a finite number, not nan"),
    (lambda: authoring.cylinder(1, 1, axis="w"), "axis must be 'x', 'y' or 'z', not 'w'"),
    (lambda: authoring.extrude([(0, 0, 0)] * 3, 1), "outline must have shape (N, 2), not (3, 3)"),
    (lambda: authoring.Author("a").material("m", "#000000", number=1.5), "number must be an integer 1 … 255"),
    (
        lambda: authoring.Author("a").add("b", authoring.box((1, 1, 1)), collider="x"),
        "collider must be 'box', 'sphere', 'hull' or 'mesh', not 'x'",
    ),
]


def refused(call, error, message):
    with pytest.raises(error) as caught:
        call()
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    return type(caught.value)


@pytest.mark.parametrize(("call", "message"), TYPE_ERRORS)
def test_the_wrong_kind_of_value_is_refused(call, message):
    assert refused(call, TypeError, message) is TypeError


@pytest.mark.parametrize(("call", "message"), VALUE_ERRORS)
def test_values_out_of_range_are_refused(call, message):
    found = refused(call, ValueError, message)
    assert found.__mro__.index(ValueError) <= 2  # ValueError itself, or an error of authoring


def test_exact_conversions():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0.0, 1.0, 2.0]], np.array([3], np.int64))
    assert (mesh.positions.dtype, mesh.triangles.dtype, mesh.materials.dtype) == (np.float64, np.int32, np.uint8)
    assert Mesh([], [], []).triangles.shape == (0, 3)
    assert Grid(3.0, [0, 1, 2], np.float32(0.5)) == Grid(3, (0.0, 1.0, 2.0), 0.5)
    assert Material("a", np.array([1, 2, 3], np.uint8)) == Material("a", (1, 2, 3))
    assert fit_grid(SCENE, depth=np.int64(3)) == fit_grid(SCENE, depth=3.0)
    assert BoxCollider((0, 0, 0), (1, 1, 1)).minimum.dtype == np.float64


def test_arrays_of_the_right_type_are_not_copied():
    positions, triangles = np.zeros((3, 3), np.float32), np.zeros((1, 3), np.int32)
    materials = np.ones(1, np.uint8)
    mesh = Mesh(positions, triangles, materials)
    assert mesh.positions is positions
    assert mesh.triangles is triangles
    assert mesh.materials is materials


def test_unused_vertices_may_be_anything():
    assert len(Mesh([*CORNERS, [NAN, np.inf, 0]], [[0, 1, 2]], [1]).positions) == 4


@given(
    st.one_of(st.integers(), st.floats(), st.booleans(), st.text(), st.none()), st.integers(-3, 3), st.integers(0, 9)
)
def test_whole_returns_an_equal_int_in_range_or_refuses(value, low, span):
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if is_number and value in range(low, low + span + 1):
        found = arguments.whole("x", value, low, low + span)
        assert type(found) is int
        assert found == value
    else:
        with pytest.raises((TypeError, ValueError), match=f"^x must be an integer {low} … {low + span}, not "):
            arguments.whole("x", value, low, low + span)


@given(
    st.lists(st.one_of(st.integers(-(2**70), 2**70), st.floats()), max_size=5), st.sampled_from([np.uint8, np.int32])
)
def test_whole_arrays_hold_equal_values_or_are_refused(values, dtype):
    if all(0 <= value <= 200 and value == int(value) for value in values):
        found = arguments.whole_array("x", values, ("N",), dtype, low=0, high=200)
        assert found.dtype == dtype
        assert found.tolist() == values
    else:
        with pytest.raises((TypeError, ValueError), match=r"^x"):
            arguments.whole_array("x", values, ("N",), dtype, low=0, high=200)


def test_values_have_short_reprs():
    author = authoring.Author("yard")
    for number in range(50):
        author.add(f"box {number}", authoring.box((1, 1, 1)), translate=(3 * number, 0, 0))
    scene = author.build()
    assert repr(scene) == "Scene(name='yard', objects=50, triangles=600, materials=2, warnings=1)"
    result = voxelize(scene, fit_grid(scene, depth=4))
    for value in (scene.objects[0], scene.objects[0].mesh, result, result.voxels):
        assert len(repr(value)) < 120
        assert "\n" not in repr(value)
