"""Signs of distances, negative inside, by NVIDIA Warp: it compiles kernels from source files."""

import warp as wp


@wp.kernel
def winding_number(mesh: wp.uint64, points: wp.array(dtype=wp.vec3), signs: wp.array(dtype=float)):  # noqa: ANN201
    """Write the sign of each point by the winding number."""
    i = wp.tid()
    signs[i] = wp.mesh_query_point_sign_winding_number(mesh, points[i], 1.0e6).sign


@wp.kernel
def parity(mesh: wp.uint64, points: wp.array(dtype=wp.vec3), signs: wp.array(dtype=float)):  # noqa: ANN201
    """Write the sign of each point by the parity of eleven rays."""
    i = wp.tid()
    signs[i] = wp.mesh_query_point_sign_parity(mesh, points[i], 1.0e6, 11).sign
