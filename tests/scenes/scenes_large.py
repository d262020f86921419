"""Scenes of a million triangles; made only when named."""

import array

import materials
import shapes
import vec
from gltf_writer import FLOAT, Builder
from textures import Random, noise

SIDE = 708  # cells along an edge: 2 * 708^2 = 1,002,528 triangles


def _terrain_arrays():
    """Positions, normals and indices of a displaced square of side 10 as flat arrays."""
    points = SIDE + 1
    layers = [
        (0.9, noise(points, points, 7, 7, 101)),
        (0.22, noise(points, points, 29, 29, 102)),
        (0.05, noise(points, points, 113, 113, 103)),
    ]
    heights = [[sum(weight * layer[y][x] for weight, layer in layers) for x in range(points)] for y in range(points)]
    step = 10.0 / SIDE
    positions, normals, indices = array.array("f"), array.array("f"), array.array("I")
    for y in range(points):
        above, row, below = heights[max(y - 1, 0)], heights[y], heights[min(y + 1, SIDE)]
        for x in range(points):
            positions.extend((x * step - 5.0, row[x], y * step - 5.0))
            dx, dz = row[max(x - 1, 0)] - row[min(x + 1, SIDE)], above[x] - below[x]
            normals.extend(vec.normalize((dx, 2.0 * step, dz)))
    for y in range(SIDE):
        for x in range(SIDE):
            a = y * points + x
            indices.extend((a, a + points, a + 1, a + 1, a + points, a + points + 1))
    return positions, normals, indices


def million_mesh():
    """One mesh of 1,002,528 triangles: hills in the sun."""
    scene = Builder("million-mesh")
    rock = scene.add_material(materials.lambert("Rock", (0.50, 0.42, 0.34)))
    positions, normals, indices = _terrain_arrays()
    attributes = {
        "POSITION": scene.add_accessor(positions, "VEC3", FLOAT, bounds=True),
        "NORMAL": scene.add_accessor(normals, "VEC3"),
    }
    primitive = {"attributes": attributes, "indices": scene.add_indices(indices, len(positions) // 3), "material": rock}
    scene.add_node("Terrain", mesh=scene.add("meshes", {"name": "Terrain", "primitives": [primitive]}))
    scene.add_light("Sun", "directional", 5.0, (1.0, 0.92, 0.8), direction=(-0.7, -0.5, -0.3))
    scene.add_light("Lamp", "point", 12.0, (1.0, 0.6, 0.3), (0.5, 1.8, 1.0))
    scene.add_camera("Camera", (0.0, 3.6, 6.4), (0.0, 0.0, 0.2), 45.0)
    return scene.glb()


def million_instances():
    """1,000 nodes that share one mesh of 1,000 triangles."""
    scene = Builder("million-instances")
    floor = scene.add_material(materials.lambert("Floor", (0.6, 0.6, 0.6)))
    copper = scene.add_material(materials.metal("Copper", (0.955, 0.638, 0.538), 0.3))
    scene.add_object("Floor", shapes.grid((-12.0, 0.0, 12.0), (24.0, 0.0, 0.0), (0.0, 0.0, -24.0)), floor)
    knot = scene.add_mesh("Knot", [(shapes.torus_knot(2, 3, 0.18, 0.08, 0.05, 50, 10), copper)])
    random = Random(111)
    for k in range(1000):
        place = (0.7 * (k % 10 - 4.5), 0.4 + 0.62 * (k // 100), 0.7 * (k // 10 % 10 - 4.5))
        axis = (random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0))
        turn = vec.quaternion(axis, random.uniform(0.0, 360.0))
        scene.add_node(
            f"Knot {k + 1}", mesh=knot, translation=place, rotation=turn, scale=[random.uniform(0.8, 1.2)] * 3
        )
    panel = scene.add_material(materials.emitter("Panel", (8.0, 8.0, 8.0)))
    scene.add_object("Panel", shapes.grid((-4.0, 9.0, -4.0), (8.0, 0.0, 0.0), (0.0, 0.0, 8.0)), panel)
    scene.add_light("Lamp", "point", 40.0, (1.0, 0.8, 0.6), (5.0, 6.0, 6.0))
    scene.add_camera("Camera", (5.5, 6.5, 9.5), (0.0, 2.9, 0.0), 42.0)
    return scene.glb()


SCENES = {"million-mesh": million_mesh, "million-instances": million_instances}
