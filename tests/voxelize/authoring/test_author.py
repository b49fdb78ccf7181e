"""Scenes made in Python."""

import doctest

import numpy as np
import pytest
from oracles.surfaces import bounds, scene_triangles, volume

from voxrt.voxelize import (
    BoxCollider,
    DoesNotFitError,
    HullCollider,
    Material,
    Mesh,
    MeshCollider,
    Scene,
    SceneObject,
    SphereCollider,
    authoring,
)
from voxrt.voxelize.authoring import Author
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance

WHITE = (255, 255, 255)


def test_the_examples_of_the_module():
    assert doctest.testmod(authoring).failed == 0


def test_materials_keep_their_order_whether_used_or_not():
    yard = Author("yard", background="#102030")
    for name, colour in (("a", "#0000ff"), ("b", (1, 2, 3)), ("c", "#ffffff")):
        yard.material(name, colour, mirror=name == "b")
    yard.add("only", authoring.box((1, 1, 1)), material="c")
    assert yard.build().materials == (
        Material("empty", (16, 32, 48)),
        Material("a", (0, 0, 255)),
        Material("b", (1, 2, 3), mirror=True),
        Material("c", (255, 255, 255)),
    )


def test_ids_may_be_given_and_gaps_are_filled_first():
    yard = Author("yard")
    yard.material("late", "#000001", number=4)
    yard.material("one", "#000002")
    yard.add("thing", authoring.box((1, 1, 1)))
    scene = yard.build()
    assert [(one.name, one.authored) for one in scene.materials] == [
        ("empty", True),
        ("one", True),
        ("default", False),
        ("unused 3", False),
        ("late", True),
    ]
    assert set(scene.objects[0].mesh.materials) == {2}
    assert [(one.kind, one.count) for one in scene.warnings] == [("default-material", 12)]


def test_objects_stand_where_they_are_put():
    yard = Author("yard")
    yard.material("a", "#ffffff")
    yard.add("turned", authoring.box((2, 4, 6)), material="a", translate=(10, 0, 0), rotate=(0, 0, 90), scale=2)
    triangles = scene_triangles(yard.build())
    assert bounds(triangles).tolist() == [[6, -2, -6], [14, 2, 6]]
    assert volume(triangles) == pytest.approx(8 * 48)


@pytest.mark.parametrize(
    ("kind", "cls"), [("box", BoxCollider), ("sphere", SphereCollider), ("hull", HullCollider), ("mesh", MeshCollider)]
)
def test_colliders(kind, cls):
    yard = Author("yard")
    yard.add("thing", authoring.box((2, 4, 4)), collider=kind, pow2=False, rotate=(0, 30, 0))
    (collider,) = yard.build().objects[0].colliders
    assert isinstance(collider, cls)
    if kind == "box":
        assert collider.minimum.tolist() == [-1, -2, -2]
        assert collider.maximum.tolist() == [1, 2, 2]
        assert not collider.pow2
    if kind == "sphere":
        assert collider.centre.tolist() == [0, 0, 0]
        assert collider.radius == 3


def asset(*materials):
    mesh = Mesh(
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]),
        np.array([[0, 1, 2]] * len(materials), dtype=np.int32),
        np.arange(1, len(materials) + 1, dtype=np.uint8),
    )
    one = SceneObject("/part", mesh)
    moved = SceneObject("/other", mesh, authoring.placement((5, 0, 0)))
    return Scene("asset", (one, moved), (Material("empty", (0, 0, 0)), *materials))


def test_assets_bring_their_materials_and_share_meshes():
    yard = Author("yard")
    yard.material("red", "#ff0000")
    yard.material("wood", "#804000")
    yard.add_asset(
        "twin",
        asset(Material("red", (1, 1, 1)), Material("board", (2, 2, 2)), Material("own", (3, 3, 3))),
        authoring.placement((0, 0, 7)),
        materials={"board": "wood"},
    )
    yard.add_asset("more", asset(Material("own", (3, 3, 3)), Material("own ", (4, 4, 4))), np.eye(4))
    scene = yard.build()
    assert [one.name for one in scene.objects] == ["twin/part", "twin/other", "more/part", "more/other"]
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [
        ("red", (255, 0, 0)),
        ("wood", (128, 64, 0)),
        ("own", (3, 3, 3)),
        ("own ", (4, 4, 4)),
    ]
    assert scene.objects[0].mesh.materials.tolist() == [1, 2, 3]
    assert scene.objects[2].mesh.materials.tolist() == [3, 4]
    assert scene.objects[0].mesh is scene.objects[1].mesh
    assert scene.objects[1].transform[:3, 3].tolist() == [5, 0, 7]


def test_paint_stays_unless_its_material_is_declared():
    white = np.ones((2, 3, 4), dtype=np.float32)
    surface_appearance = SurfaceAppearance(
        (Appearance("cloth"), Appearance("skin")), np.array([0, 1], dtype=np.int32), np.zeros((2, 3, 2)), white
    )
    mesh = Mesh(
        np.eye(3),
        np.array([[0, 1, 2], [0, 2, 1]], dtype=np.int32),
        np.array([1, 2], dtype=np.uint8),
        surface_appearance,
    )
    table = (Material("empty", (0, 0, 0)), Material("cloth #ffffff", WHITE), Material("skin #ffffff", WHITE))
    painted = Scene("asset", (SceneObject("one", mesh),), table)
    yard = Author("yard")
    yard.material("linen", "#eeeeee")
    yard.add_asset("doll", painted, np.eye(4), materials={"cloth": "linen"})
    scene = yard.build()
    assert [one.name for one in scene.materials[1:]] == ["linen", "skin #ffffff"]
    (one,) = scene.objects
    assert one.mesh.materials.tolist() == [1, 2]
    assert one.mesh.appearance.rows.tolist() == [-1, 1]


def test_a_view_and_a_light():
    yard = Author("yard")
    yard.add("thing", authoring.box((1, 1, 1)))
    yard.look((1, 2, 3), (0, 0, 0), field_of_view=40)
    yard.light((4, 5, 6))
    scene = yard.build()
    assert scene.viewpoint is not None
    assert (scene.viewpoint.eye, scene.viewpoint.target, scene.viewpoint.field_of_view) == ((1, 2, 3), (0, 0, 0), 40)
    assert scene.light is not None
    assert scene.light.position == (4, 5, 6)


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda yard: yard.build(), "the scene has no objects"),
        (lambda yard: yard.material("a", "#000000"), "'a' is declared twice"),
        (lambda yard: yard.material("b", "blue"), "'blue' is not written as #rrggbb"),
        (lambda yard: yard.material("b", (1, 2)), "three integers"),
        (lambda yard: yard.material("b", (1, 2, 256)), "three integers"),
        (lambda yard: yard.material("b", "#000000", number=1), "cannot have the id 1: it belongs to 'a'"),
        (lambda yard: yard.material("b", "#000000", number=256), "number must be an integer 1 … 255, not 256"),
        (
            lambda yard: yard.add("x", authoring.box((1, 1, 1)), material="c"),
            "no material 'c' is declared; there is 'a'",
        ),
        (lambda yard: [yard.add("x", authoring.box((1, 1, 1))) for _ in range(2)], "two objects are named 'x'"),
        (lambda yard: yard.look((0, 0, 0), (0, 0, 0)), "eye and target must differ"),
        (
            lambda yard: yard.look((0, 0, 0), (0, 0, 1), field_of_view=180),
            "field_of_view must be a finite number above 0 and below 180",
        ),
        (lambda yard: yard.light((0, 0)), r"position must have shape \(3,\)"),
        (
            lambda yard: yard.add_asset("x", asset(Material("m", (0, 0, 0))), np.eye(4), materials={"n": "a"}),
            "has no material 'n'; it has 'm'",
        ),
    ],
)
def test_refused(act, message):
    yard = Author("yard")
    yard.material("a", "#ffffff")
    with pytest.raises(ValueError, match=message):
        act(yard)


def test_too_many_materials():
    yard = Author("yard")
    for number in range(255):
        yard.material(str(number), "#000000")
    with pytest.raises(DoesNotFitError, match="255 materials"):
        yard.material("one more", "#000000")
