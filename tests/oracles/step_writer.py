"""STEP files written by hand."""

from __future__ import annotations

from itertools import product


def step_of_a_box(sides, unit="SI_UNIT(.MILLI.,.METRE.)"):
    """An AP214 file of a box, from the origin to `sides`: one solid with six plane faces."""
    lines = []

    def add(text):
        lines.append(f"#{len(lines) + 1}={text};")
        return f"#{len(lines)}"

    def triple(kind, values):
        return add(f"{kind}('',({','.join(f'{float(v)!r}' for v in values)}))")

    points = {
        c: triple("CARTESIAN_POINT", [s * k for s, k in zip(sides, c, strict=True)]) for c in product((0, 1), repeat=3)
    }
    corners = {c: add(f"VERTEX_POINT('',{p})") for c, p in points.items()}
    edges = {}
    for c, corner in corners.items():
        for axis in range(3):
            if c[axis] == 0:
                end = tuple(1 if i == axis else v for i, v in enumerate(c))
                way = triple("DIRECTION", [float(i == axis) for i in range(3)])
                vector = add(f"VECTOR('',{way},1.)")
                line = add(f"LINE('',{points[c]},{vector})")
                edges[c, end] = add(f"EDGE_CURVE('',{corner},{corners[end]},{line},.T.)")
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            ring = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                c = [0, 0, 0]
                c[axis], c[u], c[v] = side, a, b
                ring.append(tuple(c))
            ring = ring if side else ring[::-1]
            oriented = []
            for start, end in zip(ring, [*ring[1:], ring[0]], strict=True):
                forward = (start, end) in edges
                curve = edges[(start, end) if forward else (end, start)]
                oriented.append(add(f"ORIENTED_EDGE('',*,*,{curve},{'.T.' if forward else '.F.'})"))
            bound = add(f"FACE_OUTER_BOUND('',{add(f'EDGE_LOOP({chr(39)}{chr(39)},({chr(44).join(oriented)}))')},.T.)")
            normal = triple("DIRECTION", [float((2 * side - 1) * (i == axis)) for i in range(3)])
            along = triple("DIRECTION", [float(i == u) for i in range(3)])
            place = add(f"AXIS2_PLACEMENT_3D('',{points[ring[0]]},{normal},{along})")
            plane = add(f"PLANE('',{place})")
            faces.append(add(f"ADVANCED_FACE('',({bound}),{plane},.T.)"))
    shell = add(f"CLOSED_SHELL('',({','.join(faces)}))")
    solid = add(f"MANIFOLD_SOLID_BREP('box',{shell})")
    length = add(f"(LENGTH_UNIT()NAMED_UNIT(*){unit})")
    angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    small = add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{length},'','')")
    context = add(
        f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({small}))"
        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle}))REPRESENTATION_CONTEXT('',''))"
    )
    origin = add(
        f"AXIS2_PLACEMENT_3D('',{points[0, 0, 0]},{triple('DIRECTION', (0, 0, 1))},{triple('DIRECTION', (1, 0, 0))})"
    )
    shape = add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('box',({origin},{solid}),{context})")
    application = add("APPLICATION_CONTEXT('automotive design')")
    add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{application})")
    product_context = add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
    part = add(f"PRODUCT('box','box','',({product_context}))")
    formation = add(f"PRODUCT_DEFINITION_FORMATION('','',{part})")
    definition_context = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
    definition = add(f"PRODUCT_DEFINITION('design','',{formation},{definition_context})")
    add(
        f"SHAPE_DEFINITION_REPRESENTATION({add(f'PRODUCT_DEFINITION_SHAPE({chr(39)}{chr(39)},{chr(39)}{chr(39)},{definition})')},{shape})"
    )
    header = (
        "HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');"
        "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;"
    )
    return "\n".join(["ISO-10303-21;", header, "DATA;", *lines, "ENDSEC;", "END-ISO-10303-21;", ""])
