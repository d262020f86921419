"""The Cornell box [Cornell University Program of Computer Graphics, "Cornell Box Data"], in metres, and its variants.

The published millimetres are taken as they are (the box is 0.556 m wide). Reflectances and the light's emission are the
published spectra in linear Rec. 709, with the values in common use.
"""

import vec
import materials
import shapes
from gltf_writer import Builder

MM = 0.001
WHITE, RED, GREEN = (0.73, 0.73, 0.73), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)
EMISSION = (17.0, 12.0, 4.0)
POINT_POSITION = (0.278, 0.45, 0.2795)
POINT_INTENSITY = 0.25  # W/sr
POINT_COLOUR = (1.0, 12.0 / 17.0, 4.0 / 17.0)

_FLOOR = ((552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2))
_CEILING = ((556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0))
_BACK = ((549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2))
_RIGHT = ((0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2))
_LEFT = ((552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0))
_LIGHT = ((343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0))
_SHORT = ((130.0, 0.0, 65.0), (82.0, 0.0, 225.0), (240.0, 0.0, 272.0), (290.0, 0.0, 114.0))
_TALL = ((423.0, 0.0, 247.0), (265.0, 0.0, 296.0), (314.0, 0.0, 456.0), (472.0, 0.0, 406.0))
_TRAY_TOP, _TRAY_HEIGHT = 400.0, 30.0
_HEIGHT = {"Short block": 165.0, "Tall block": 330.0}


def metres(points):
    return [vec.scale(p, MM) for p in points]


def ceiling_with_hole():
    """The ceiling as four pieces around the light, which is published as a hole."""
    y = 548.8
    pieces = (
        ((0.0, 0.0), (556.0, 227.0)),
        ((0.0, 332.0), (556.0, 559.2)),
        ((0.0, 227.0), (213.0, 332.0)),
        ((343.0, 227.0), (556.0, 332.0)),
    )
    mesh = shapes.Mesh()
    for (x0, z0), (x1, z1) in pieces:
        mesh.append(shapes.quad(*metres(((x1, y, z0), (x1, y, z1), (x0, y, z1), (x0, y, z0)))))
    return mesh


def walls(lamp_in_ceiling):
    """Name, mesh and material key of the five walls."""
    ceiling = ceiling_with_hole() if lamp_in_ceiling else shapes.quad(*metres(_CEILING))
    return [
        ("Floor", shapes.quad(*metres(_FLOOR)), "white"),
        ("Ceiling", ceiling, "white"),
        ("Back wall", shapes.quad(*metres(_BACK)), "white"),
        ("Right wall", shapes.quad(*metres(_RIGHT)), "green"),
        ("Left wall", shapes.quad(*metres(_LEFT)), "red"),
    ]


def block(name):
    base = metres(_SHORT if name == "Short block" else _TALL)
    return shapes.prism(base, _HEIGHT[name] * MM)


def tray():
    """Open above, as large as the light: its sides and its bottom. And the corners of what closes it, facing up."""
    top = metres([(x, _TRAY_TOP, z) for x, _, z in reversed(_LIGHT)])
    bottom = [vec.sub(p, (0.0, _TRAY_HEIGHT * MM, 0.0)) for p in top]
    sides = [shapes.quad(bottom[i], bottom[(i + 1) % 4], top[(i + 1) % 4], top[i]) for i in range(4)]
    return shapes.merged([shapes.quad(*reversed(bottom))] + sides), top


def add_camera(scene, transform=lambda p: p):
    """The published camera: at (278, 273, -800), looking along +z, 25 mm film over a 35 mm lens."""
    return scene.add_camera(
        "Camera", transform((0.278, 0.273, -0.8)), transform((0.278, 0.273, 0.0)), 39.3077, near=0.001
    )


def wall_materials():
    return {
        "white": materials.lambert("White", WHITE),
        "red": materials.lambert("Red", RED),
        "green": materials.lambert("Green", GREEN),
    }


def cornell(
    name, area_light=True, overrides=None, blocks=True, extra=(), lamp=lambda corners: shapes.quad(*corners), uplight=False
):
    """A Cornell box. overrides: material for a wall's or block's name; extra: further (name, mesh, material,
    translation); lamp: mesh of the area light from its corners; uplight: the light lies in a tray and shines at the
    ceiling."""
    scene = Builder(name)
    palette = {key: scene.add_material(m) for key, m in wall_materials().items()}
    overrides = {key: scene.add_material(m) for key, m in (overrides or {}).items()}
    parts = walls(area_light and not uplight) + (
        [("Short block", block("Short block"), "white"), ("Tall block", block("Tall block"), "white")] if blocks else []
    )
    for part, mesh, key in parts:
        scene.add_object(part, mesh, overrides.get(part, palette[key]))
    for part, mesh, material, translation in extra:
        scene.add_object(part, mesh, scene.add_material(material), translation=translation)
    shade, corners = tray() if uplight else (None, metres(_LIGHT))
    if uplight:
        scene.add_object("Tray", shade, palette["white"])
    if area_light:
        scene.add_object(
            "Light", lamp(corners), scene.add_material(materials.emitter("Light", EMISSION))
        )
    else:
        scene.add_light("Light", "point", POINT_INTENSITY, POINT_COLOUR, POINT_POSITION)
    add_camera(scene)
    return scene.glb()


def cornell_box():
    return cornell("cornell-box")


def cornell_point():
    return cornell("cornell-point", area_light=False)


def cornell_indirect():
    """Lit by bounces alone: the area light lies in a tray and shines at the ceiling."""
    return cornell("cornell-indirect", uplight=True)


def cornell_glossy():
    """A glossy floor, a rough copper block and a smoother silver one under the area light."""
    return cornell(
        "cornell-glossy",
        overrides={
            "Floor": materials.glossy("Glossy floor", WHITE, 0.3),
            "Short block": materials.metal("Copper", (0.955, 0.638, 0.538), 0.4),
            "Tall block": materials.metal("Silver", (0.9, 0.9, 0.9), 0.2),
        },
    )


def cornell_caustic():
    """A glass and a mirror sphere under the area light."""
    return cornell(
        "cornell-caustic",
        blocks=False,
        extra=(
            (
                "Glass sphere",
                shapes.sphere(0.09, 128, 64),
                materials.glass("Glass", 1.5, thickness=0.18),
                (0.165, 0.0905, 0.17),
            ),
            (
                "Mirror sphere",
                shapes.sphere(0.09, 128, 64),
                materials.metal("Mirror", (0.95, 0.95, 0.95), 0.0),
                (0.39, 0.0905, 0.36),
            ),
        ),
    )


SCENES = {
    "cornell-box": cornell_box,
    "cornell-point": cornell_point,
    "cornell-indirect": cornell_indirect,
    "cornell-glossy": cornell_glossy,
    "cornell-caustic": cornell_caustic,
}
