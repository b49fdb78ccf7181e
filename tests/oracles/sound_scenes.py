"""What every scene that a loader returns promises, and every refusal."""

import numpy as np

from voxrt.voxelize import AssetError, DoesNotFitError


def assert_sound(scene):
    """Check what every scene of a file promises."""
    assert scene.objects
    for thing in scene.objects:
        mesh = thing.mesh
        assert np.isfinite(mesh.positions).all()
        assert np.isfinite(thing.transform).all()
        assert mesh.triangles.dtype == np.int32
        assert mesh.materials.shape == mesh.triangles.shape[:1]
        if len(mesh.triangles):
            assert 0 <= mesh.triangles.min() <= mesh.triangles.max() < len(mesh.positions)
            assert 1 <= mesh.materials.min() <= mesh.materials.max() < len(scene.materials)
        if thing.colliders or len(mesh.triangles):
            assert 1 <= thing.collider_material < len(scene.materials)
    assert len({material.name for material in scene.materials}) == len(scene.materials) <= 256


def read_or_refused(load, path, **options):
    """Return the scene that `load` reads, which is sound; None where it refuses the file, in one line."""
    try:
        scene = load(path, **options)
    except (AssetError, DoesNotFitError) as error:
        assert "\n" not in str(error)  # noqa: PT017 -- and no other error comes
        return None
    assert_sound(scene)
    return scene


def kinds(scene):
    """Return how often each kind of warning was counted."""
    counts = {}
    for warning in scene.warnings:
        counts[warning.kind] = counts.get(warning.kind, 0) + warning.count
    return counts
