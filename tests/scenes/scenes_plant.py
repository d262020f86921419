"""A shrub of alpha-masked leaf cards: most of each card is cut away."""

import math

import materials
import shapes
import textures
import vec
from demo_objects import plant_pot, soil
from gltf_writer import Builder
from mesh import merged
from textures import Random


def _card(base, direction, size, roll):
    """A leaf card of the given size that grows from base along direction."""
    up = vec.normalize(direction)
    side = vec.normalize(vec.cross(up, vec.Y if abs(up[1]) < 0.9 else vec.X))
    side = vec.rotate(vec.quaternion(up, roll), side)
    return shapes.grid(vec.sub(base, vec.scale(side, 0.5 * size)), vec.scale(side, size), vec.scale(up, size))


def _shrub(stems=14, leaves=22):
    """Bent stems from a common root, and leaf cards along each."""
    random = Random(91)
    wood, cards = [], []
    for k in range(stems):
        turn = 2.0 * math.pi * (0.381966 * k % 1.0)
        tall, reach = random.uniform(0.35, 0.72), random.uniform(0.08, 0.30)
        away = (math.cos(turn), 0.0, math.sin(turn))
        path = [vec.add(vec.scale(away, 0.02 + reach * (s / 8.0) ** 1.7), (0.0, tall * s / 8.0, 0.0)) for s in range(9)]
        wood.append(shapes.tube(path, [0.006 - 0.0005 * s for s in range(9)], 8))
        for leaf in range(leaves):
            s = 2.0 + 6.0 * leaf / (leaves - 1)
            at = vec.lerp(path[int(min(s, 7.999))], path[int(min(s, 7.999)) + 1], min(s, 8.0) - int(min(s, 7.999)))
            spin = turn + 2.399963 * leaf + random.uniform(-0.3, 0.3)
            direction = (math.cos(spin), random.uniform(0.1, 0.9), math.sin(spin))
            cards.append(_card(at, direction, random.uniform(0.075, 0.125), random.uniform(-25.0, 25.0)))
    return merged(wood), merged(cards)


def plant():
    scene = Builder("plant")
    picture = scene.add_texture("Leaf", textures.leaf(), 33071, 33071)
    leaf = materials.lambert("Leaf", (1.0, 1.0, 1.0), alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
    leaf = scene.add_material(materials.with_textures(leaf, picture))
    white = scene.add_material(materials.lambert("White", (0.75, 0.73, 0.70)))
    glaze = scene.add_material(materials.coated("Blue glaze", (0.05, 0.13, 0.35), 0.4, 1.0, 0.05))
    earth = scene.add_material(materials.lambert("Soil", (0.05, 0.033, 0.022)))
    bark = scene.add_material(materials.lambert("Bark", (0.16, 0.11, 0.05)))
    scene.add_object("Floor", shapes.grid((-2.0, 0.0, 2.0), (4.0, 0.0, 0.0), (0.0, 0.0, -3.0)), white)
    scene.add_object("Wall", shapes.grid((-2.0, 0.0, -1.0), (4.0, 0.0, 0.0), (0.0, 3.0, 0.0)), white)
    stems, cards = _shrub()
    scene.add_object("Pot", plant_pot(), glaze)
    scene.add_object("Soil", soil(), earth)
    scene.add_object("Stems", stems, bark, translation=(0.0, 0.24, 0.0))
    scene.add_object("Leaves", cards, leaf, translation=(0.0, 0.24, 0.0))
    scene.add_light("Sun", "directional", 2.2, (1.0, 0.94, 0.84), direction=(-0.55, -0.75, -0.5))
    panel = scene.add_material(materials.emitter("Sky panel", (2.4, 3.0, 3.8)))
    scene.add_object("Sky panel", shapes.grid((-1.8, 0.4, 1.2), (0.0, 0.0, -1.4), (0.0, 1.6, 0.0)), panel)
    scene.add_camera("Camera", (0.35, 0.85, 1.75), (0.0, 0.55, 0.0), 40.0)
    return scene.glb()


SCENES = {"plant": plant}
